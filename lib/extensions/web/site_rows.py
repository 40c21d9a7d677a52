# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""

OPTIONS = {
    "simrun": {
        "--web": "--web 127.0.0.1:0",
        "--web-edit": "--web 127.0.0.1:0 --web-edit",
    },
}
