# SPDX-License-Identifier: GPL-3.0-or-later
"""The labels of random flats are true: flats_test.py FIRST COUNT runs and judges the flats of so many seeds, side by side.

With --keep DIR their files and records stay there, for those that fail: `simrun flat.env flat.3dm --script day.txt`."""

import collections
import concurrent.futures
import os
import sys
import tempfile
import time

from flat import Flat
from run import run
from truth import check

# How many labels of a kind a set of flats must have, for each flat in the mean: a judge without labels finds no false one.
LEAST = {
    "posture": 4, "on a thing": 0.5, "arm": 0.1, "door": 2, "lock": 1, "carried": 20, "set down": 0.2, "uwb": 20, "seat": 4,
    "empty seat": 100, "cells": 20, "floor exactly": 4, "power": 200, "meter": 4, "hand": 200, "touched": 5, "untouched": 500,
    "head": 0.5, "radio": 0.5, "bumper": 0.2, "script": 1, "end": 20,
}  # fmt: skip


def judge(seed, folder):
    flat = Flat(seed)
    os.makedirs(folder)
    heard = run(flat, folder)
    return seed, *check(flat, os.path.join(folder, "run"), heard)


def main():
    first, count = int(sys.argv[1]), int(sys.argv[2])
    begin, failed = time.monotonic(), 0
    looked = collections.Counter()
    with tempfile.TemporaryDirectory() as scratch:
        kept = sys.argv[4] if sys.argv[3:4] == ["--keep"] else scratch
        with concurrent.futures.ProcessPoolExecutor(min(8, os.cpu_count() or 1)) as pool:
            jobs = [pool.submit(judge, seed, os.path.join(kept, str(seed))) for seed in range(first, first + count)]
            for job in jobs:
                seed, false, seen = job.result()
                looked += seen
                failed += bool(false)
                for text in false[:5]:
                    print(f"flat {seed}: {text}")
                if len(false) > 5:
                    print(f"flat {seed}: … {len(false)} labels are false")
    few = [f"{kind}: {looked[kind]}" for kind, least in LEAST.items() if count >= 8 and looked[kind] < least * count]
    if few:
        print("too few labels:", ", ".join(few))
    print(f"{count} flats, {sum(looked.values())} labels looked at, {failed} flats with false ones, {time.monotonic() - begin:.1f} s")
    print(", ".join(f"{kind} {number}" for kind, number in looked.most_common()))
    return 1 if failed or few else 0


if __name__ == "__main__":
    sys.exit(main())
