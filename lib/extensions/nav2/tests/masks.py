#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks for Nav2's costmap filters: OpenCV reads their pictures, and the formulas of Nav2's map_server and filters
convert them to the values of coverage --to csv for the same cells; see coverage(1) and envc(1)."""
import csv
import os
import subprocess
import sys
import tempfile

try:
    import cv2
    import numpy as np
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

NO_SPEED_LIMIT = 0.0  # as nav2_costmap_2d has it


def run(*arguments, status=0):
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert done.returncode == status, (arguments, done)
    return done.stderr


def occupancy_grid(name):
    """map_server's loadMapFromFile() for mode scale: cells from the lowest row on."""
    with open(name, encoding="utf-8") as file:
        text = file.read()
    head = yaml.safe_load(text)
    assert head["mode"] == "scale" and head["negate"] == 0
    picture = cv2.imread(head["image"], cv2.IMREAD_UNCHANGED)
    assert picture.ndim == 2 and picture.dtype == np.uint8
    occupied = 1 - picture[::-1] / 255.0
    low, high = head["free_thresh"], head["occupied_thresh"]
    values = np.rint((occupied - low) / (high - low) * 100).astype(int)
    values[occupied > high] = 100
    values[occupied < low] = 0
    return head, values, text


def parameters(text):
    """The block of parameters in the comment, which is YAML itself."""
    block = "\n".join(line[2:] for line in text.splitlines() if line.startswith("# "))
    return yaml.safe_load(block[block.index("costmap_filter_info_server:"):])


def speed_limit(value, info):
    """SpeedFilter::process() for filters in per cent."""
    if value == 0:
        return NO_SPEED_LIMIT
    limit = value * info["multiplier"] + info["base"]
    return limit if 0 <= limit <= 100 else NO_SPEED_LIMIT


def cells_of(*arguments):
    run("coverage", "room.env", "lasers.3dm", "--cell", "0.05", "-o", "cells.csv", *arguments)
    with open("cells.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def speeds():
    for given, wanted in (((), [30, 60, 100]), (("--speeds", "7%,0.5,66%,99%"), [7, 50, 66, 99])):
        run("coverage", "room.env", "lasers.3dm", "--to", "nav2-speed", *given, "-o", "speed.yaml")
        head, values, text = occupancy_grid("speed.yaml")
        servers = parameters(text)
        info = servers["costmap_filter_info_server"]["ros__parameters"]
        assert (info["type"], info["base"], info["multiplier"]) == (1, 100.0, -1.0), info
        assert isinstance(info["base"], float) and isinstance(info["multiplier"], float)
        assert info["mask_topic"] == servers["filter_mask_server"]["ros__parameters"]["topic_name"]
        seen = set()
        for cell in cells_of():
            column, row, times = (int(cell[key]) for key in ("column", "row", "seen"))
            assert abs(head["origin"][0] + (column + 0.5) * head["resolution"] - float(cell["x"])) < 1e-9
            assert abs(head["origin"][1] + (row + 0.5) * head["resolution"] - float(cell["y"])) < 1e-9
            limit = speed_limit(values[row, column], info)
            meant = wanted[min(times, len(wanted) - 1)] if cell["free"] == "1" else 100
            assert limit == (NO_SPEED_LIMIT if meant == 100 else meant), (cell, limit)
            seen.add((times, limit))
        assert len({times for times, _ in seen}) >= 3, seen


def unseen():
    run("coverage", "room.env", "lasers.3dm", "--to", "nav2-keepout", "-o", "unseen.yaml")
    _, values, text = occupancy_grid("unseen.yaml")
    info = parameters(text)["costmap_filter_info_server"]["ros__parameters"]
    assert (info["type"], info["base"], info["multiplier"]) == (0, 0.0, 1.0), info
    for cell in cells_of():
        meant = 100 if cell["free"] == "1" and cell["seen"] == "0" else 0
        assert values[int(cell["row"]), int(cell["column"])] == meant, cell
    assert set(np.unique(values)) == {0, 100}


def zones():
    zone = ("--zone", "store", "--zone", "poly:1,1;2,1;1,2", "--zone", "rect:-1.49,-1.49,-1.48,-1.48")
    run("envc", "room.env", "--to", "nav2-keepout", *zone, "-o", "keep out.yaml")
    head, values, text = occupancy_grid("keep out.yaml")
    assert parameters(text)["costmap_filter_info_server"]["ros__parameters"]["type"] == 0
    run("envc", "room.env", "--to", "ros", "-o", "map.yaml")
    with open("map.yaml", encoding="utf-8") as file:
        plain = yaml.safe_load(file)
    assert (plain["origin"], plain["resolution"]) == (head["origin"], head["resolution"])
    assert cv2.imread("map.pgm", cv2.IMREAD_UNCHANGED).shape == values.shape
    kept = 0
    for row, column in np.ndindex(*values.shape):
        x, y = (head["origin"][i] + (at + 0.5) * head["resolution"] for i, at in enumerate((column, row)))
        edge = min(abs(x + 1.5), abs(x + 0.5), abs(y - 0.5), abs(y - 1.5), abs(x - 1), abs(y - 1), abs(x + y - 3))
        small = abs(x + 1.485) < 0.025 and abs(y + 1.485) < 0.025
        if edge < 1e-9:
            continue  # on the line: rounding decides
        meant = (-1.5 < x < -0.5 and 0.5 < y < 1.5) or (x > 1 and y > 1 and x + y < 3) or small
        assert values[row, column] == (100 if meant else 0), (x, y, values[row, column])
        kept += meant
    assert kept > 500, kept
    # Our own reader takes such a map for a plan, in which white is free.
    run("envc", "keep out.yaml", "--to", "env", "-o", "again.env")


def mistakes():
    for arguments, phrase in (
            (("envc", "room.env", "--to", "nav2-keepout", "-o", "a.yaml"), "say which floor to keep out of"),
            (("envc", "room.env", "--zone", "store", "-o", "a.glb"), "--zone is for --to nav2-keepout"),
            (("envc", "room.env", "--to", "nav2-keepout", "--zone", "stroe", "-o", "a.yaml"), "store"),
            (("envc", "room.env", "--to", "nav2-keepout", "--zone", "store"), "two files"),
            (("envc", "room.env", "--to", "nav2-keepout", "--zone", "rect:90,90,90.01,90.01", "-o", "a.yaml"),
             "beside the room"),
            (("coverage", "room.env", "lasers.3dm", "--to", "nav2-speed", "--speeds", "0%,50%", "-o", "a.yaml"),
             "from 1% to 100%"),
            (("coverage", "room.env", "lasers.3dm", "--to", "nav2-speed", "--speeds", "", "-o", "a.yaml"), "--speeds"),
            (("coverage", "room.env", "lasers.3dm", "--speeds", "50%", "-o", "a.png"), "--to nav2-speed"),
            (("coverage", "room.env", "lasers.3dm", "--to", "nav2-speed", "-o", "a.png"), "two files"),
            (("coverage", "room.env", "lasers.3dm", "--to", "nav2-speed", "--grid", "5", "-o", "a.yaml"), "--cell")):
        assert phrase in (error := run(*arguments, status=2)), error
    assert not os.path.exists("a.yaml") and not os.path.exists("a.pgm")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    with open("room.env", "w", encoding="utf-8") as file:
        file.write("#env 1\nispace size=4,3.2\ncube at=0,0 size=0.6,0.4,1\n"
                   "zone id=store at=-1,1 size=1,1\n")
    with open("lasers.3dm", "w", encoding="utf-8") as file:
        file.write("#3dm 1\nlaser at=-1.9,0 range=3\nlaser at=1.9,0 heading=180 range=2.5\n"
                   "laser at=0,1.5 heading=-90 range=2\n")
    speeds()
    unseen()
    zones()
    mistakes()
