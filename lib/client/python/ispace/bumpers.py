# SPDX-License-Identifier: GPL-3.0-or-later
"""Bumpers of robots that measure forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from ._connection import Address, Client
from ._message import split


@dataclass(frozen=True)
class Impact:
    """A robot has run into something, or another mover into it."""

    bumper: str
    robot: str
    into: str  #: the thing, robot or person
    time: float  #: seconds
    force: float  #: N
    speed: float  #: across the surfaces that meet, m/s


class Bumpers(Client):
    """Bumpers of robots (role BUMPER).

    >>> with server.bumpers() as bumpers:
    ...     while impact := bumpers.next_impact(timeout=60):
    ...         print(impact.robot, impact.into, impact.force)
    """

    def __init__(self, address: Address, bumpers: str = "*", timeout: float = 10, token: str = "") -> None:
        """bumpers: those that it hears of, a pattern of ids"""
        super().__init__(f"BUMPER {bumpers}", address, timeout, token)
        self.bumpers = split(self.info["bumpers"], ",") if self.info.get("bumpers") else []  #: ids

    def __enter__(self) -> Bumpers:
        return self

    def force(self, id: str) -> float:
        """The force of the contact of a bumper now, N; 0 without one."""
        return self._ask(f"READ {id}").fields.number("force")

    def next_impact(self, timeout: float = 0) -> Optional[Impact]:
        """The next impact; None after this many seconds of wall time."""
        while (message := self.connection.next_event(timeout)) is not None:
            if message.word(1) == "impact":
                fields = message.fields
                return Impact(
                    fields["id"],
                    fields["robot"],
                    fields["into"],
                    fields.number("t"),
                    fields.number("force"),
                    fields.number("speed"),
                )
        return None
