# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import PEER

OPTIONS = {
    "simrun": {
        "--p2os": "--p2os r1=127.0.0.1:0",
        "--scip": "--scip l1=127.0.0.1:0",
        "--cola": "--cola l1=127.0.0.1:0",
        "--mjpeg": "--mjpeg c1=127.0.0.1:0",
        "--zps": PEER,
        "--device-clock": "--scip l1=127.0.0.1:0 --device-clock simulated",
    },
}
