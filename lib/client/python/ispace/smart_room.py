# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors of smart rooms: inertial units, RFID readers, light meters, microphones."""

from __future__ import annotations

from dataclasses import dataclass

from .readings import Reading
from .sensors import SensorOf


@dataclass
class Inertia(Reading):
    """Rates and accelerations of an inertial measurement unit, about and along its axes x, y, z."""

    def _check(self) -> None:
        self.rates = self.fields.numbers("rates")  #: degrees a second
        self.accelerations = self.fields.numbers("accelerations")  #: m/s², with gravity


class Imu(SensorOf[Inertia]):
    """An inertial measurement unit."""

    _reading = Inertia

    def __enter__(self) -> Imu:
        return self


@dataclass
class TagList(Reading):
    """The tags in the field of an RFID reader."""

    def _check(self) -> None:
        self.tags = self.fields.list("tags")  #: texts, sorted


class Rfid(SensorOf[TagList]):
    """An RFID reader."""

    _reading = TagList

    def __enter__(self) -> Rfid:
        return self


@dataclass
class Illuminance(Reading):
    """The light at a spot."""

    def _check(self) -> None:
        self.lux = self.fields.number("lux")


class Lux(SensorOf[Illuminance]):
    """A light meter."""

    _reading = Illuminance

    def __enter__(self) -> Lux:
        return self


@dataclass
class SoundLevel(Reading):
    """The sound at a microphone."""

    def _check(self) -> None:
        self.level = self.fields.number("level")  #: sound pressure level, dB, in tenths


class Microphone(SensorOf[SoundLevel]):
    """A microphone."""

    _reading = SoundLevel

    def __enter__(self) -> Microphone:
        return self
