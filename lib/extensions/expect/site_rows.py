# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "simrun": {
        "--expect": "--expect 'no collision' --script drive.txt",
        "--expect-report": "--expect 'no collision' --expect-report verdict.json",
    },
}
