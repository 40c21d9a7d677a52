# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import LOG, OTHER_INPUT

BEFORE = {
    ("envc", "--calibrate"): LOG,
}
OPTIONS = {
    "envc": {
        "--calibrate": "lay.3dm --calibrate log.jsonl -o out.3dm",
        "--by-people": OTHER_INPUT,
        "--by-robots": OTHER_INPUT,
    },
}
