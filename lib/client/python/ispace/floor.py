# SPDX-License-Identifier: GPL-3.0-or-later
"""Floors, beds and chairs that feel weights."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Optional

from ._connection import Address, Client
from ._message import Message, split


@dataclass(frozen=True)
class Pressure:
    """A reading of a floor_sensor or a seat_sensor."""

    sensor: str
    time: float  #: seconds
    number: int  #: since the start of the run, from 0
    weight: float  #: kilograms
    occupied: bool
    columns: int  #: of a floor, else 0
    rows: int
    cells: Dict[int, float]  #: newtons of those that feel a force, by index: row * columns + column

    def grid(self) -> List[List[float]]:
        """The forces of all cells, a list for each row."""
        return [[self.cells.get(row * self.columns + column, 0.0) for column in range(self.columns)] for row in range(self.rows)]


class Floor(Client):
    """Floors, beds and chairs of a room that feel weights (role FLOOR).

    >>> with server.floor() as floor:
    ...     floor.watch()
    ...     while reading := floor.next_reading(timeout=60):
    ...         print(reading.sensor, reading.weight, reading.cells)
    """

    def __init__(self, address: Address, sensors: str = "*", timeout: float = 10, token: str = "") -> None:
        """sensors: those that it reads, a pattern of ids"""
        super().__init__(f"FLOOR {sensors}", address, timeout, token)
        self.sensors = split(self.info["sensors"], ",") if self.info.get("sensors") else []  #: ids

    def __enter__(self) -> Floor:
        return self

    def read(self, id: str) -> Pressure:
        """The newest reading of a sensor."""
        return _pressure(self._ask(f"READ {id}"))

    def watch(self, every: int = 1) -> None:
        """Hears each reading of all sensors from now on, or each one whose number is a multiple of `every`."""
        self._ask(f"WATCH every={every}")

    def unwatch(self) -> None:
        """Hears none any more."""
        self._ask("UNWATCH")

    def next_reading(self, timeout: float = 0) -> Optional[Pressure]:
        """The next reading that it hears; None after this many seconds of wall time."""
        while (message := self.connection.next_event(timeout)) is not None:
            if message.word(1) == "floor":
                return _pressure(message)
        return None


def _pressure(message: Message) -> Pressure:
    fields = message.fields
    cells = {}
    for cell in split(fields["cells"], ",") if fields.get("cells") else []:
        index, force = cell.split(":")
        cells[int(index)] = float(force)
    is_grid = "columns" in fields
    return Pressure(
        fields["id"],
        fields.number("t"),
        fields.integer("seq"),
        fields.number("weight"),
        fields.flag("occupied"),
        fields.integer("columns") if is_grid else 0,
        fields.integer("rows") if is_grid else 0,
        cells,
    )
