# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import RECORD

BEFORE = {
    ("coverage", "--goal"): RECORD,
    ("coverage", "--robot"): RECORD,
    ("coverage", "--reach"): RECORD,
    ("coverage", "--way"): RECORD,
}
OPTIONS = {
    "coverage": {
        "--goal": "!room.env lay.3dm --run rec --goal 2,0",
        "--robot": "!room.env lay.3dm --run rec --goal 2,0 --robot r1",
        "--reach": "!room.env lay.3dm --run rec --goal 2,0 --reach 0.5",
        "--way": "!room.env lay.3dm --run rec --goal 2,0 --way 3",
    },
}
