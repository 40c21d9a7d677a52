#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""quick.py BUILD: every experiment with few seeds keeps its bounds, twice with the same bytes; the report shows
failures as failed, and run.py reports wrong arguments."""

import os
import shutil
import subprocess
import sys

from running import check, skip

try:
    import matplotlib  # noqa: F401
except ImportError:
    skip("no matplotlib here (Debian: python3-matplotlib)")

BUILD = sys.argv[1]
SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DRIVER = os.path.join(SOURCE, "share", "experiments", "run.py")
SCRATCH = os.path.join(BUILD, "tests", "scratch", "experiments")


def run(folder, *options, build=BUILD):
    return subprocess.run([sys.executable, "-B", DRIVER, "--build", build, "--quick", *options, "-o",
                           os.path.join(SCRATCH, folder)], capture_output=True, text=True, check=False)


def report(folder):
    with open(os.path.join(SCRATCH, folder, "index.html"), encoding="utf-8") as file:
        return file.read()


def twice():
    for folder in ("first", "second"):
        done = run(folder)
        check(done.returncode == 0, f"status {done.returncode}: {done.stderr}")
        index = os.path.join(SCRATCH, folder, "index.html")
        check(done.stdout == f"the report: {index}\n", f"it ends with {done.stdout}")
        check(os.path.getsize(os.path.join(SCRATCH, folder, "timings.csv")) > 100, "no timings")
    check(report("first") == report("second"), "the report differs from run to run")
    listed = run("none", "--list").stdout.splitlines()
    check(len(listed) >= 10 and report("first").count("<section ") == len(listed),
          f"the report does not have the {len(listed)} experiments there are")


def verdicts():
    """The page begins with the reproduced, fitted and not reproduced figures."""
    page = report("first")
    lists = [part.split("<h3", 1)[0] for part in page.split("<h3>")[1:4]]
    check([text.split(":")[0] for text in lists] == ["Reproduced", "Fitted", "Not reproduced"],
          f"other lists: {[text[:40] for text in lists]}")
    for text, figure in zip(lists, ("thesis 520 s, here 518 s".replace(" s", "\u00a0s"), "3 m: sensor 1, x: thesis",
                                    "thesis 230 s, here 339 s".replace(" s", "\u00a0s"))):
        check(figure in text, f"{figure} is not in the list: {text}")
    for missed in ("16 m: Hierarchical Random", "32 m: Hierarchical Random", "80\u00a0%, here 58\u00a0%"):
        check(missed in lists[2], f"{missed} is not in the list: {lists[2]}")
    sys.path.insert(0, os.path.dirname(DRIVER))
    from lab import Lab  # pylint: disable=import-outside-toplevel
    lab = Lab("self", "", "", BUILD, os.path.join(SCRATCH, "self"))
    lab.row("far off", 230, 339, note="for a reason")
    check(lab.failures, "a figure that differs without bound and verdict passes as reproduced")


def what_goes_wrong():
    """A build with a failing coverage tool: the page shows the other experiments, and that one as failed."""
    build = os.path.join(SCRATCH, "broken")
    os.makedirs(os.path.join(build, "bin"))
    for tool in ("envc", "arrange", "scan", "simrun"):
        os.symlink(os.path.join(BUILD, "bin", tool), os.path.join(build, "bin", tool))
    done = run("none", "--only", "judge", build=build)
    check(done.returncode == 1 and "no program" in done.stderr and "make experiments" in done.stderr,
          f"without a tool: {done.returncode} {done.stderr}")
    coverage = os.path.join(build, "bin", "coverage")
    with open(coverage, "w", encoding="utf-8") as file:
        file.write("#!/bin/sh\necho 'coverage: out of order' >&2\nexit 1\n")
    os.chmod(coverage, 0o755)
    done = run("failed", "--only", "judge", build=build)
    check(done.returncode == 1 and "1 of 1 failed" in done.stderr, f"it did not fail: {done.stderr}")
    check("Failed." in report("failed") and "out of order" in report("failed"), "failure not shown")
    bare = subprocess.run([sys.executable, "-S", "-B", DRIVER, "--list"], capture_output=True,
                          text=True, check=False)
    check(bare.returncode == 1 and "python3-matplotlib" in bare.stderr and len(bare.stderr) < 200,
          f"without matplotlib: {bare.stderr}")
    done = run("none", "--only", "nothing")
    check(done.returncode == 2 and "no experiment nothing" in done.stderr, f"unknown: {done.stderr}")


shutil.rmtree(SCRATCH, ignore_errors=True)
os.makedirs(SCRATCH)
twice()
verdicts()
what_goes_wrong()
