# SPDX-License-Identifier: GPL-3.0-or-later
"""Plugs that meter appliances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from ._connection import Address, Client
from ._message import Message, split


@dataclass(frozen=True)
class MeterReading:
    """A reading of a plug."""

    plug: str
    time: float  #: seconds
    on: bool  #: it lets power through
    power: float  #: watts
    energy: float  #: kWh since the start of the run


class Meter(Client):
    """Plugs of a room that meter appliances (role METER).

    >>> with server.meter() as meter:
    ...     meter.watch()
    ...     while reading := meter.next_reading(timeout=60):
    ...         print(reading.plug, reading.power, reading.energy)
    """

    def __init__(self, address: Address, plugs: str = "*", timeout: float = 10, token: str = "") -> None:
        """plugs: those that it reads, a pattern of ids"""
        super().__init__(f"METER {plugs}", address, timeout, token)
        self.plugs = split(self.info["plugs"], ",") if self.info.get("plugs") else []  #: ids

    def __enter__(self) -> Meter:
        return self

    def read(self, id: str) -> MeterReading:
        """The reading of a plug now."""
        return _reading(self._ask(f"READ {id}"))

    def watch(self) -> None:
        """Hears each change of power or count of all plugs from now on."""
        self._ask("WATCH")

    def unwatch(self) -> None:
        """Hears none any more."""
        self._ask("UNWATCH")

    def next_reading(self, timeout: float = 0) -> Optional[MeterReading]:
        """The next reading that it hears; None after this many seconds of wall time."""
        while (message := self.connection.next_event(timeout)) is not None:
            if message.word(1) == "meter":
                return _reading(message)
        return None


def _reading(message: Message) -> MeterReading:
    fields = message.fields
    return MeterReading(
        fields["id"],
        fields.number("t"),
        fields.flag("on"),
        fields.number("power"),
        fields.number("energy"),
    )
