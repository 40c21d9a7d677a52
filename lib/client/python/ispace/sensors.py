# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors of the room and on robots; any number of clients may read one."""

from __future__ import annotations

from typing import Generic, Iterator, Optional, Type, TypeVar

from ._connection import Address, Client
from .errors import Timeout
from .readings import Burst, Cloud, Depths, Fix, Load, Passages, Picture, Reading, Scan

T = TypeVar("T", bound=Reading)


class SensorOf(Client, Generic[T]):
    """A sensor with readings of the type T."""

    _reading: Type[T]

    def __init__(
        self, address: Address, id: str, timeout: float = 10, token: str = "", role: str = "SENSOR"
    ) -> None:
        super().__init__(f"{role} {id}", address, timeout, token)
        self.id = id

    def scan(self) -> T:
        """The newest reading, up to a period old."""
        return self._reading.from_message(self._ask("SCAN"))

    def stream(self, every: int = 1) -> None:
        """Requests every new reading whose number is a multiple of ``every``.

        A slow client reads the newest.
        """
        self._ask(f"STREAM every={every}")

    def next(self, timeout: Optional[float] = None) -> T:
        """The next reading of the stream; raises Timeout after seconds of wall time."""
        message = self.connection.next_scan(self.connection.timeout if timeout is None else timeout)
        if message is None:
            raise Timeout(f"no reading of {self.id}")
        return self._reading.from_message(message)

    def stop(self) -> None:
        """Ends the stream; readings that are on their way are dropped."""
        self._ask("STOP")
        self.connection.drop_scans()

    def readings(self, every: int = 1) -> Iterator[T]:
        """A stream for a loop, which ends it: ``for scan in laser.readings(): …``"""
        self.stream(every)
        try:
            while True:
                yield self.next()
        finally:
            self.stop()

    def binary(self, on: bool) -> None:
        """Whether frames come as bytes behind their line, or as text in it. Both are understood."""
        self._ask("BINARY on" if on else "BINARY off")

    def format(self, name: str) -> None:
        """Cameras: png, jpeg, rgb. Rangers: depth32, depth16, cloud, png."""
        self._ask(f"FORMAT {name}")


class Sensor(SensorOf[Reading]):
    """Of any kind, see Reading.fields."""

    _reading = Reading

    def __enter__(self) -> Sensor:
        return self


class LaserSensor(SensorOf[Scan]):
    """A laser range finder (role LASER). Its scans come as bytes, unless after binary(False)."""

    _reading = Scan

    def __init__(self, address: Address, id: str, timeout: float = 10, token: str = "") -> None:
        super().__init__(address, id, timeout, token, "LASER")
        self._range_min, self._range_max, self._rate = map(self.info.number, ("range_min", "range_max", "rate"))
        self.binary(True)

    @property
    def range_min(self) -> float:
        """Minimum range, m: a beam that hits a nearer surface has no return."""
        return self._range_min

    @property
    def range_max(self) -> float:
        """Maximum range, m: a beam that hits no surface up to there has no return."""
        return self._range_max

    @property
    def rate(self) -> float:
        """Scans a simulated second."""
        return self._rate

    def __enter__(self) -> LaserSensor:
        return self


class Camera(SensorOf[Picture]):
    """A camera; its pictures come as PNG by default, see format()."""

    _reading = Picture

    def __enter__(self) -> Camera:
        return self


class Ranger(SensorOf[Depths]):
    """In the formats depth32 and depth16."""

    _reading = Depths

    def __enter__(self) -> Ranger:
        return self


class CloudSensor(SensorOf[Cloud]):
    """A ranger, read as points."""

    _reading = Cloud

    def __init__(self, address: Address, id: str, timeout: float = 10, token: str = "") -> None:
        super().__init__(address, id, timeout, token)
        self.format("cloud")

    def __enter__(self) -> CloudSensor:
        return self


class Ultrasound(SensorOf[Burst]):
    """An ultrasonic receiver."""

    _reading = Burst

    def __enter__(self) -> Ultrasound:
        return self


class Tag(SensorOf[Fix]):
    """A tag, which sends ultrasound, and its computed position."""

    _reading = Fix

    def __enter__(self) -> Tag:
        return self


class Mat(SensorOf[Load]):
    """A mat, which detects robots and people on it."""

    _reading = Load

    def __enter__(self) -> Mat:
        return self


class Gate(SensorOf[Passages]):
    """A light gate, which counts the movers that pass it each way."""

    _reading = Passages

    def __enter__(self) -> Gate:
        return self
