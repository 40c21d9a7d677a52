# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import PEER

OPTIONS = {
    "simrun": {
        "--foxglove": "--foxglove 127.0.0.1:0",
        "--rosbridge": "--rosbridge 127.0.0.1:0",
        "--ros2": PEER,
        "--ros-robot": PEER,
        "--rmf": PEER,
        "--mcap": "--mcap out.mcap",
    },
}
