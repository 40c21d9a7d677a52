# SPDX-License-Identifier: GPL-3.0-or-later
"""Binary frames as ispace-protocol(7) describes them, read with numpy and OpenCV alone, equal scan's output."""

import json
import os
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import cv2
    import numpy as np
except ImportError:
    print("skipped: no numpy or OpenCV here (Debian: python3-numpy, python3-opencv)")
    sys.exit(77)

ENVIRONMENT = Path(os.environ["ISPACE_SOURCE_DIR"]) / "tests" / "data" / "square.env"
LAYOUT = """#3dm 1
camera id=c1 at=-1.5,-1.5,1.2 heading=45 tilt=-15 pixels=64,48 fov=70 rate=10
ranger id=d1 at=1.5,1.5,0.8 heading=-135 tilt=-10 pixels=32,24 fov=60,45 range=0.3,2.5 rate=10
human id=h1 at=0.3,0
robot id=r1 model=pioneer-2dx at=-0.6,0.4
"""


class Reader:
    """Lines, and the bytes that they count."""

    def __init__(self, address, role):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), 60)
        self.file = self.socket.makefile("rb")
        assert self.file.readline() == b"ISPACE 1\n"
        self.about = self.ask(role)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()
        self.socket.close()

    def send(self, request):
        self.socket.sendall(request.encode() + b"\n")

    def fields(self):
        line = self.file.readline().decode()
        assert line.startswith(("OK ", "SCAN ")), line
        return dict(word.split("=", 1) for word in line.split() if "=" in word)

    def ask(self, request):
        self.send(request)
        return self.fields()

    def frame(self):
        fields = self.fields()
        return fields, self.file.read(int(fields["bytes"]))

    def scan(self, wanted):
        """In a format: the line's keys and the bytes."""
        self.ask(f"FORMAT {wanted}")
        self.send("SCAN")
        fields, data = self.frame()
        assert fields["format"] == wanted, fields
        return fields, data


def shape(fields):
    return int(fields["height"]), int(fields["width"])


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = cls.path = Path(cls.folder.name)
        layout = folder / "layout.3dm"
        layout.write_text(LAYOUT)
        scene = [str(ENVIRONMENT), str(layout)]
        subprocess.run(["scan", *scene, "--to", "png", "-o", f"{folder}/"], check=True)
        subprocess.run(["scan", *scene, "--select", "d1", "--to", "pcd", "-o", folder / "d1.pcd"], check=True)
        cls.run_ = subprocess.Popen(["simrun", *scene, "--clock", "step", "-q"], stdout=subprocess.PIPE, text=True)
        cls.address = json.loads(cls.run_.stdout.readline())["listen"]

    @classmethod
    def tearDownClass(cls):
        cls.run_.terminate()
        cls.run_.wait(60)
        cls.run_.stdout.close()
        cls.folder.cleanup()

    def picture(self, name):
        picture = cv2.imread(str(self.path / name), cv2.IMREAD_UNCHANGED)
        self.assertIsNotNone(picture, name)
        return picture

    def test_pictures(self):
        wanted = self.picture("c1-0000.png")
        self.assertGreater(len(np.unique(wanted)), 20)
        with Reader(self.address, "SENSOR c1") as camera:
            self.assertEqual((camera.about["kind"], camera.about["width"]), ("camera", "64"))
            fields, data = camera.scan("rgb")
            rgb = np.frombuffer(data, np.uint8).reshape(*shape(fields), 3)
            np.testing.assert_array_equal(rgb[:, :, ::-1], wanted)  # OpenCV has blue first
            _, data = camera.scan("png")
            np.testing.assert_array_equal(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR), wanted)
            _, data = camera.scan("jpeg")
            jpeg = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
            self.assertEqual(jpeg.shape, wanted.shape)
            self.assertLess(np.abs(jpeg.astype(int) - wanted).mean(), 12)

    def test_depths(self):
        wanted = self.picture("d1-0000.png")
        self.assertEqual((wanted.dtype, wanted.shape), (np.uint16, (24, 32)))
        self.assertGreater(np.count_nonzero(wanted == 0), 10, "all are in range")
        with Reader(self.address, "SENSOR d1") as ranger:
            fields, data = ranger.scan("depth16")
            depth16 = np.frombuffer(data, "<u2").reshape(shape(fields))
            np.testing.assert_array_equal(depth16, wanted)
            _, data = ranger.scan("png")
            np.testing.assert_array_equal(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED), wanted)
            fields, data = ranger.scan("depth32")
            depth32 = np.frombuffer(data, "<f4").reshape(shape(fields))
            np.testing.assert_array_equal(np.isinf(depth32), wanted == 0)
            there = wanted > 0
            np.testing.assert_allclose(depth32[there], wanted[there] / 1000, atol=5.1e-4)

    def test_clouds(self):
        header, body = (self.path / "d1.pcd").read_bytes().split(b"DATA binary\n")
        self.assertIn(b"FIELDS x y z\n", header)
        wanted = np.frombuffer(body, "<f4").reshape(-1, 3)
        wanted = wanted[np.isfinite(wanted).all(axis=1)]
        with Reader(self.address, "SENSOR d1") as ranger:
            fields, data = ranger.scan("cloud")
        points = np.frombuffer(data, "<f4").reshape(-1, 3).astype(float)
        self.assertEqual(len(points), np.prod(shape(fields)))
        points = points[np.isfinite(points).all(axis=1)]
        x, y, z, heading, tilt, _ = (float(value) for value in fields["pose"].split(","))
        h, t = np.radians(heading), np.radians(tilt)
        turn = np.array([[np.cos(h), -np.sin(h), 0], [np.sin(h), np.cos(h), 0], [0, 0, 1]])
        lean = np.array([[np.cos(t), 0, -np.sin(t)], [0, 1, 0], [np.sin(t), 0, np.cos(t)]])
        in_room = points @ (turn @ lean).T + [x, y, z]
        self.assertEqual(in_room.shape, wanted.shape)
        np.testing.assert_allclose(in_room, wanted, atol=1e-5)

    def test_a_stream(self):
        with Reader(self.address, "SENSOR d1") as ranger, Reader(self.address, "WORLD") as world:
            ranger.ask("FORMAT depth16")
            ranger.ask("STREAM")
            first = None
            for _ in range(3):
                world.ask("STEP 20")
                fields, data = ranger.frame()
                self.assertEqual(fields["stream"], "1")
                depths = np.frombuffer(data, "<u2").reshape(shape(fields))
                first = depths if first is None else first
                np.testing.assert_array_equal(depths, first)  # all movers stand


if __name__ == "__main__":
    unittest.main()
