# SPDX-License-Identifier: GPL-3.0-or-later
"""Doors with locks, for card readers and keypads."""

from __future__ import annotations

from dataclasses import dataclass

from ._connection import Address, Client
from ._message import split


@dataclass(frozen=True)
class LockReading:
    """The state of a door with a lock."""

    door: str
    time: float  #: seconds
    open: bool
    locked: bool
    forced: bool  #: its lock is broken


class Locks(Client):
    """Doors of a room that open to tags (role LOCK).

    >>> with server.locks() as locks, server.sensor("reader") as reader:
    ...     for seen in reader.scan().tags:
    ...         locks.show("front", seen)
    """

    def __init__(self, address: Address, doors: str = "*", timeout: float = 10, token: str = "") -> None:
        """doors: those to which it shows tags, a pattern of ids"""
        super().__init__(f"LOCK {doors}", address, timeout, token)
        self.doors = split(self.info["doors"], ",") if self.info.get("doors") else []  #: ids

    def __enter__(self) -> Locks:
        return self

    def show(self, id: str, tag: str) -> bool:
        """Shows a tag to a door: True if it opens, for five seconds."""
        return self._ask(f"TRY {id} {tag}").fields.flag("opens")

    def read(self, id: str) -> LockReading:
        """The state of a door now."""
        fields = self._ask(f"READ {id}").fields
        return LockReading(
            fields["id"],
            fields.number("t"),
            fields.flag("open"),
            fields.flag("locked"),
            fields.flag("forced"),
        )
