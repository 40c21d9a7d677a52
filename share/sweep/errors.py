# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors, in the form of the other tools."""

from __future__ import annotations

from typing import Iterable

MOST_FINDINGS = 20


class UsageError(Exception):
    """A wrong option or operand: exit status 2."""


class DataError(Exception):
    """Findings in a file, or jobs without output: exit status 1. Each is a whole message with its position."""

    def __init__(self, findings: Iterable[str]) -> None:
        self.findings = list(findings)
        super().__init__("\n".join(self.findings))


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Returns ", did you mean `count`?", or "" without a similar name: to be appended to a message."""
    import difflib  # only where something is wrong already

    near = difflib.get_close_matches(word, list(known), 1)
    return f", did you mean `{near[0]}`?" if near else ""
