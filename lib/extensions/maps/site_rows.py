# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import PLAN

OPTIONS = {
    "envc": {
        "--points": PLAN,
    },
}
