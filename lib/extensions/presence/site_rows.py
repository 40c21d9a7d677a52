# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

BEFORE = {
    ("arrange", "--presence"): "simrun room.env lay.3dm --clock fast --until 4 --listen 127.0.0.1:0 --no-record-readings --record rec",
}
OPTIONS = {
    "arrange": {
        "--presence": "--presence rec --sensor pir:1",
    },
    "coverage": {
        "--presence": "!room.env fixed.3dm --presence wander:2,1min",
    },
}
