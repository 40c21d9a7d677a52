# SPDX-License-Identifier: GPL-3.0-or-later
"""Exceptions of this module."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Base of all the others."""


class ConnectionFailed(Error, ConnectionError):
    """No server there, or it has closed the connection."""


class Timeout(Error, TimeoutError):
    """The answer has not come in time.

    The connection can still be used: the answer is dropped when it comes.
    """


class ProtocolError(Error):
    """The server said something that is not in the protocol as this module knows it."""


class Refused(Error):
    """The server answered ``ERR code text``; the text is the exception's.

    400 syntax, 401 token, 403 not allowed, 404 unknown name, 405 not in this role, 408 no role in time, 413 too long,
    416 out of range, 429 too many.

    409 not possible now: another client holds the robot or person; goto() has no way there, or the mover is in a lift
    or on stairs; a change of the world would put things into each other, or exceed a limit.
    """

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


class ToolError(Error):
    """A tool of ispace has failed; the text is its message."""

    def __init__(self, text: str, status: int) -> None:
        super().__init__(text)
        self.status = status  #: exit status: 1 bad data, 2 usage, 3 requirement not met


class RequirementMissed(ToolError):
    """Exit status 3: a stated requirement is not met. The product is there all the same."""

    def __init__(self, text: str, product: Any) -> None:
        super().__init__(text, 3)
        self.product = product  #: what the function would have returned
