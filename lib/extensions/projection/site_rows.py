# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

FILES = {
    "projector.3dm": "#3dm 1\nprojector id=beam model=v-1100 at=0.2,1.9 height=1.2 heading=-90\n",
}
OPTIONS = {
    "coverage": {
        "--projection": "!room.env projector.3dm --projection 100",
    },
}
