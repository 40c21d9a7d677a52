# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenCV's VideoCapture reads a simulated camera as a network camera; depths come as 16-bit PNG the
same way, and positions of a tag as lines of text."""
import http.client
import os
import pathlib
import socket

from device_run import Run, check, scratch, skip

try:
    import cv2
    import numpy
except ImportError:
    skip("no OpenCV for Python here")

ROOM = "#env 1\nispace size=6,6,2.8\ncube id=box at=1,0 size=0.6,0.6,0.6\n"
LAYOUT = """#3dm 1
camera id=c1 at=-2,0,1 pixels=160,120 fov=60 rate=10
ranger id=d1 at=-2,0,0.3 pixels=64,48 fov=60 rate=10 range=0.3,8
robot id=r1 at=-1,2 speed=0.5
tag id=t1 on=r1 at=0,0,0.5 tilt=90
ultrasound id=u1 at=-2,-2,2.5 tilt=-90 fov=170
ultrasound id=u2 at=2,-2,2.5 tilt=-90 fov=170
ultrasound id=u3 at=2,2,2.5 tilt=-90 fov=170
ultrasound id=u4 at=-2,2,2.5 tilt=-90 fov=170
"""


def get(where, path):
    connection = http.client.HTTPConnection(*where, timeout=30)
    connection.request("GET", path)
    answer = connection.getresponse()
    return answer.status, answer.headers, answer.read()


def watch(where):
    """A stream of pictures, which agree with a single one."""
    status, headers, body = get(where, "/snapshot")
    check(status == 200 and headers["Content-Type"] == "image/jpeg", f"a snapshot is {status}")
    single = cv2.imdecode(numpy.frombuffer(body, numpy.uint8), cv2.IMREAD_COLOR)
    check(single.shape == (120, 160, 3), f"its shape is {single.shape}")
    check(single.std() > 5, "it shows nothing")
    capture = cv2.VideoCapture("http://%s:%d/" % where)
    check(capture.isOpened(), "VideoCapture does not open it")
    for k in range(30):
        ok, picture = capture.read()
        check(ok, f"VideoCapture ends after {k} pictures")
        check(picture.shape == single.shape, f"a picture of {picture.shape}")
    # No mover moves in its view.
    check(numpy.abs(picture.astype(int) - single).max() <= 24, "the stream shows something else")
    capture.release()
    print("30 pictures by VideoCapture")


def watch_depths(where):
    """Parts of the stream by hand: the box is 2.7 m ahead."""
    stream = socket.create_connection(where, timeout=30).makefile("rwb")
    stream.write(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    stream.flush()

    def read_head():
        lines = []
        while (line := stream.readline().strip()):
            lines.append(line.decode())
        return lines[0], dict(line.split(": ", 1) for line in lines[1:])

    first, headers = read_head()
    check(first == "HTTP/1.1 200 OK", first)
    boundary = headers["Content-Type"].split("boundary=")[1]
    times = []
    for _ in range(10):
        begin, part = read_head()
        check(begin == "--" + boundary and part["Content-Type"] == "image/png", f"{begin} {part}")
        body = stream.read(int(part["Content-Length"]))
        check(stream.readline() == b"\r\n", "no line behind a picture")
        depths = cv2.imdecode(numpy.frombuffer(body, numpy.uint8), cv2.IMREAD_UNCHANGED)
        check(depths.dtype == numpy.uint16 and depths.shape == (48, 64), f"{depths.dtype} {depths.shape}")
        check(abs(int(depths[24, 32]) - 2700) <= 1, f"{depths[24, 32]} mm ahead")
        times.append(float(part["X-Timestamp"]))
    check(times == sorted(set(times)), f"times {times}")
    print("10 depth frames, at", *times)


def follow(where):
    lines = socket.create_connection(where, timeout=30).makefile()
    check(lines.readline().startswith("# zps-3d 1: t,tag,x,y,z,receivers,residual"), "no head")
    for _ in range(10):
        time, tag, x, y, z, receivers, residual = lines.readline().strip().split(",")
        check((tag, receivers) == ("t1", "4"), f"{tag} is heard by {receivers}")
        found = float(x), float(y), float(z)
        check(max(abs(a - b) for a, b in zip(found, (-1, 2, 0.5))) < 0.001, f"it is at {found}")
    print("10 positions, the last at", time)


def main():
    pathlib.Path("room.env").write_text(ROOM)
    pathlib.Path("eyes.3dm").write_text(LAYOUT)
    with Run("room.env", "eyes.3dm", "--clock", "real:2", "--mjpeg", "c1=0", "--mjpeg", "d1=0",
             "--zps", "t1=0") as run:
        cameras = run.ports["mjpeg"]
        watch(cameras["c1"])
        watch_depths(cameras["d1"])
        follow(run.ports["zps"]["t1"])
        check(get(cameras["c1"], "/nothing")[0] == 404, "there is something at /nothing")


if __name__ == "__main__":
    with scratch() as folder:
        os.chdir(folder)
        main()
