# SPDX-License-Identifier: GPL-3.0-or-later
"""Readings of sensors.

Arrays are numpy's if it is installed, else the standard library's ``array``.
"""

from __future__ import annotations

import array
import importlib
import math
import os
import sys
from dataclasses import dataclass, field
from typing import Any, Callable, Iterator, List, NamedTuple, Protocol, Tuple, Type, TypeVar, Union

from ._message import Fields, Message, Pose3
from .errors import ProtocolError


def _numpy() -> Any:
    """Returns the module, or None: untyped, so that types are the same with and without it."""
    try:
        return importlib.import_module("numpy")
    except ImportError:
        return None


numpy = _numpy()

R = TypeVar("R", bound="Reading")


class Floats(Protocol):
    """An array of float32: numpy's or the standard library's."""

    def __len__(self) -> int: ...
    def __getitem__(self, i: Any) -> Any: ...
    def __iter__(self) -> Iterator[Any]: ...


def _floats(values: Union[bytes, List[float]]) -> Floats:
    if numpy is not None:
        listed = isinstance(values, list)
        read: Floats = numpy.array(values, "<f4") if listed else numpy.frombuffer(values, "<f4")
        return read
    result = array.array("f")
    if isinstance(values, list):
        result.extend(values)
        return result
    result.frombytes(values)
    if sys.byteorder == "big":
        result.byteswap()
    return result


def _millimetres(data: bytes) -> Floats:
    """Metres of unsigned 16-bit millimetres, of which 0 is no return."""
    if numpy is not None:
        values = numpy.frombuffer(data, dtype="<u2")
        metres = values.astype(numpy.float32) / numpy.float32(1000)
        metres[values == 0] = numpy.inf
        read: Floats = metres
        return read
    pairs = (data[i] | data[i + 1] << 8 for i in range(0, len(data) - 1, 2))
    return array.array("f", [mm / 1000 if mm else math.inf for mm in pairs])


@dataclass
class Reading:
    """Base of all readings; of a sensor of any kind, as the server sent it."""

    sensor: str  #: id
    time: float  #: simulated seconds
    seq: int  #: number of the reading; a gap shows what was missed
    fields: Fields = field(repr=False)
    data: bytes = field(repr=False)  #: bytes of the frame, if it has any

    @classmethod
    def from_message(cls: Type[R], message: Message) -> R:
        """Reads the answer to SCAN; raises ProtocolError if it is of another kind."""
        fields = message.fields
        reading = cls(
            message.word(1), fields.number("t"), fields.integer("seq"), fields, message.data
        )
        reading._check()
        return reading

    def _check(self) -> None:
        """Raises ProtocolError if the content is not there."""

    @property
    def pose(self) -> Pose3:
        """Where the sensor was in the room; of readings with ``pose=``."""
        numbers = self.fields.numbers("pose")
        if len(numbers) != 6:
            raise ProtocolError(f"a pose of {len(numbers)} numbers")
        return Pose3(*numbers)


class Beam(NamedTuple):
    """One beam of a scan: its range in m, infinity without a return, and its direction in degrees,
    counter-clockwise from straight ahead."""

    range: float
    angle: float


@dataclass
class Scan(Reading):
    """One scan of a laser: ``ranges[k]`` is that of the beam at ``angle(k)``.

    A range is in metres, or infinity: no return. The beam then hit no surface up to the laser's maximum range, or
    one nearer than its minimum; LaserSensor has both as ``range_max`` and ``range_min``.
    """

    def _check(self) -> None:
        fields = self.fields
        self._angle_min = fields.number("angle_min")
        self._angle_max = fields.number("angle_max")
        self._step = fields.number("step")
        self._ranges: Floats = _floats(fields.numbers("r") if "r" in fields else self.data)
        if len(self._ranges) != fields.integer("n"):
            raise ProtocolError(f"a scan of {self.sensor} has {len(self._ranges)} ranges, says n={fields['n']}")

    @property
    def ranges(self) -> Floats:
        """Range of each beam, m, float32; infinity: no return. An array of numpy's or of the standard library's."""
        return self._ranges

    @property
    def angle_min(self) -> float:
        """Direction of the first beam, degrees, counter-clockwise from straight ahead."""
        return self._angle_min

    @property
    def angle_max(self) -> float:
        """Direction of the last beam, degrees."""
        return self._angle_max

    @property
    def step(self) -> float:
        """Degrees from each beam to the next."""
        return self._step

    def angle(self, k: int) -> float:
        """Direction of beam k, degrees."""
        return self._angle_min + k * self._step

    def nearest(self) -> Beam:
        """The beam with the least range, of several the first; if no beam has a return: infinity, and NaN as its
        angle."""
        ranges: Any = self._ranges
        if len(ranges) == 0:
            return Beam(math.inf, math.nan)
        k = int(ranges.argmin()) if numpy is not None else min(range(len(ranges)), key=ranges.__getitem__)
        least = float(ranges[k])
        return Beam(least, self.angle(k) if math.isfinite(least) else math.nan)


@dataclass
class Picture(Reading):
    """A picture of a camera, or a ranger's depths as a picture.

    ``format`` is png, jpeg or rgb, ``width`` and ``height`` are pixels, ``data`` the bytes as they came.
    """

    def _check(self) -> None:
        self.format = self.fields["format"]  #: png, jpeg or rgb (8 bits each, rows from the top)
        self.width = self.fields.integer("width")
        self.height = self.fields.integer("height")

    @property
    def pixels(self) -> Any:
        """Of the format rgb: an array (height, width, 3) of uint8, or bytes without numpy."""
        if self.format != "rgb":
            raise ProtocolError(f"only rgb has pixels, this is {self.format}: format('rgb') before")
        if numpy is None:
            return self.data
        return numpy.frombuffer(self.data, dtype=numpy.uint8).reshape(self.height, self.width, 3)

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes a PNG or JPEG as it came."""
        with open(path, "wb") as file:
            file.write(self.data)


@dataclass
class Depths(Reading):
    """Depths of a ranger (formats depth32 and depth16), rows from the top.

    They are along its axis, or, if its projection is spherical, distances. ``depths`` are metres, infinity: no return;
    an array of (``height``, ``width``) with numpy, else one row after the other.
    """

    def _check(self) -> None:
        self.width = self.fields.integer("width")
        self.height = self.fields.integer("height")
        form = self.fields["format"]
        if form not in ("depth32", "depth16"):
            raise ProtocolError(f"depths come as depth32 or depth16, found {form}")
        read: Callable[[bytes], Floats] = _floats if form == "depth32" else _millimetres
        values = read(self.data)
        if len(values) != self.width * self.height:
            raise ProtocolError(f"a frame of {self.sensor} is incomplete")
        #: m; infinity: no return. (height, width) with numpy, else one row after the other.
        self.depths: Any = values
        if numpy is not None:
            self.depths = self.depths.reshape(self.height, self.width)

    def at(self, column: int, row: int) -> float:
        """Depth of a pixel, m; columns from the left, rows from the top."""
        if numpy is not None:
            return float(self.depths[row, column])
        return float(self.depths[row * self.width + column])


@dataclass
class Cloud(Reading):
    """A point a pixel of a ranger (format cloud), in its frame: x ahead, y left, z up; m; NaN: no return.

    ``points`` is an array of (n, 3) with numpy, else a list of triples.
    """

    def _check(self) -> None:
        values = _floats(self.data)
        #: An array (n, 3) with numpy, else a list of triples.
        self.points: Any = values
        if numpy is not None:
            self.points = self.points.reshape(-1, 3)
        else:
            self.points = [tuple(values[i : i + 3]) for i in range(0, len(values) - 2, 3)]


@dataclass
class Burst(Reading):
    """Times of flight that an ultrasonic receiver measures from each tag."""

    @property
    def times_of_flight(self) -> List[Tuple[str, float]]:
        """Tags and seconds; infinity: not heard."""
        return list(zip(self.fields.list("tags"), self.fields.numbers("tof")))


@dataclass
class Fix(Reading):
    """Position of a tag, computed by the receivers.

    ``x``, ``y``, ``z`` and ``residual`` are metres, and infinity unless it is ``solved``; ``heard`` receivers heard the
    tag.
    """

    def _check(self) -> None:
        self.heard = self.fields.integer("heard")  #: receivers that heard it
        self.solved = self.fields["x"] != "-"  #: False: too few, the rest is infinity
        self.x, self.y, self.z, self.residual = map(self.fields.number, ("x", "y", "z", "residual"))


@dataclass
class Load(Reading):
    """Robots and people on a mat."""

    @property
    def on(self) -> List[str]:
        """ids"""
        return self.fields.list("on")


@dataclass
class Passages(Reading):
    """Movers that have passed a gate since the start of the run: ``in_`` and ``out``.

    ``last`` is the id of the last one, and ``way`` its way, in or out; both are empty before the first. ``broken``: an
    object or a mover stands in the beam now.
    """

    def _check(self) -> None:
        self.in_ = self.fields.integer("in")
        self.out = self.fields.integer("out")
        last = self.fields["last"]
        self.last = "" if last == "-" else last  #: id of the last one; empty: nobody yet
        way = self.fields["way"]
        self.way = "" if way == "-" else way  #: its way, in or out
        self.broken = self.fields.flag("broken")  #: something stands in the beam now
