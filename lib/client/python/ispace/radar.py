# SPDX-License-Identifier: GPL-3.0-or-later
"""Radars, which detect movers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List

from .errors import ProtocolError
from .readings import Reading
from .sensors import SensorOf


@dataclass
class Detection:
    """A mover as a radar reports it, in the radar's frame."""

    range: float  #: m
    bearing: float  #: degrees, counter-clockwise from its axis
    elevation: float  #: degrees, upwards
    speed: float  #: m/s, radial: above 0 it moves away


@dataclass
class Detections(Reading):
    """The movers that a radar detects."""

    def _check(self) -> None:
        columns = [self.fields.numbers(key) for key in ("range", "bearing", "elevation", "speed")]
        if any(len(column) != self.fields.integer("n") for column in columns):
            raise ProtocolError(f"a reading of {self.sensor} is incomplete")
        #: the nearest first
        self.movers: List[Detection] = [Detection(*row) for row in zip(*columns)]


class Radar(SensorOf[Detections]):
    """A millimetre-wave radar."""

    _reading = Detections

    def __enter__(self) -> Radar:
        return self
