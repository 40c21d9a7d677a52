# SPDX-License-Identifier: GPL-3.0-or-later
"""Heads that pan and tilt cameras and lasers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Set

from ._connection import Address, Client
from ._message import Message, split, text_of
from .errors import Timeout


@dataclass(frozen=True)
class HeadReading:
    """The angles of a head."""

    head: str
    time: float  #: seconds
    pan: float  #: degrees, to the left
    tilt: float  #: degrees, upwards
    moving: bool


class Heads(Client):
    """Heads of robots and rooms (role HEAD).

    >>> with server.heads() as heads:
    ...     heads.turn("neck", 45, -10)
    ...     heads.wait("neck")
    """

    def __init__(self, address: Address, heads: str = "*", timeout: float = 10, token: str = "") -> None:
        """heads: those that it turns, a pattern of ids"""
        super().__init__(f"HEAD {heads}", address, timeout, token)
        self.heads = split(self.info["heads"], ",") if self.info.get("heads") else []  #: ids
        self._turned: Set[str] = set()  # heads whose last turn has ended, before wait()

    def __enter__(self) -> Heads:
        return self

    def turn(self, id: str, pan: float, tilt: float = 0.0) -> float:
        """Turns a head to these angles in degrees, at its speed; the seconds that it takes."""
        answer = self._ask(f"TURN {id} {text_of(pan)} {text_of(tilt)}")
        for event in self.connection.stored_events():  # before the answer: of earlier turns
            self._note(event)
        self._turned.discard(id)
        return answer.fields.number("for")

    def halt(self, id: str) -> None:
        """Stops a head where it is."""
        self._ask(f"HALT {id}")

    def read(self, id: str) -> HeadReading:
        """The angles of a head now."""
        fields = self._ask(f"READ {id}").fields
        return HeadReading(fields["id"], fields.number("t"), fields.number("pan"), fields.number("tilt"), fields.flag("moving"))

    def wait(self, id: str, timeout: float = 60) -> None:
        """Waits until the last turn of a head has ended; Timeout after this many seconds of wall time."""
        while id not in self._turned:
            if (event := self.connection.next_event(timeout)) is None:
                raise Timeout(f"{id} does not arrive within {timeout:g} s")
            self._note(event)
        self._turned.discard(id)

    def _note(self, event: Message) -> None:
        if event.word(1) == "turned":
            self._turned.add(event.fields["id"])
