# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "coverage": {
        "--perturb": "--perturb 5cm,3",
        "--failures": "--failures 1",
        "--crowd": "--crowd 2",
    },
}
