# SPDX-License-Identifier: GPL-3.0-or-later
"""Thermometers of zones."""

from __future__ import annotations

from dataclasses import dataclass

from .readings import Reading
from .sensors import SensorOf


@dataclass
class Temperature(Reading):
    """The temperature of a zone."""

    def _check(self) -> None:
        self.celsius = self.fields.number("celsius")  #: degrees Celsius, rounded to 0.1


class Thermometer(SensorOf[Temperature]):
    """A thermometer."""

    _reading = Temperature

    def __enter__(self) -> Thermometer:
        return self
