#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""NumPy reads from .npz and .npy the values of the same scan as JSON lines; see scan(1)."""
import base64
import json
import os
import subprocess
import sys
import tempfile
import zipfile

try:
    import cv2
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

SQUARE = "#env 1\nfence path=-2,-2;2,-2;2,2;-2,2 closed=yes\n"
SENSORS = """#3dm 1
laser id=l1 at=0.5,0.25 heading=30 tilt=5 fov=240 step=0.5 range=1.5
laser id=nods at=0,0,1 step=15 sweep=tilt sweep_span=60 sweep_step=30
ranger id=pin at=-1,0,0.5 tilt=-20 pixels=40,30 range=1.8
ranger id=a/b at=0,0,1 projection=spherical fov=360,60 pixels=16,6
camera id=c1 at=0,1,1 heading=-90 pixels=32,24
camera id=bent at=0,1,1 heading=-90 pixels=32,24 coefficients=-0.3,0.1,0.001,-0.002,0.05
camera id=fish at=0,1,1 heading=-90 pixels=32,24 projection=fisheye coefficients=0.02,-0.01,0.003,0.001
camera id=bowl at=0,0,2 tilt=-90 pixels=32,24 projection=omni mirror=0.9
ultrasound id=u1 at=-1.5,-1.5,2.4 tilt=-90
ultrasound id=u2 at=1.5,-1.5,2.4 tilt=-90
ultrasound id=u3 at=1.5,1.5,2.4 tilt=-90
ultrasound id=u4 at=-1.5,1.5,2.4 tilt=-90
tag id=t1 at=0.25,-0.25,0.5
tag id=low at=-1.9,-1.9,2.3
"""
FRAMES = 3


def scan(*arguments):
    return subprocess.run(["scan", "square.env", *arguments], check=True, stdout=subprocess.PIPE).stdout


def equal(what, a, b):
    assert np.array_equal(np.asarray(a), np.asarray(b), equal_nan=True), (what, a, b)


def or_infinite(values):
    return np.array([np.inf if v is None else v for v in values], np.float32)


def compare(arrays, lines):
    """The rows of all arrays against the lines; returns the names of arrays that were looked at."""
    seen = set()

    def row(name, frame):
        seen.add(name)
        return arrays[name][frame]

    for line in lines:
        folder, frame = line["sensor"].replace("/", "_"), line["frame"]
        place = (frame, line["scan"]) if "scan" in line else frame
        equal("times", row(f"{folder}/times", place), line["t"])
        equal("poses", row(f"{folder}/poses", place), line["pose"])
        if "ranges" in line:
            equal("ranges", row(f"{folder}/ranges", place), or_infinite(line["ranges"]))
            angles = arrays[f"{folder}/angles"]
            assert np.allclose(angles[[0, -1]], [line["angle_min"], line["angle_max"]], atol=1e-15)
            equal("limits", arrays[f"{folder}/limits"], [line["range_min"], line["range_max"]])
        if "depths" in line:
            depths = row(f"{folder}/depths", frame)
            equal("shape", depths.shape, (line["height"], line["width"]))
            equal("depths", depths.ravel(), or_infinite(line["depths"]))
            rays = arrays[f"{folder}/rays"]
            assert rays.shape == (*depths.shape, 3) and rays.dtype == np.float32
            lengths = rays[..., 0] if line["projection"] == "pinhole" else np.linalg.norm(rays, axis=2)
            assert np.allclose(lengths, 1, atol=1e-6)
        if "png" in line:
            picture = cv2.imdecode(np.frombuffer(base64.b64decode(line["png"]), np.uint8), cv2.IMREAD_COLOR)
            equal("rgb", row(f"{folder}/rgb", frame), picture[..., ::-1])
            assert np.allclose(arrays[f"{folder}/matrix"][0], [line["fx"], 0, line["cx"]])
            model = {"pinhole": "plumb_bob", "fisheye": "equidistant", "omni": "omnidir"}[line["projection"]]
            assert list(arrays[f"{folder}/model"]) == [model], arrays[f"{folder}/model"]
            unbent = [0] * (5 if model == "plumb_bob" else 4)
            equal("coefficients", arrays[f"{folder}/coefficients"], line.get("coefficients", unbent))
            assert (f"{folder}/xi" in arrays.files) == ("mirror" in line)
            if "mirror" in line:
                equal("xi", arrays[f"{folder}/xi"], [line["mirror"]])
        if "heard" in line:
            names = list(arrays[f"{folder}/receivers"])
            ranges = np.full(len(names), np.nan)
            for one in line["heard"]:
                ranges[names.index(one["receiver"])] = one["range"]
            assert np.allclose(row(f"{folder}/ranges", frame), ranges, rtol=1e-11, equal_nan=True)
            position = line["position"] or [np.nan] * 3
            assert np.allclose(row(f"{folder}/positions", frame), position, rtol=1e-11, equal_nan=True)
    return seen


def all_sensors():
    scan("all.3dm", "--frames", str(FRAMES), "-o", "all.npz")
    lines = [json.loads(line) for line in scan("all.3dm", "--frames", str(FRAMES)).splitlines()][1:]
    arrays = np.load("all.npz")
    seen = compare(arrays, lines)
    growing = {name for name in arrays.files if len(arrays[name]) == FRAMES and name.split("/")[1] in
               ("times", "poses", "ranges", "depths", "rgb", "positions")}
    assert seen == growing, seen ^ growing
    assert arrays["nods/ranges"].shape == (FRAMES, 3, 13), arrays["nods/ranges"].shape
    equal("bent", arrays["bent/coefficients"], [-0.3, 0.1, 0.001, -0.002, 0.05])
    equal("fish", arrays["fish/coefficients"], [0.02, -0.01, 0.003, 0.001])
    assert list(arrays["t1/receivers"]) == ["u1", "u2", "u3", "u4"]
    assert np.isnan(arrays["low/positions"]).all()
    equal("receiver", arrays["t1/receiver_positions"][0], [-1.5, -1.5, 2.4])
    # The check can fail.
    lines[0]["ranges"][7] = 0.25
    try:
        compare(arrays, lines)
    except AssertionError:
        return
    raise SystemExit("self-test: another range passes")


def archive():
    """The archive is whole by other programs, too, and has no clock in it."""
    with zipfile.ZipFile("all.npz") as file:
        assert file.testzip() is None
        assert all(entry.date_time == (1980, 1, 1, 0, 0, 0) for entry in file.infolist())
        assert all(not name.startswith(("/", "..")) for name in file.namelist())
    one = scan("all.3dm", "--select", "pin", "--noise", "--frames", "500", "--to", "npz", "-j", "1")
    assert one == scan("all.3dm", "--select", "pin", "--noise", "--frames", "500", "--to", "npz", "-j", "2")


def single():
    scan("all.3dm", "--select", "l1", "--frames", "5", "-o", "one.npy")
    rows = [json.loads(line)["ranges"] for line in scan("all.3dm", "--select", "l1", "--frames", "5").splitlines()[1:]]
    equal("npy", np.load("one.npy"), [or_infinite(row) for row in rows])
    assert np.load("one.npy", mmap_mode="r").dtype == np.float32
    raw = np.frombuffer(scan("all.3dm", "--select", "l1", "--frames", "5", "--to", "raw"), np.float32)
    equal("raw", np.load("one.npy").ravel(), raw)
    scan("all.3dm", "--select", "l1", "--select", "pin", "--to", "npy", "-o", "each/")
    assert np.load("each/l1-0000.npy").shape == (1, 481)
    assert np.load("each/pin-0000.npy").shape == (1, 30, 40)
    scan("all.3dm", "--select", "t1", "--to", "npz", "-o", "each/")
    assert np.load("each/t1-0000.npz")["t1/times"].shape == (1,)
    status = subprocess.run(["scan", "square.env", "all.3dm", "--to", "npy"], capture_output=True, check=False)
    assert status.returncode == 2 and b"npy holds" in status.stderr, status


def nothing():
    scan("--poses", os.devnull, "--model", "laser", "-o", "none.npz")
    arrays = np.load("none.npz")
    assert arrays["laser1/ranges"].shape == (0, 181) and arrays["laser1/times"].shape == (0,)
    scan("--poses", os.devnull, "--model", "laser", "-o", "none.npy")
    assert np.load("none.npy").shape == (0, 181)
    with open("beam.3dm", "w", encoding="utf-8") as file:
        file.write("#3dm 1\nlaser id=l at=0,0 fov=0 beams=1\n")
    scan("beam.3dm", "-o", "beam.npz")
    equal("one beam", np.load("beam.npz")["l/ranges"], [[2]])


def cells():
    """coverage writes the table of --to csv."""
    for suffix in ("npz", "npy", "csv"):
        subprocess.run(["coverage", "square.env", "half.3dm", "--grid", "40,20", "-o", f"cells.{suffix}"],
                       check=True, stdout=subprocess.DEVNULL)
    table = np.genfromtxt("cells.csv", delimiter=",", names=True, usecols=range(7))
    arrays = np.load("cells.npz")
    shape = (20, 40)
    for name in ("indoor", "free", "seen"):
        equal(name, arrays[name], table[name].reshape(shape))
    assert arrays["indoor"].dtype == bool and 0 < arrays["seen"].sum()
    assert np.allclose(arrays["x"], table["x"].reshape(shape)[0], atol=1e-12)
    assert np.allclose(arrays["y"], table["y"].reshape(shape)[:, 0], atol=1e-12)
    equal("npy", np.load("cells.npy"), np.where(arrays["indoor"], arrays["seen"].astype(int), -1))
    densities = set(np.unique(arrays["density"]))
    assert len(densities) > 2 and densities <= {0, 12.5, 25, 62.5, 125, 250, 1000}, densities


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("square.env", "w", encoding="utf-8") as file:
        file.write(SQUARE)
    with open("all.3dm", "w", encoding="utf-8") as file:
        file.write(SENSORS)
    with open("half.3dm", "w", encoding="utf-8") as file:
        file.write("#3dm 1\nlaser at=0,0 range=20\nlaser at=1,1 range=1\ncamera at=-1.5,0,1.2 tilt=-45 fov=90 pixels=160,120\n")
    all_sensors()
    archive()
    single()
    nothing()
    cells()
