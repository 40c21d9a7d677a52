# SPDX-License-Identifier: GPL-3.0-or-later
"""Where ultrasonic positioning errs, by the thesis' noise and by receivers on the ceiling."""

import csv
import math

from lab import MISSED
from plot import Plot, viridis

TITLE = "Ultrasonic positioning over its zone"
SOURCE = "section 3.4.3 iii, eq. 3.7 to 3.10, section 5.2.2"
SECONDS = 12

STEP, HALF = 0.5, 4.0  # metres between tags; half the side of the zone
SIDE = int(2 * HALF / STEP) + 1

TAGS = ("for i in $(seq 0 16); do for j in $(seq 0 16); do echo \"tag id=$i-$j model=zps-3d-tag "
        "at=$(echo $i $j | awk '{ printf \"%g,%g\", $1 / 2 - 4, $2 / 2 - 4 }'),0.5 {}\"; done; done")


def errors(lab, file):
    """For each tag its position and the distances of its fixes from there, on the floor."""
    found = {}
    with open(lab.path(file), encoding="utf-8", newline="") as table:
        for row in csv.DictReader(table):
            i, j = (int(word) for word in row["sensor"].split("-"))
            place = (i * STEP - HALF, j * STEP - HALF)
            fixes = found.setdefault(place, [])
            if row["x"]:
                fixes.append(math.hypot(float(row["x"]) - place[0], float(row["y"]) - place[1]))
    return found


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def error_map(lab, name, found, most, title, caption):
    plot = Plot((-HALF - STEP / 2, HALF + STEP / 2), (-HALF - STEP / 2, HALF + STEP / 2), title, "x in m",
                "y in m", width=560, equal=True, right=110)
    for (x, y), fixes in found.items():
        color = viridis(1000 * sum(fixes) / len(fixes) / most) if fixes else "#ffffff"
        plot.box((x - STEP / 2, y - STEP / 2), (x + STEP / 2, y + STEP / 2), color)
    plot.scale(0, most, "mm")
    lab.svg(name, plot.svg(), caption)


def run(lab):
    lab.text("The thesis adds noise to the true position of a tag. Here are that model, and one that computes the "
             "position from the times of flight to receivers on the ceiling, for 289 tags over the zone of 8 m by "
             "8 m.")
    frames = len(lab.seeds(200, 20))
    lab.scene("ispace.env")
    lab.given("white noise on both coordinates, with mean 0 and standard deviation 0.1 m", "eq. 3.7 to 3.10")
    lab.given("an accuracy of 50 mm of the real system", "the section of table 2.1")
    lab.given("a zone of about 8 m by 8 m; at least four receivers for a position",
              "section 5.2.2, section 3.4.3 iii")
    lab.assumption("25 receivers at 2.7 m, 2 m apart, which hear within 60 degrees of straight down; a distance errs "
                   "by 10 mm; tags at 0.5 m; 20 degrees Celsius.")
    lab.shell(f"{{ echo '#3dm 1'; {TAGS.replace('{}', 'locate=simple')}; }} > simple.3dm")
    lab.shell("{ echo '#3dm 1'; for x in -4 -2 0 2 4; do for y in -4 -2 0 2 4; do "
              "echo \"ultrasound model=zps-3d at=$x,$y,2.7 tilt=-90\"; done; done; "
              f"{TAGS.replace('{}', '')}; }} > receivers.3dm")
    lab.tool("scan", "ispace.env", "simple.3dm", "--noise", "--frames", frames, "-q", "-o", "simple.csv")
    lab.tool("scan", "ispace.env", "receivers.3dm", "--noise", "--frames", frames, "-q", "-o", "receivers.csv")
    simple, received = errors(lab, "simple.csv"), errors(lab, "receivers.csv")
    every = [error for fixes in simple.values() for error in fixes]
    lab.row("Noise on the position: root mean square of one coordinate", 0.1,
            math.sqrt(sum(e * e for e in every) / len(every) / 2), "m", digits=4, bound=(0.098, 0.102),
            note="The rest is chance.")
    lab.row("Noise on the position: mean error", 0.1 * math.sqrt(math.pi / 2), sum(every) / len(every), "m",
            digits=4, bound=(0.122, 0.128),
            note="The thesis' figure follows from its formula: the mean of a Rayleigh distribution.")
    heard = [error for fixes in received.values() for error in fixes]
    lab.row("Receivers: share of fixes that came", None, 100 * len(heard) / (frames * len(received)), "%", bound=(99, 100))
    lost = sum(1 for fixes in received.values() if not fixes)
    lab.row("Receivers: mean error", None, 1000 * sum(heard) / len(heard), "mm", digits=1, bound=(1, 50))
    lab.row("Receivers: 95th percentile", 50, 1000 * percentile(heard, 0.95), "mm", digits=1, bound=(1, 50),
            verdict=MISSED, note="The thesis' figure is the accuracy of the real system, with reflections and draughts; here are "
            "neither.")
    lab.row("Receivers: places without a position", None, lost, f"of {SIDE * SIDE}", bound=(0, 0))
    error_map(lab, "simple.svg", simple, 200, "Mean error, noise on the position",
              f"Noise N(0, 0.1 m) on both coordinates, {frames} fixes a place: the same everywhere.")
    error_map(lab, "receivers.svg", received, 40, "Mean error, receivers",
              f"Receivers on the ceiling, {frames} fixes a place: worse where few hear the tag, at the edge.")
