# SPDX-License-Identifier: GPL-3.0-or-later
"""Offices from a random seed: at most a partition with gaps, closed desks and tables, cupboards, pillars, chairs.

    python3 rooms.py FOLDER FIRST COUNT    writes FOLDER/office_FIRST.env and the following ones
"""

import math
import os
import random
import sys


def office(seed):
    """The text of an .env file."""
    draw = random.Random(seed)
    width, depth = (round(50 * draw.uniform(*limits)) / 50 for limits in ((10, 15), (8, 12)))
    lines = ["#env 1", f"ispace size={width:.2f},{depth:.2f}"]
    x, y = width / 2, depth / 2
    taken = []  # circles: x, y, radius

    def wall(a, b):
        lines.append(f"wall from={a[0]:.2f},{a[1]:.2f} to={b[0]:.2f},{b[1]:.2f} thickness=0.1")
        steps = max(1, round(math.dist(a, b) / 0.4))
        taken.extend((a[0] + (b[0] - a[0]) * k / steps, a[1] + (b[1] - a[1]) * k / steps, 0.3) for k in range(steps + 1))

    for across in draw.sample([True, False], draw.choice([0, 1, 1])):
        most, other = (y, x) if across else (x, y)
        at = draw.uniform(-0.35, 0.35) * 2 * other
        gaps = sorted(draw.uniform(-most + 0.4, most - 1.9) for _ in range(draw.choice([1, 2])))
        begin = -most
        for gap in gaps:
            if gap - begin > 0.5:
                wall(*(((at, begin), (at, gap)) if across else ((begin, at), (gap, at))))
            begin = max(begin, gap + 1.4)
            middle = (at, gap + 0.7) if across else (gap + 0.7, at)
            taken.append((*middle, 1.0))
        if most - begin > 0.5:
            wall(*(((at, begin), (at, most)) if across else ((begin, at), (most, at))))

    kinds = {
        "desk kind=closed": 0.9,
        "cube size=1.2,0.8,0.75": 0.8,
        "cube size=1.2,0.4,1.6": 0.7,
        "cylinder size=0.5": 0.3,
        "pillar size=0.4,0.4": 0.35,
        "chair": 0.4,
    }
    for _ in range(draw.randint(6, 14)):
        kind, radius = draw.choice(list(kinds.items()))
        for _ in range(50):
            place = draw.uniform(-x + radius, x - radius), draw.uniform(-y + radius, y - radius)
            if draw.random() < 0.5:  # along a wall
                place = (place[0], math.copysign(y - radius, place[1]))
            # Either side by side or far enough apart for a robot and a person.
            if all(math.dist(place, other[:2]) > radius + other[2] + 0.7 for other in taken):
                taken.append((*place, radius))
                word, *keys = kind.split(" ", 1)
                lines.append(f"{word} at={place[0]:.2f},{place[1]:.2f} heading={draw.randrange(0, 360, 15)} {''.join(keys)}")
                break
    return "\n".join(lines) + "\n"


def write(folder, first, count):
    """Writes so many offices, and returns their files."""
    os.makedirs(folder, exist_ok=True)
    files = [os.path.join(folder, f"office_{first + i}.env") for i in range(count)]
    for i, file in enumerate(files):
        with open(file, "w", encoding="utf-8") as out:
            out.write(office(first + i))
    return files


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: rooms.py FOLDER FIRST COUNT: writes COUNT offices from the seed FIRST on")
    print("\n".join(write(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))))
