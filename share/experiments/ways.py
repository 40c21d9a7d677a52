# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways of robots and people in records of simrun, and the room that they lie in."""

import csv
import json
import math


def rows(lab, file):
    with open(lab.path(file), encoding="utf-8", newline="") as table:
        return list(csv.DictReader(table))


def way(lab, file, who, every=0.1, x="x", y="y"):
    """(t, x, y) of a mover in robots.csv or people.csv of a record, each tenth of a second and at the end."""
    found, due = [], 0.0
    mine = [row for row in rows(lab, file) if row["id"] == who]
    for row in mine:
        t = float(row["t"])
        if t >= due - 1e-9 or row is mine[-1]:
            found.append((t, float(row[x]), float(row[y])))
            due = t + every
    return found


def length(places):
    return sum(math.dist(a[-2:], b[-2:]) for a, b in zip(places, places[1:]))


class Obstacles:
    """The outlines of the bodies in a room at a height, as segments ((x, y), (x, y))."""

    def __init__(self, lab, env, height):
        text = lab.tool("envc", env, "--slice", height, "--to", "geojson", shown=False)
        self.outlines = []
        for feature in json.loads(text)["features"]:
            if feature["properties"]["type"] != "region":
                self._add(feature["geometry"])
        self.segments = [pair for line in self.outlines for pair in zip(line, line[1:])]

    def _add(self, geometry):
        kind, places = geometry["type"], geometry["coordinates"]
        if kind == "LineString":
            self.outlines.append([tuple(p) for p in places])
        elif kind in ("Polygon", "MultiLineString"):
            self.outlines += [[tuple(p) for p in ring] for ring in places]
        elif kind == "MultiPolygon":
            self.outlines += [[tuple(p) for p in ring] for polygon in places for ring in polygon]

    def within(self, low, high):
        """The segments that reach into a rectangle."""
        return [(a, b) for a, b in self.segments
                if max(a[0], b[0]) >= low[0] and min(a[0], b[0]) <= high[0]
                and max(a[1], b[1]) >= low[1] and min(a[1], b[1]) <= high[1]]

    def draw(self, plot, fill="#d7c3ae"):
        for line in self.outlines:
            closed = len(line) > 3 and line[0] == line[-1]
            plot.line(line, "#7a6654", 1, fill=fill if closed else "none")


def distance(place, segments):
    """Distance from a point to the nearest of the segments."""
    x, y = place
    least = math.inf
    for (ax, ay), (bx, by) in segments:
        dx, dy = bx - ax, by - ay
        square = dx * dx + dy * dy
        share = 0 if square == 0 else max(0, min(1, ((x - ax) * dx + (y - ay) * dy) / square))
        least = min(least, (x - ax - share * dx) ** 2 + (y - ay - share * dy) ** 2)
    return math.sqrt(least)


def percentile(values, share):
    """The value that this share of them does not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, math.ceil(share * len(ordered)) - 1)]
