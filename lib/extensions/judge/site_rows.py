# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import RECORD

FILES = {
    "tracks.csv": "t,track,x,y\n0,1,-2,1.5\n0.5,1,-1.6,1.5\n1,1,-1.2,1.5\n",
}
BEFORE = {
    ("coverage", "--tracks"): RECORD,
    ("coverage", "--frame-rate"): RECORD,
    ("coverage", "--truths"): RECORD,
    ("coverage", "--films"): RECORD,
}
OPTIONS = {
    "coverage": {
        "--tracks": "!room.env lay.3dm --run rec --tracks tracks.csv",
        "--frame-rate": "!room.env lay.3dm --run rec --tracks tracks.csv --frame-rate 5",
        "--truths": "!room.env lay.3dm --run rec --tracks tracks.csv --truths people",
        "--films": "!room.env lay.3dm --run rec --tracks tracks.csv --films films",
    },
}
