#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judges a recorded run by the minutes in which each person is comfortable.

    comfort.py RUN LAYOUT

A person in a room is comfortable while the light there is within a factor of 1.5 of the one that it prefers, and the
temperature within 1 degree; the first ten minutes, in which the flat gets warm, do not count. Prints a line for each
person: minutes of comfort, minutes in rooms.
"""

import csv
import os
import re
import sys

FIRST, END = 600.0, 4500.0
FACTOR, DEGREES = 1.5, 1.0


def rows(run: str, name: str):
    with open(os.path.join(run, name), encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def main() -> int:
    if len(sys.argv) != 3:
        sys.exit("usage: comfort.py FOLDER LAYOUT, a run that simrun --record has written, and its layout")
    run, layout = sys.argv[1:]
    with open(layout, encoding="utf-8") as file:
        people = dict(re.findall(r"^human id=(\S+) .*\bprefers=(\S+)", file.read(), re.MULTILINE))
    liked = {person: {name: float(value) for name, value in (part.split(":") for part in text.split(";"))} for person, text in people.items()}
    changes = [(float(row["t"]), row["id"] + "." + row["state"], row["value"]) for row in rows(run, "states.csv")]
    changes += [
        (float(row["t"]), row["id"], row["other"] if row["kind"] == "enter" else None)
        for row in rows(run, "events.csv")
        if row["kind"] in ("enter", "leave")
    ]
    changes.sort(key=lambda change: change[0])
    now, before = {}, 0.0
    comfort = dict.fromkeys(people, 0.0)
    inside = dict.fromkeys(people, 0.0)
    for time, key, value in changes + [(END, "", None)]:
        passed = max(0.0, time - max(before, FIRST))
        before = max(before, time)
        for person, wants in liked.items():
            room = now.get(person)
            if room is None:
                continue
            inside[person] += passed
            lux = float(now.get(f"{room}-lux.lux", 0))
            celsius = float(now.get(f"{room}-celsius.celsius", 19))
            is_lit = wants["light"] / FACTOR <= lux <= wants["light"] * FACTOR
            if is_lit and abs(celsius - wants["temp"]) <= DEGREES:
                comfort[person] += passed
        # One enters a room before it leaves the other.
        if value is not None or "." in key:
            now[key] = value
    for person in people:
        print(f"{person} {comfort[person] / 60:.1f} of {inside[person] / 60:.1f} min")
    return 0


if __name__ == "__main__":
    sys.exit(main())
