# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "coverage": {
        "--suggest": "--suggest 1",
        "--time-limit": "--suggest 1 --time-limit 10min",
    },
    "simrun": {
        "--suggest": "--record out --suggest 1",
    },
}
