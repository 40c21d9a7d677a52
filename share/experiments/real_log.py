# SPDX-License-Identifier: GPL-3.0-or-later
"""The log of a real laser beside its simulation."""

import csv
import json
import math
import os

from plot import BLUE, ORANGE, Plot

TITLE = "A real laser beside the simulated one"
SOURCE = "section 3.4.8 ii, fig. 3.24, 3.25"
LOG = "csail.corrected.clf"
SECONDS = 3


def halves(lab, path):
    """Writes the even scans, from which the room is learned, and the odd ones, which are compared with it."""
    with open(path, encoding="ascii", errors="replace") as file:
        scans = [line for line in file if line.startswith("FLASER")]
    for name, first in (("even.clf", 0), ("odd.clf", 1)):
        with open(lab.path(name), "w", encoding="ascii") as file:
            file.writelines(scans[first::2])
    lab.command(f"grep ^FLASER {LOG} | awk 'NR % 2 == 1' >even.clf\n"
                f"grep ^FLASER {LOG} | awk 'NR % 2 == 0' >odd.clf")


def beams(lab, name):
    """Ranges of each scan, measured and simulated: None is no return."""
    scans = {}
    with open(lab.path(name), newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            pair = [float(row[key]) if row[key] else None for key in ("measured", "expected")]
            scans.setdefault(int(row["scan"]), []).append(pair)
    return scans


def obstacle_map(lab, scan, which, name, color, caption):
    """The ends of a scan's beams about the sensor, as the thesis draws them."""
    step = math.pi / max(1, len(scan) - 1)
    plot = Plot((-6, 6), (-1, 8), width=420, equal=True, x_label="m to the right", y_label="m ahead")
    ends = []
    for k, pair in enumerate(scan):
        if pair[which] is None:
            continue
        bearing = -math.pi / 2 + k * step
        ends.append((-pair[which] * math.sin(bearing), pair[which] * math.cos(bearing)))
    plot.dots([(x, y) for x, y in ends if abs(x) < 6 and y < 8], color, 2)
    plot.dots([(0, 0)], "#1f2328", 6)
    lab.svg(name, plot.svg(), caption)


def run(lab):
    lab.text("The thesis lays the obstacle maps of two real lasers beside those of the simulated ones and finds them "
             "nearly the same, but for what the real ones see and the plan lacks. Its scans are lost. Here a public "
             "log takes their place, of a robot with a SICK laser in the CSAIL building (C. Stachniss, Radish): the "
             "room is learned from the even scans and simulates the odd ones.")
    path = os.path.join(os.environ.get("ISPACE_TEST_DATA", ""), "logs", LOG)
    if not os.path.isfile(path):
        lab.text(f"Not run: the log is not part of ispace. With ISPACE_TEST_DATA a folder that has logs/{LOG}, this "
                 "section has its figures.")
        return
    halves(lab, path)
    lab.tool("envc", "even.clf", "-q", "-o", "room.glb")
    figures = lab.json("scan", "room.glb", "--against", "odd.clf", "-q")
    lab.tool("scan", "room.glb", "--against", "odd.clf", "-q", "-o", "beams.csv")
    lab.tool("scan", "room.glb", "--against", "odd.clf", "-q", "-o", "residuals.png")
    scans = beams(lab, "beams.csv")
    # The scan with the most returns within the maps.
    shown = max(scans, key=lambda n: sum(1 for a, b in scans[n] if a and b and max(a, b) < 6))
    obstacle_map(lab, scans[shown], 0, "real.svg", ORANGE, "As fig. 3.24 b: one scan of the real laser.")
    obstacle_map(lab, scans[shown], 1, "simulated.svg", BLUE, "As fig. 3.24 a: the simulated laser at the same pose.")
    lab.picture("residuals.png", "All odd scans on the learned room: green within 5 cm of the simulation, blue shorter, "
                "red longer.")
    lab.row("Returns within 20 cm of the simulation", "almost the same", 100 * figures["inliers"], "%", bound=(82, 100),
            note="People, doors and the cells of 5 cm of the learned room make up the rest.", digits=1)
    lab.row("Spread of the residuals (robust)", None, 100 * figures["sigma"], "cm", bound=(0, 8), digits=1)
    lab.row("Mean error of the residuals (median)", None, 100 * figures["bias"], "cm", bound=(-6, 6), digits=1)
    lab.row("Beams that end at something nearer than the room", "some", 100 * figures["short"], "%", bound=(0, 15),
            note="The thesis finds such points on one side of the real map: facilities nearby reflect the beam.",
            digits=1)
    with open(lab.path("figures.json"), "w", encoding="utf-8") as file:
        json.dump({key: figures[key] for key in ("inliers", "sigma", "bias", "hit", "short", "max", "random")}, file)
