#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges by a recorded run where the picture of the projector was.

    judge.py RUN

The picture is in place while the axis of the projector meets the floor within 0.5 m of the point a metre ahead of the
person, or of the nearest point 0.3 m from the walls. Times at which the person pauses count, too; the first two seconds do
not. Prints the share of them, and the mean distance.
"""

import csv
import math
import os
import sys

LENGTH, WIDTH, HEIGHT = 6.0, 5.0, 2.6  # of room.env, the lens is over its middle
AHEAD, MARGIN, FIRST, NEAR = 1.0, 0.3, 2.0, 0.5


def rows(run: str, name: str):
    with open(os.path.join(run, name), encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def main() -> int:
    if len(sys.argv) != 2:
        sys.exit("usage: judge.py FOLDER, a run that simrun --record has written")
    run = sys.argv[1]
    turns = [(float(row["t"]), row["state"], float(row["value"])) for row in rows(run, "states.csv") if row["id"] == "p" and row["state"] in ("pan", "tilt")]
    angles = {"pan": 0.0, "tilt": 0.0}
    seen, near, total = 0, 0, 0.0
    for row in rows(run, "people.csv"):
        time = float(row["t"])
        while turns and turns[0][0] <= time:
            _, axis, angle = turns.pop(0)
            angles[axis] = angle
        if time < FIRST:
            continue
        heading = math.radians(float(row["heading_deg"]))
        x = min(max(float(row["x"]) + AHEAD * math.cos(heading), MARGIN - LENGTH / 2), LENGTH / 2 - MARGIN)
        y = min(max(float(row["y"]) + AHEAD * math.sin(heading), MARGIN - WIDTH / 2), WIDTH / 2 - MARGIN)
        seen += 1
        if angles["tilt"] >= 0:
            total += math.hypot(LENGTH, WIDTH)
            continue
        reach = HEIGHT / math.tan(math.radians(-angles["tilt"]))
        pan = math.radians(angles["pan"])
        apart = math.hypot(reach * math.cos(pan) - x, reach * math.sin(pan) - y)
        near += apart <= NEAR
        total += apart
    print(f"in place {100 * near / seen:.0f} % of the time, {total / seen:.2f} m from it in the mean")
    return 0


if __name__ == "__main__":
    sys.exit(main())
