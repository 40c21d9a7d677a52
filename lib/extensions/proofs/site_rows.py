# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

BEFORE = {
    ("arrange", "--verify"): "arrange room.env --sensor laser:1 --proof poses --time-limit 2 --certificate proof"
    " -o out.3dm",
}
OPTIONS = {
    "arrange": {
        "--certificate": "!room.env --cell 0.4 --sensor laser:1 --proof poses --time-limit 1min --certificate proof",
        "--verify": "!room.env out.3dm --verify proof",
    },
}
