# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "coverage": {
        "--path": "--path desk_zone,far",
        "--localise": "--localise 1",
    },
}
