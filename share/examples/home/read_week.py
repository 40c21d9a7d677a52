#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a recorded week of a home, and judges the simplest recogniser of activities.

    simrun flat.env flat.3dm --script week.txt --clock fast --dt 1 --until 168h --record week
    read_week.py week

The recogniser guesses an activity from its hour and the motion sensor with the most detections. It learns on the first
half of the time.
"""
import csv
import sys
from collections import Counter, defaultdict

if len(sys.argv) != 2:
    sys.exit("usage: read_week.py FOLDER, a run that simrun --record has written")
folder = sys.argv[1]
with open(f"{folder}/states.csv", newline="") as file:
    motions = [(float(row["t"]), row["id"]) for row in csv.DictReader(file)
               if row["state"] == "motion" and row["value"] == "1"]
with open(f"{folder}/activities.csv", newline="") as file:
    labels = [(float(row["begin"]), float(row["end"]), row["id"], row["activity"]) for row in csv.DictReader(file)]
labels.sort()

spent = Counter()
for begin, end, who, activity in labels:
    spent[activity] += end - begin
for activity, seconds in sorted(spent.items()):
    print(f"{activity}: {seconds / 3600:.1f} h")

seen, half = [], labels[-1][0] / 2
for begin, end, _, activity in labels:
    during = Counter(sensor for t, sensor in motions if begin <= t <= end + 5)
    if during:
        sign = during.most_common(1)[0][0], begin // 3600 % 24
        seen.append((begin, sign, activity))
known = defaultdict(Counter)
for begin, sign, activity in seen:
    if begin <= half:
        known[sign][activity] += 1
judged = [known[sign].most_common(1)[0][0] == activity for begin, sign, activity in seen
          if begin > half and known[sign]]
if not judged:
    sys.exit("read_week.py: no action of the second half had its like in the first: record some days")
print(f"{len(motions)} detections, {len(labels)} labels; {100 * sum(judged) / len(judged):.0f} % of "
      f"{len(judged)} actions recognised")
