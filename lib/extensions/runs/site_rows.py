# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import RECORD

BEFORE = {("coverage", "--run"): RECORD}
OPTIONS = {"coverage": {"--run": "--run rec"}}
