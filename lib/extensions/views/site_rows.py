# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "scan": {
        "--view": "--view orbit --size 300 -o out.png",
        "--show": "--view bird --show area --size 300 -o out.png",
        "--highlight": "--view bird --highlight desk --size 300 -o out.png",
        "--labels": "--view bird --labels --size 300 -o out.png",
        "--no-labels": "--view bird --no-labels --size 300 -o out.png",
    },
}
