# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import LASERS

OPTIONS = {
    "arrange": {
        "--robust": f"--robust failures:1 {LASERS}",
        "--crowd": f"--crowd 3 {LASERS}",
        "--case": f"--robust rooms:other.env --case mean {LASERS}",
    },
    "coverage": {
        "--perturb": "--perturb 5cm,3",
        "--failures": "--failures 1",
        "--crowd": "--crowd 2",
    },
}
