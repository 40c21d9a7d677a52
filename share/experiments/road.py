# SPDX-License-Identifier: GPL-3.0-or-later
"""The kerbs of a road, found by a laser that is tilted down."""

import csv
import math
import os
import random
import statistics

from lab import SHARE
from plot import BLUE, GREEN, ORANGE, Plot

TITLE = "Road side detection with a tilted laser"
SOURCE = "section 5.4.1, table 5.3, fig. 5.16 and 5.17"
SECONDS = 25

EDGE, KERB = 1.0, 0.15  # m: the kerbs of road.env, to each side of the middle
CLIENT = ("front", "--height", "0.5", "--tilt", "-30", "-o", "kerbs.csv")
ON_ROBOT = """#3dm 1
robot id=r1 model=pioneer-2dx at=-5,0 motion_noise=0,0,0,0 odometry_noise=0,0,0,0
laser id=front on=r1 at=0,0,0.5 tilt=-30 range=3 fov=180 step=0.25 sigma=0.01
"""


def look(lab, layout, seed, *options, shown=False):
    """(side, x, y, height) of the kerbs that the client finds, and its output."""
    words = [*CLIENT, *options]
    with lab.serve("road.env", layout, "--clock", "step", "--noise", "--seed", seed, shown=shown) as port:
        if shown:
            lab.command(f"python3 $ISPACE/share/examples/road_side.py 7001 {' '.join(map(str, words))}")
        program = os.path.join(SHARE, "examples", "road_side.py")
        said = lab.tool("python3", program, port, *words, shown=False, statuses=(0, 3))
    with open(lab.path("kerbs.csv"), encoding="utf-8", newline="") as file:
        found = [(row["side"], float(row["x"]), float(row["y"]), float(row["height"])) for row in csv.DictReader(file)]
    return found, said


def off(kerb):
    """Error of a kerb seen from the middle of the road, m."""
    return abs(kerb[2]) - EDGE


def standing(lab):
    found, _ = look(lab, "road.3dm", 0, shown=True)
    lab.row("Without noise: edges found, of 2", "a pattern at both", len(found), bound=(2, 2))
    lab.row("Without noise: greatest error of an edge", None, 1000 * max(abs(off(kerb)) for kerb in found), "mm",
            bound=(0, 5), digits=2)
    for side in ("left", "right"):
        (height,) = [kerb[3] for kerb in found if kerb[0] == side]
        lab.row(f"Without noise: height of the {side} kerb", KERB, height, "m", digits=3, bound=(0.149, 0.151))
    lab.tool("envc", "road.3dm", "--set", "front.sigma=0.01", "--to", "3dm", "-o", "noisy.3dm")
    seeds = lab.seeds(20, 2)
    noisy = [kerb for seed in seeds for kerb in look(lab, "noisy.3dm", seed, "--scans", 10, shown=seed == 0)[0]]
    errors = sorted(abs(off(kerb)) for kerb in noisy)
    lab.row("Noise of 10 mm: edges found", None, len(noisy), bound=(20 * len(seeds), 20 * len(seeds)),
            note="Two in each of ten scans of each seed.")
    lab.row("Noise of 10 mm: mean error of an edge", None, 1000 * statistics.fmean(errors), "mm", bound=(0.1, 10))
    lab.row("Noise of 10 mm: 95th percentile of the errors", None, 1000 * errors[math.ceil(0.95 * len(errors)) - 1],
            "mm", bound=(0, 20))
    lab.row("Noise of 10 mm: mean height of a kerb", KERB, statistics.fmean(kerb[3] for kerb in noisy), "m", digits=3,
            bound=(0.135, 0.165), note="The top is taken as the median of the beams behind the edge, some of which still "
            "end on the face.")


def numbers(said):
    """Parses the client's output for each side: metres beside the start, degrees, metres of height."""
    return {line.split(":")[0]: [float(word) for word in line.replace(":", " ").split()
                                 if word.replace(".", "", 1).lstrip("-").isdigit()]
            for line in said.splitlines()}


def driving(lab):
    lab.write("robot.3dm", ON_ROBOT)
    beside, turned, shown = [], [], None
    for seed in lab.seeds(10, 1):
        draw = random.Random(seed)
        y, heading = draw.uniform(-0.3, 0.3), draw.uniform(-3, 3)
        lab.tool("envc", "robot.3dm", "--set", f"r1.at=-5,{y:.3f}", "--set", f"r1.heading={heading:.2f}", "--to",
                 "3dm", "-o", "drive.3dm", shown=seed == 0)
        found, said = look(lab, "drive.3dm", seed, "--drive", "r1,6", shown=seed == 0)
        for side, (metres, degrees, *_) in numbers(said).items():
            y_edge = EDGE if side == "left" else -EDGE
            beside.append(abs(metres - abs(y_edge - round(y, 3)) / math.cos(math.radians(heading))))
            turned.append(abs(degrees + heading))
        shown = shown or (found, round(y, 3), math.radians(round(heading, 2)))
    count = len(beside)
    edges = 2 * len(lab.seeds(10, 1))
    lab.row("On a robot that drives 6 m: edges found", None, count, bound=(edges, edges),
            note="Each is a line fitted through all scans, two in each drive.")
    lab.row("On a robot: mean error of the edge beside its start", None, 1000 * statistics.fmean(beside), "mm",
            bound=(0, 10))
    lab.row("On a robot: mean error of the direction of the road", None, statistics.fmean(turned), "°", bound=(0, 0.3),
            digits=3)
    return shown


def draw_section(lab):
    """The points of one scan as a cross section of the road."""
    text = lab.tool("scan", "road.env", "noisy.3dm", "--noise", "--to", "csv", shown=False)
    rows = list(csv.DictReader(text.splitlines()))
    plot = Plot((-3, 3), (-0.06, 0.3), "", "y in m, across the road", "z in m", height=320)
    plot.line([(-3, KERB), (-EDGE, KERB), (-EDGE, 0), (EDGE, 0), (EDGE, KERB), (3, KERB)], GREEN, 1.5, name="true")
    plot.dots([(float(row["y"]), float(row["z"])) for row in rows if row["x"]], BLUE, 1.4,
              name="beams, with noise of 10 mm")
    lab.svg("section.svg", plot.svg(), "The points of one scan, seen along the road: the pattern that gives the kerbs "
            "away.")


def draw_drive(lab, found, y, heading):
    plot = Plot((-5.5, 3), (-2.6, 2.6), "", "x in m", "y in m", equal=True)
    plot.line([(-5.5, EDGE), (3, EDGE)], GREEN, 1.5, name="true edges")
    plot.line([(-5.5, -EDGE), (3, -EDGE)], GREEN, 1.5)
    cos, sin = math.cos(heading), math.sin(heading)
    plot.line([(-5, y), (-5 + 6 * cos, y + 6 * sin)], ORANGE, 2, name="way of the robot")
    plot.dots([(-5 + a * cos - b * sin, y + a * sin + b * cos) for _, a, b, _ in found], BLUE, 2, name="edges found")
    lab.svg("drive.svg", plot.svg(), "A drive along the road, and the edge that each scan finds, by odometry.")


def run(lab):
    lab.text("A laser that looks down sees a road's kerbs as steps in its line across the road. The thesis stops at the "
             "pattern; share/examples/road_side.py, in Python over TCP, finds the kerbs in it: where they are, "
             "which way they lead and how high they are.")
    lab.scene("road.env", "road.3dm")
    lab.given("road sides 0.15 m high; a laser 0.5 m high, 3 m, -90 to 90 degrees in steps of 0.25 degree, tilt "
              "30 degrees (downwards: our -30)", "table 5.3")
    lab.assumption("The road is 2 m wide between two kerbs, straight and level. Noise is 10 mm (standard deviation).")
    lab.assumption("The robot's start, up to 0.3 m beside the middle and 3° aslant, is drawn from the seed; its "
                   "odometry is exact.")
    standing(lab)
    lab.tool("scan", "road.env", "road.3dm", "--view", "orbit", "--show", "beams", "--size", "900,600", "-o",
             "scene.png")
    lab.picture("scene.png", "Fig. 5.16: the road and the beams of the tilted laser.")
    lab.tool("scan", "road.env", "road.3dm", "--to", "png", "--size", "600", "-o", "map/")
    lab.picture("map/front-0000.png", "Fig. 5.17: the obstacle map of one scan.")
    shown = driving(lab)
    draw_section(lab)
    draw_drive(lab, *shown)
