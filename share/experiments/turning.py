# SPDX-License-Identifier: GPL-3.0-or-later
"""A laser under the ceiling turns and makes a cloud of points."""

import csv
import math

from plot import BLUE, ORANGE, Plot
from surfaces import Surfaces, cloud_png, read_stl

TITLE = "A 3-D scan by a laser that turns under the ceiling"
SOURCE = "section 5.4.2, table 5.4, fig. 5.18 and 5.19"
SECONDS = 25

SIGMA = 0.01  # metres, of the noise of a range


def cloud(lab, file):
    """The points, and how many beams were measured."""
    with open(lab.path(file), encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    return [(float(row["x"]), float(row["y"]), float(row["z"])) for row in rows if row["x"]], len(rows)


def share_within(distances, most):
    return 100 * sum(1 for d in distances if d <= most) / len(distances)


def run(lab):
    lab.text("A laser hangs at 4 m and lies on its side; it turns by a degree from scan to scan, and its scans "
             "together are a cloud of what is below. We measure how far each point lies from the true surfaces.")
    lab.scene("hall.env", "hall.3dm")
    lab.given("4 m high; one scan each degree; at most 7 m; -90 to 90 degrees in steps of 1 degree; tilt 90 degrees "
              "(downwards: our -90)", "table 5.4")
    lab.assumption("The hall of 9 m by 9 m and what stands in it; its ceiling at 4.5 m; a whole turn, which sees "
                   "everything twice; noise of 10 mm in the second scan.")
    lab.tool("scan", "hall.env", "hall.3dm", "-o", "ideal.csv")
    lab.tool("envc", "hall.3dm", "--set", f"turning.sigma={SIGMA}", "--to", "3dm", "-o", "noisy.3dm")
    lab.tool("scan", "hall.env", "noisy.3dm", "--noise", "-o", "noisy.csv")
    lab.tool("scan", "hall.env", "hall.3dm", "-o", "hall.pcd")
    lab.tool("envc", "hall.env", "-o", "hall.stl")
    lab.tool("envc", "hall.3dm", "--set", "turning.sweep=none", "--to", "3dm", "-o", "still.3dm")
    lab.tool("scan", "hall.env", "still.3dm", "--view", "orbit", "--show", "beams", "--size", "900,675", "-o",
             "scene.png")
    (ideal, beams), (noisy, _) = cloud(lab, "ideal.csv"), cloud(lab, "noisy.csv")
    surfaces = Surfaces(read_stl(lab.path("hall.stl")))
    every = 8 if lab.quick else 1
    exact = [surfaces.distance(point) for point in ideal[::every]]
    strays = [surfaces.distance(point) for point in noisy[::every]]
    lab.row("Beams of a turn, 181 a scan", 181 * 360, beams, bound=(65160, 65160))
    lab.row("Beams that return within 7 m", None, len(ideal),
            note="The rest would meet the corners of the hall, farther away.")
    lab.row("Without noise: greatest distance of a point from the true surfaces", 0, 1000 * max(exact), "mm",
            bound=(0, 1), digits=3, note="Round things are triangles in the model that is measured against.")
    mean_square = sum(d * d for d in strays) / len(strays)
    lab.row(f"With noise of {1000 * SIGMA:g} mm: root mean square distance", None, 1000 * math.sqrt(mean_square),
            "mm", bound=(0, 1000 * SIGMA), digits=2,
            note="Less than the noise along the beams, which meet most surfaces aslant.")
    lab.row("With noise: points within 20 mm of the surfaces", None, share_within(strays, 0.02), "%",
            bound=(95, 100), digits=1)
    lab.picture("scene.png", "Fig. 5.19 a: the hall without its ceiling, and the beams of the first scan.")
    below = [point for point in ideal if point[2] < 2.5]
    with open(lab.path("cloud.png"), "wb") as file:
        file.write(cloud_png(below, 900, 675, 0, 2.5))
    lab.picture("cloud.png", "Fig. 5.19 b: the cloud below 2.5 m; the higher, the brighter. Things hide what is "
                "behind them as seen from the laser.")
    plot = Plot((0, 40), (0, 100), "Distance of points from the true surfaces", "at most so many mm",
                "share of the points in %", height=280)
    for distances, color, name in ((exact, BLUE, "without noise"), (strays, ORANGE, "noise of 10 mm")):
        plot.line([(mm / 2, share_within(distances, mm / 2000)) for mm in range(81)], color, 2.5, name=name)
    lab.svg("distances.svg", plot.svg(), "How many points lie how near to the true surfaces.")
