# SPDX-License-Identifier: GPL-3.0-or-later
"""Passive infrared sensors, which detect people who move."""

from __future__ import annotations

from dataclasses import dataclass

from .readings import Reading
from .sensors import SensorOf


@dataclass
class Presence(Reading):
    """The output of a passive infrared sensor."""

    def _check(self) -> None:
        self.motion = self.fields.flag("motion")  #: people move in its sight, or did within the hold time


class Pir(SensorOf[Presence]):
    """A passive infrared sensor."""

    _reading = Presence

    def __enter__(self) -> Pir:
        return self
