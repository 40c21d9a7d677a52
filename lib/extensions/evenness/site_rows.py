# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "arrange": {
        "--depth": "--objective even --depth 2 --sensor laser:2",
        "--further": "--objective even --further 25% --sensor laser:2",
    },
}
