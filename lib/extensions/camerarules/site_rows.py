# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import SENSOR

OPTIONS = {
    "arrange": {
        "--facing": f"--facing door:*,1m {SENSOR}",
        "--privacy": f"--privacy '*/desk_zone' {SENSOR}",
    },
    "coverage": {
        "--facing": "--facing '*/door:*,1m'",
        "--privacy": "--privacy far,inspect",
    },
}
