# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of tests/site/options.py for the options of this extension."""
from words import LOG

BEFORE = {
    ("scan", "--against"): LOG,
    ("scan", "--align"): LOG,
    ("scan", "--require"): LOG,
    ("scan", "--fit"): LOG,
    ("scan", "--json"): LOG,
    ("scan", "--report"): LOG,
}
OPTIONS = {
    "scan": {
        "--against": "--against log.jsonl",
        "--align": "--against log.jsonl --align",
        "--json": "--against log.jsonl --json",
        "--require": "--against log.jsonl --require inliers=10%",
        "--report": "--against log.jsonl --report page.html",
        "--fit": "--against log.jsonl --fit noise.3dm",
    },
}
