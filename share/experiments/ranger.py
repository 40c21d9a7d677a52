# SPDX-License-Identifier: GPL-3.0-or-later
"""A 3-D range camera near and far, and the colours of its depths."""

import json
import math
import statistics

TITLE = "A 3-D ranger, near and far"
SOURCE = "section 3.4.8 iii, fig. 3.26 and 3.27"
SECONDS = 8

DISTANCE = {"one": 1.0, "two": 2.0, "three": 3.0}
COLUMNS, ROWS, FOCAL = 176, 144, 200.0  # of the SR-3000, in pixels
BOX = 0.6                               # metres that the box is wide and high
BACK = 7.0                              # metres from the camera to the wall behind, along the axis


def frames(lab, file):
    """The depths of each ranger, row by row; None is no return."""
    readings = [json.loads(line) for line in lab.read(file).splitlines()[1:]]
    return {reading["sensor"]: reading["depths"] for reading in readings}


def near_and_far(lab):
    lab.tool("scan", "near-far.env", "near-far.3dm", "-o", "ideal.jsonl")
    lab.tool("scan", "near-far.env", "near-far.3dm", "--noise", "-o", "noisy.jsonl")
    lab.tool("scan", "near-far.env", "near-far.3dm", "--spectrum", "0.5,5", "--to", "png", "-o", "ideal/")
    ideal, noisy = frames(lab, "ideal.jsonl"), frames(lab, "noisy.jsonl")
    for sensor, distance in DISTANCE.items():
        depths = ideal[sensor]
        middle = depths[(ROWS // 2) * COLUMNS + COLUMNS // 2]
        lab.row(f"{distance:g} m away: depth of the box in the middle", distance, middle, "m", digits=3,
                bound=(distance - 0.001, distance + 0.001))
        row = depths[(ROWS // 2) * COLUMNS:(ROWS // 2 + 1) * COLUMNS]
        wide = sum(1 for depth in row if depth is not None and abs(depth - distance) < 0.001)
        lab.row(f"{distance:g} m away: the box is wide", None, wide, "pixels",
                note=f"A pinhole with a focal length of 200 pixels: {FOCAL * BOX / distance:.0f}.",
                bound=(FOCAL * BOX / distance - 2, FOCAL * BOX / distance + 2), digits=0)
        errors = [b - a for a, b in zip(depths, noisy[sensor])
                  if a is not None and b is not None and abs(a - distance) < 0.001]
        lab.row(f"{distance:g} m away: standard deviation on the box, with noise", None,
                1000 * statistics.pstdev(errors), "mm", digits=1)
    for letter, (sensor, distance) in zip("abc", DISTANCE.items()):
        lab.picture(f"ideal/{sensor}-0000-color.png",
                    f"Fig. 3.26 {letter}: {distance:g} m from the box; red is near, blue far, from 0.5 to 5 m.")


def spectrum(lab):
    lab.text("In fig. 3.27 the background of the real sensor is blue and full of noise, and that of the "
             "simulated one is red: the real sensor does not show the values of its spectrum, so the thesis could only "
             "approach them. Here they can be set (--spectrum). The real sensor's "
             "distances repeat after 7.5 m, so a wall at the end of its range breaks up into blue and red.")
    lab.write("deep.env", "#env 1\nispace at=1.2,0 size=7.6,7,4\ncube at=0.25,0 size=0.5,0.6,0.6\n"
              "cylinder at=0.3,-0.7 size=0.4,0.4,0.8\nchair at=0.4,0.8 heading=200\n")
    lab.write("deep.3dm", "#3dm 1\nranger id=simulated at=-2,0,0.5 range=12 fov=47.5,39.6 pixels=176,144\n"
              "ranger id=real model=sr-3000 at=-2,0,0.5\n")
    for name, options, caption in (
            ("simulated", ("--spectrum", "8,0.5"), "Fig. 3.27 c, as the thesis' simulator: far is red, no noise."),
            ("real", ("--spectrum", "0.5,7.5", "--noise"),
             "Fig. 3.27 a, as the real sensor: far is blue, with noise; beyond 7.5 m it begins anew with red.")):
        lab.tool("scan", "deep.env", "deep.3dm", "--select", name, *options, "--to", "png", "-o", f"{name}.png")
        lab.picture(f"{name}-color.png", caption)
    lab.tool("scan", "deep.env", "--view", "first-person:-2.2,0,0,-12", "--size", "720,540", "-o", "view.png")
    lab.picture("view.png", "Fig. 3.27 d: the scene.")
    lab.tool("scan", "deep.env", "deep.3dm", "-o", "deep.jsonl")
    depths = frames(lab, "deep.jsonl")
    row, column = 15, 20
    slope = math.hypot(1, (column - (COLUMNS - 1) / 2) / FOCAL, (row - (ROWS - 1) / 2) / FOCAL)
    pixel = row * COLUMNS + column
    lab.row("Background, a corner of the picture: depth by the simulated sensor", "far", depths["simulated"][pixel],
            "m", bound=(BACK - 0.001, BACK + 0.001), digits=3)
    lab.row("The same by the real one, without noise", "noise", depths["real"][pixel], "m", digits=3,
            bound=(BACK - 7.5 / slope - 0.001, BACK - 7.5 / slope + 0.001),
            note=f"The wall is {BACK * slope:.2f} m away along this ray, of which the device reads what exceeds 7.5 m.")


def run(lab):
    lab.text("The same range camera looks at the same things from 1 m, 2 m and 3 m. The thesis finds that the "
             "colours change with the distance.")
    lab.scene("near-far.env", "near-far.3dm")
    lab.given("an SR-3000", "section 3.4.3 iv, fig. 3.17")
    lab.given("1 m, 2 m and 3 m from the objects", "fig. 3.26")
    lab.given("the background is red in the simulator and blue and noisy in the real picture",
              "section 3.4.8 iii, fig. 3.27")
    lab.assumption("The objects: a box, a drum and a chair; the room; the camera at 0.4 m. Field of view, noise "
                   "and the 7.5 m after which distances repeat are the device's (share/devices/rangers.3dm).")
    near_and_far(lab)
    spectrum(lab)
