# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import RECORD

BEFORE = {("simrun", option): RECORD for option in ("--to", "--width", "--fps", "--speed")}
OPTIONS = {
    "simrun": {
        "--to": "!room.env lay.3dm --replay rec --to svg -o out",
        "--width": "!room.env lay.3dm --replay rec --width 300 -o out.png",
        "--fps": "!room.env lay.3dm --replay rec --fps 2 -o out.gif --width 200",
        "--speed": "!room.env lay.3dm --replay rec --speed 2 -o out.gif --width 200",
    },
}
