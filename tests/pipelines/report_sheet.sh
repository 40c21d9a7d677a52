#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The installer's sheet: two cameras are dimensioned again from its table and the walls alone, within the printed
# rounding.
. "$(dirname "$0")/common.sh"

cat >room.env <<'END'
#env 1
fence id=outer path=-4,-3;4,-3;4,2;2,3;-4,3 closed=yes height=3
wall id=inner from=0,-3 to=0,0
END
cat >layout.3dm <<'END'
#3dm 1
camera id=c1 at=-3.217,2.638,2.417 heading=-41.26 tilt=-23.71
camera id=c2 at=2.873,2.104,2.55 heading=-122.3 tilt=-35.04 roll=90
END
coverage room.env layout.3dm --report sheet.html -q >out

cat >hang.py <<'END'
import math, re, sys
from html.parser import HTMLParser

class Tables(HTMLParser):
    """Collects the rows of all tables."""
    def __init__(self):
        super().__init__()
        self.rows, self.cell = [], None
    def handle_starttag(self, tag, attributes):
        if tag == "tr": self.rows.append([])
        if tag in ("td", "th"): self.cell = ""
    def handle_data(self, data):
        if self.cell is not None: self.cell += data
    def handle_endtag(self, tag):
        if tag in ("td", "th") and self.cell is not None:
            self.rows[-1].append(self.cell.strip())
            self.cell = None

WALLS = {"outer": [(-4, -3), (4, -3), (4, 2), (2, 3), (-4, 3), (-4, -3)], "inner": [(0, -3), (0, 0)]}
AXES = {"+x": 0, "+y": 90, "-x": 180, "-y": -90}
ROUNDING = 0.005 + 1e-9

def along(text):
    """Likewise of a sensor so far from a corner, parallel to a side of a wall."""
    distance, wall, x, y, side = re.fullmatch(
        r"([\d.]+) along (\w+)(?: face \d+)? from \((-?[\d.]+), (-?[\d.]+)\), (.*)", text).groups()
    angle = math.radians(AXES[side] if side in AXES else float(side.removesuffix(" deg")))
    ways = []
    for (ax, ay), (bx, by) in zip(WALLS[wall], WALLS[wall][1:]):
        for sign in (-1, 1):
            heading = math.atan2(sign * (by - ay), sign * (bx - ax))
            ways.append((abs(math.remainder(heading - angle, math.tau)), heading))
    off, heading = min(ways)
    assert off < math.radians(0.1), f"no side of {wall} runs {side}"
    nx, ny = math.cos(heading), math.sin(heading)
    return nx, ny, nx * float(x) + ny * float(y) + float(distance)

def constraint(text):
    """The line n p = c on which a sensor lies that is so far from a side of a wall."""
    if " along " in text: return along(text)
    distance, wall, side = re.fullmatch(r"([\d.]+) to (\w+)(?: face \d+)?, (.*)", text).groups()
    angle = math.radians(AXES[side] if side in AXES else float(side.removesuffix(" deg")))
    corners, best = WALLS[wall], None
    for (ax, ay), (bx, by) in zip(corners, corners[1:]):
        length = math.hypot(bx - ax, by - ay)
        # The room lies to the left of its outline; the inner wall has two faces.
        for sign in (-1, 1) if wall == "inner" else (-1,):
            nx, ny = sign * -(by - ay) / length, sign * (bx - ax) / length
            off = abs(math.remainder(math.atan2(ny, nx) - angle, math.tau))
            if best is None or off < best[0]: best = (off, nx, ny, nx * ax + ny * ay)
    off, nx, ny, c = best
    assert off < math.radians(0.1), f"no side of {wall} lies {side}"
    return nx, ny, c - float(distance)

tables = Tables()
tables.feed(open("sheet.html", encoding="utf-8").read())
head = next(row for row in tables.rows if "nearest wall" in row)
placed = {"c1": (-3.217, 2.638, 2.417, -41.26, -23.71, 0), "c2": (2.873, 2.104, 2.55, -122.3, -35.04, 90)}
for name, (x, y, z, heading, tilt, roll) in placed.items():
    row = dict(zip(head, next(row for row in tables.rows if row[:1] == [name] and len(row) == len(head))))
    (a, b, c), (d, e, f) = constraint(row["nearest wall"]), constraint(row["next wall"])
    det = a * e - b * d
    hung = ((c * e - b * f) / det, (a * f - c * d) / det)
    # Two distances, each rounded, along directions that are not at right angles.
    error = ROUNDING * math.sqrt(2) / abs(det)
    assert math.hypot(hung[0] - x, hung[1] - y) <= error, f"{name} hangs at {hung}: {row}"
    assert abs(float(row["x"]) - x) <= ROUNDING and abs(float(row["y"]) - y) <= ROUNDING, row
    assert abs(float(row["height"]) - z) <= ROUNDING, row
    assert abs(float(row["heading"]) - heading) <= 0.05 + 1e-9, row
    directions = re.fullmatch(r"(-?[\d.]+)(?:, roll (-?[\d.]+))?", row["tilt"]).groups()
    assert abs(float(directions[0]) - tilt) <= 0.05 + 1e-9, row
    assert float(directions[1] or 0) == roll, row
    print(name, "hangs", f"{1000 * math.hypot(hung[0] - x, hung[1] - y):.1f} mm off, at most {1000 * error:.1f}")
END
python3 hang.py >hung 2>&1 || fail "$(cat hung)"
cat hung
