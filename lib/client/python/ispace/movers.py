# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots and people."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Dict, Iterable, List, Optional, Tuple, Type

from ._connection import Address, Client
from ._message import Fields, Pose, number_of, split, text_of
from .errors import ProtocolError, Timeout
from .readings import R, Scan


@dataclass(frozen=True)
class Status:
    """State of a robot or person: its true pose in the room, speeds and accelerations."""

    time: float  #: simulated seconds
    pose: Pose  #: m, degrees
    speed: float  #: m/s, negative backward
    rotspeed: float  #: degrees/s, counter-clockwise
    accel: float  #: m/s²
    rotaccel: float  #: degrees/s²
    stall: bool  #: it has run into something, and stands until its next motion
    fields: Fields  #: all that the server says
    storey: str = ""  #: of a building; in a lift that whose floor is nearest; "" in a room
    passage: str = ""  #: the lift or the flight of stairs in which it is; "": on the storey


@dataclass(frozen=True)
class Limits:
    """Speeds and accelerations of a robot or person on a floor without friction."""

    speed: float  #: m/s of forward() and backward()
    rotspeed: float  #: degrees/s of left() and right()
    max_speed: float  #: m/s, forward and backward
    max_rotspeed: float  #: degrees/s, either way
    max_sidespeed: float  #: m/s, to either side; 0: it cannot
    accel: float  #: m/s², speeding up and braking
    rotaccel: float  #: degrees/s²


@dataclass(frozen=True)
class Odometry:
    """Odometry of a robot's wheels, from (0, 0, 0) at its start.

    It differs from Status.pose in a run with noise.
    """

    time: float
    pose: Pose  #: m, degrees
    speed: float  #: m/s
    rotspeed: float  #: degrees/s


@dataclass(frozen=True)
class Sonar:
    """One of the sonars of a robot."""

    place: Pose  #: on the robot: m, degrees, in its own frame
    range: float  #: m; infinity: no echo


@dataclass(frozen=True)
class Bumper:
    """One of the bumpers of a robot."""

    from_: float  #: bearings of its ends, degrees, counter-clockwise
    to: float
    hit: bool


@dataclass(frozen=True)
class Motion:
    """A motion with an end, as forward(), left(), path() and their kin return it."""

    id: int
    length: float = 0  #: of a path, m


@dataclass(frozen=True)
class End:
    """How a motion ended."""

    id: int
    done: bool  #: it got where it was to go
    reason: str  #: otherwise: stall, unreached, replaced, stopped or deleted, see Mover.wait()
    time: float  #: simulated seconds


class Mover(Client):
    """A robot or person that this client drives.

    Only one client can; the server rejects others (409). When it is closed, or its program dies, the robot brakes
    and is free. A motion replaces the running one.
    """

    def __init__(self, role: str, address: Address, id: str, timeout: float, token: str) -> None:
        super().__init__(f"{role} {id}", address, timeout, token)
        self.id = id
        self._ended: Dict[int, End] = {}

    @property
    def limits(self) -> Limits:
        """Its speeds and accelerations, as the server told them when the role was taken."""
        return Limits(*(self.info.number(field.name) for field in dataclasses.fields(Limits)))

    def forward(self, metres: float) -> Motion:
        """So far, at the model's own speed; not negative."""
        return self._begin(f"FORWARD {text_of(metres)}")

    def backward(self, metres: float) -> Motion:
        """So far, without turning, at the model's own speed; not negative."""
        return self._begin(f"BACKWARD {text_of(metres)}")

    def left(self, degrees: float) -> Motion:
        """On the spot, counter-clockwise; not negative."""
        return self._begin(f"LEFT {text_of(degrees)}")

    def right(self, degrees: float) -> Motion:
        """On the spot, clockwise; not negative."""
        return self._begin(f"RIGHT {text_of(degrees)}")

    def path(
        self,
        points: Iterable[Tuple[float, float]],
        speed: Optional[float] = None,
        pause: float = 0,
        loop: bool = False,
    ) -> Motion:
        """Along straight lines from where it stands, through points in m.

        ``speed`` in m/s, ``pause`` in s at each point; with ``loop`` from the last point to the first, again
        and again.
        """
        request = "PATH " + ";".join(f"{text_of(x)},{text_of(y)}" for x, y in points)
        if speed is not None:
            request += f" speed={text_of(speed)}"
        if pause > 0:
            request += f" pause={text_of(pause)}"
        return self._begin(request + (" loop=yes" if loop else ""))

    def goto(
        self, x: float, y: float, heading: Optional[float] = None, speed: Optional[float] = None, storey: str = ""
    ) -> Motion:
        """To a point in m round walls, furniture and robots that stand; there it turns to ``heading`` in degrees.

        ``storey`` is that of the point in the run of a building, by default that on which it is; ``speed`` in m/s.
        Raises Refused (409) if there is no way, which the map of walls and furniture decides at once.

        After 10 s without progress it takes another way, round robots and people that stand; after the third such
        failure it gives up, and wait() returns ``End(done=False, reason="unreached")``, also if a landing at the end
        of a lift stays occupied for 30 s. Any other motion replaces it.
        """
        request = f"GOTO {storey}{'/' if storey else ''}{text_of(x)},{text_of(y)}"
        if heading is not None:
            request += f",{text_of(heading)}"
        return self._begin(request if speed is None else f"{request} speed={text_of(speed)}")

    def go_to(self, storey: str, x: float, y: float, speed: Optional[float] = None) -> Motion:
        """By the fastest way to a point of a storey, in the run of a building."""
        return self.goto(x, y, speed=speed, storey=storey)

    def ride(self, lift: str, storey: str) -> Motion:
        """By a lift to a storey, in the run of a building."""
        return self._begin(f"RIDE {lift} {storey}")

    def speed(self, metres_per_second: float) -> None:
        """Sets a lasting speed, negative backward; keeps the rotation."""
        self._ask(f"SPEED {text_of(metres_per_second)}")

    def rotspeed(self, degrees_per_second: float) -> None:
        """Sets a lasting rotation, counter-clockwise; keeps the speed."""
        self._ask(f"ROTSPEED {text_of(degrees_per_second)}")

    def sidespeed(self, metres_per_second: float) -> None:
        """A speed to the left to keep, of people, and of robots with an omnidirectional drive."""
        self._ask(f"SIDESPEED {text_of(metres_per_second)}")

    def stop(self) -> None:
        """Brakes."""
        self._ask("STOP")

    def status(self) -> Status:
        """Its true pose, speeds and accelerations, and whether it has run into something."""
        fields = self._ask("STATUS").fields
        return Status(
            fields.number("t"),
            fields.pose(),
            fields.number("speed"),
            fields.number("rotspeed"),
            fields.number("accel"),
            fields.number("rotaccel"),
            fields.flag("stall"),
            fields,
            fields.get("storey", ""),
            fields.get("in", ""),
        )

    def wait(self, motion: Motion, timeout: float = math.inf) -> End:
        """Waits for the end of a motion; raises Timeout after ``timeout`` seconds of wall time.

        A motion that fails raises no exception: it returns ``End(done=False, reason=...)``, with the reason
        ``stall`` (it has run into something), ``unreached`` (goto() and path() gave up), ``replaced`` by another
        motion, ``stopped`` (by stop(), or the end of the run) or ``deleted`` (removed from the world). Therefore
        check: ``assert robot.wait(robot.goto(2, 1)).done``.
        """
        end = self.connection.take(lambda: self._known().pop(motion.id, None), timeout)
        if end is None:
            raise Timeout(f"{self.id} is still moving (motion {motion.id})")
        return end

    def ended(self, motion: Motion) -> bool:
        """Whether a motion has ended, as far as the server has said; wait() then returns at once."""
        return self.connection.take(lambda: motion.id in self._known() or None, 0) is not None

    def _begin(self, request: str) -> Motion:
        fields = self._ask(request).fields
        return Motion(fields.integer("id"), fields.number("length") if "length" in fields else 0)

    def _known(self) -> Dict[int, End]:
        """The ends that were read and not waited for."""
        for message in self.connection.ends():
            fields = message.fields
            end = End(
                fields.integer("id"),
                message.word(0) == "DONE",
                fields.get("reason", ""),
                fields.number("t"),
            )
            self._ended[end.id] = end
            if len(self._ended) > 10000:  # nobody may ever ask for most of them
                del self._ended[min(self._ended)]
        return self._ended


class Robot(Mover):
    """A robot (role ROBOT)."""

    def __init__(self, address: Address, id: str, timeout: float = 10, token: str = "") -> None:
        super().__init__("ROBOT", address, id, timeout, token)

    def __enter__(self) -> Robot:
        return self

    def scan(self, laser: str) -> Scan:
        """The newest scan of a laser that rides on it."""
        return self.reading(laser, Scan)

    def reading(self, sensor: str, kind: Type[R]) -> R:
        """The newest reading of a sensor that rides on it: ``robot.reading("c2", ispace.Picture)``."""
        return kind.from_message(self._ask(f"SCAN {sensor}"))

    def odometry(self) -> Odometry:
        """Where the robot believes it is, by its wheels."""
        fields = self._ask("ODOMETRY").fields
        return Odometry(
            fields.number("t"), fields.pose(), fields.number("speed"), fields.number("rotspeed")
        )

    def sonar(self) -> List[Sonar]:
        """Reads its ring of sonars; empty without sonars."""
        fields = self._ask("SONAR").fields
        places = [tuple(map(number_of, place.split(","))) for place in split(fields["at"], ";")]
        ranges = fields.numbers("r")
        if len(places) != len(ranges) or any(len(place) != 3 for place in places):
            raise ProtocolError(f"sonars at {fields['at']} with ranges {fields['r']}")
        return [Sonar(Pose(*place), range) for place, range in zip(places, ranges)]

    def bumpers(self) -> List[bool]:
        """Which of its bumpers are pressed."""
        return [bumper.hit for bumper in self.rim()]

    def rim(self) -> List[Bumper]:
        """Reads its bumpers, and which are pressed; empty without bumpers."""
        fields = self._ask("BUMPER").fields
        places = [tuple(map(number_of, place.split(","))) for place in split(fields["at"], ";")]
        hit = fields.numbers("hit")
        if len(places) != len(hit) or any(len(place) != 2 for place in places):
            raise ProtocolError(f"bumpers at {fields['at']}, hit {fields['hit']}")
        return [Bumper(place[0], place[1], value != 0) for place, value in zip(places, hit)]


class Person(Mover):
    """A person, driven as a robot is (role PERSON)."""

    def __init__(self, address: Address, id: str, timeout: float = 10, token: str = "") -> None:
        super().__init__("PERSON", address, id, timeout, token)

    def __enter__(self) -> Person:
        return self
