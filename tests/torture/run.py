#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""run.py --build DIR [--minutes N] [--seed N] [--patience X] [--only PART]...: attacks the tools, for so many minutes in all.

Each part ends with a line of its counts. The status is 1 if an invariant did not hold; the line that says so has a
command that repeats it, or the seed does. Without --seed each run tries something else."""
import argparse
import importlib
import random
import sys
import time

import lab as labs

# The share of the minutes that each part has, in the order in which they run.
PARTS = {"same_bytes": 0.05, "names": 0.1, "kills": 0.07, "disk": 0.04, "faults": 0.15, "server": 0.2,
         "soak": 0.12, "fuzz": 0.17, "amplify": 0.1}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", default="build")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=None)
    parser.add_argument("--patience", type=float, default=1, help="how many times as long all may take, on a slow machine")
    parser.add_argument("--only", action="append", choices=PARTS)
    options = parser.parse_args()
    seed = random.SystemRandom().randrange(1 << 31) if options.seed is None else options.seed
    labs.slowness = options.patience
    chosen = {name: share for name, share in PARTS.items() if not options.only or name in options.only}
    print(f"torture: {options.minutes:g} minutes, seed {seed}", flush=True)
    violated = []
    for name, share in chosen.items():
        begin = time.monotonic()
        lab = labs.Lab(options.build, name, seed, options.minutes, share / sum(chosen.values()))
        importlib.import_module("part_" + name).run(lab)
        counts = ", ".join(f"{count} {what}" for what, count in lab.counts.items())
        lab.say(f"{counts or 'none'}; {lab.violations} violations; {time.monotonic() - begin:.0f} s")
        if lab.violations:
            violated.append(name)
    for name in violated:
        print(f"torture: repeat by: tests/torture/run.py --build {options.build} --minutes {options.minutes:g} "
              f"--seed {seed} --only {name}")
    print(f"torture: {'violated: ' + ', '.join(violated) if violated else 'all invariants hold'}")
    return 1 if violated else 0


if __name__ == "__main__":
    sys.exit(main())
