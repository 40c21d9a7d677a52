# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "arrange": {
        "--ways": "--objective track --ways wander:2,1min --sensor laser:1",
        "--coast": "--objective track --coast 2s --ways wander:2,1min --sensor laser:1",
        "--crossing": "--objective track --crossing 1s --ways wander:2,1min --sensor laser:1",
    },
}
