# SPDX-License-Identifier: GPL-3.0-or-later
"""The simulated world and its clock."""

from __future__ import annotations

import math
import os
import warnings
from dataclasses import dataclass
from typing import Dict, Iterator, List, Optional, Union

from ._connection import Address, Client
from ._message import Fields, Pose, number_of, split, text_of
from .errors import ProtocolError


@dataclass(frozen=True)
class Event:
    """Something that happened in the world."""

    #: collision, stall, enter, leave, mat, gate, seen, lost, state, activity, mark, change; missed: so many (n=) were dropped,
    #: as the client did not read them
    kind: str
    time: float  #: simulated seconds
    fields: Fields  #: id=, into=, zone= and what else belongs to its kind


@dataclass(frozen=True)
class Lift:
    """A lift of a building."""

    id: str
    storey: str  #: at which it stands, or from which it rides
    height: float  #: of its floor, m
    door: float  #: open share of its width
    riders: List[str]
    calls: List[str]  #: storeys, in the order in which it serves them


def track_request(prefix: str, name: str, x: float, y: float, kind: str, time: Optional[float]) -> str:
    """The request TRACK."""
    at = "" if time is None else f" t={text_of(time)}"
    return f"TRACK {name} {prefix}{text_of(x)},{text_of(y)}{at}" + (f" kind={kind}" if kind else "")


class World(Client):
    """The simulated world and its clock (role WORLD)."""

    def __init__(self, address: Address, timeout: float = 10, token: str = "") -> None:
        super().__init__("WORLD", address, timeout, token)
        self.dt = self.info.number("dt")  #: length of a step, s
        self.clock = self.info["clock"]  #: real, fast or step
        #: Simulated seconds in a second of wall time; 1 unless the clock is real.
        self.rate = self.info.number("rate") if "rate" in self.info else 1.0

    def __enter__(self) -> World:
        return self

    def list(self) -> Dict[str, List[str]]:
        """The ids of the world, by the keys of LIST: robots, lasers, people, sensors …"""
        return {key: split(value, ",") for key, value in self._ask("LIST").fields.items()}

    def time(self) -> float:
        """Simulated seconds since the run began."""
        return self._ask("TIME").fields.number("t")

    def steps(self) -> int:
        """Steps since the run began."""
        return self._ask("TIME").fields.integer("steps")

    def end(self) -> float:
        """When a replay ends, simulated seconds; infinity where that is not known, and of other runs."""
        fields = self._ask("TIME").fields
        return fields.number("end") if "end" in fields else math.inf

    def poses(self) -> Dict[str, Pose]:
        """Where the robots and people are, m and degrees."""
        poses = {}
        fields = self._ask("POSES").fields
        for item in split(fields["poses"], ";") + split(fields.get("people", ""), ";"):
            id, *numbers = item.split(",")
            if len(numbers) != 3:
                raise ProtocolError(f"`{item}` is no pose")
            poses[id] = Pose(*map(number_of, numbers))
        return poses

    def lifts(self) -> List[Lift]:
        """The lifts of a building."""
        lifts = []
        for item in split(self._ask("LIFTS").fields["lifts"], ";"):
            parts = item.split(",")
            if len(parts) != 6:
                raise ProtocolError(f"`{item}` is no lift")
            id, storey, height, door, riders, calls = parts
            lifts.append(
                Lift(id, storey, number_of(height), number_of(door), split(riders, "+"), split(calls, "+"))
            )
        return lifts

    def call(self, lift: str, storey: str) -> None:
        """Calls a lift to a storey."""
        self._ask(f"CALL {lift} {storey}")

    def hold(self, lift: str, storey: str = "") -> None:
        """Sends a lift to a storey before all calls, and keeps its doors open there; "" ends that."""
        self._ask(f"HOLD {lift} {storey}")

    def pause(self) -> None:
        """Stops the clock, for all clients."""
        self._ask("PAUSE")

    def resume(self) -> None:
        """Lets a paused clock go on."""
        self._ask("RESUME")

    def set_rate(self, rate: float) -> None:
        """Of the clock ``real``: so many simulated seconds pass in a second from now on, for all clients."""
        self.rate = self._ask(f"RATE {text_of(rate)}").fields.number("rate")

    def step(self, steps: int = 1, timeout: float = math.inf) -> int:
        """Advances a paused world, or one with the clock ``step``, and waits for its last step.

        Returns the number of steps: fewer if another client pauses or the run ends.
        """
        return self._ask(f"STEP {steps}", timeout).fields.integer("n")

    def advance(self, seconds: float, timeout: float = math.inf) -> None:
        """Steps of so many simulated seconds in all, rounded to whole ones."""
        steps = round(seconds / self.dt)
        if steps > 0:
            self.step(steps, timeout)

    def seek(self, seconds: float, timeout: float = math.inf) -> float:
        """Takes a replay to its last step at or before so many simulated seconds; the time of that step.

        Going back reads the record anew, which ``timeout`` seconds must be enough for.
        """
        return self._ask(f"SEEK {text_of(seconds)}", timeout).fields.number("t")

    def shutdown(self) -> None:
        """Ends the run."""
        self._ask("SHUTDOWN")

    def reset(self) -> None:
        """Moves robots and people back to their starts; time continues."""
        self._change("RESET")

    def set(self, id: str, key: str, value: str) -> None:
        """Changes a key of a record: ``set("r1", "speed", "0.3")``."""
        self._change(f"SET {id}.{key}={value}")

    def act(self, id: str, key: str, value: Union[str, bool, float]) -> None:
        """Sets the state of a lamp, a door or a switch: ``act("l1", "on", True)``."""
        self._change(f"ACT {id} {key}={int(value) if isinstance(value, bool) else value}")

    def states(self, id: str = "") -> Dict[str, str]:
        """The states of sensors and actuators by ``ID.KEY``, or those of one of them."""
        fields = self._ask(f"STATE {id}".rstrip()).fields
        return {key: value for key, value in fields.items() if key != "t"}

    def records(self, room: str = "") -> List[str]:
        """The records of the world, as in a file: those of the room, then robots, people and sensors.

        ``room`` is a storey, a lift or stairs of a building.
        """
        return self._ask(f"RECORDS {room}".rstrip()).data.decode("utf-8", "replace").splitlines()

    def add(self, record: str) -> str:
        """Adds a record, as in an environment or layout: ``add("cube id=b at=1,1 size=1,1,1")``; its id."""
        return self._change(f"ADD {record}")["id"]

    def remove(self, id: str) -> None:
        """Deletes a thing, sensor, robot or person."""
        self._change(f"DELETE {id}")

    def load(
        self,
        environment: Union[str, os.PathLike[str]],
        layout: Union[None, str, os.PathLike[str]] = None,
        timeout: float = 600,
    ) -> None:
        """Loads another room. Names of files are those of the server; ``layout`` is optional."""
        names = [os.fspath(environment)] + ([] if layout is None else [os.fspath(layout)])
        self._change("LOAD " + " ".join(names), timeout)

    def _change(self, request: str, timeout: Optional[float] = None) -> Fields:
        """Changes the world; a warning of the server, as of a robot outside the room, becomes a UserWarning."""
        fields = self._ask(request, timeout).fields
        if "warning" in fields:
            warnings.warn(fields["warning"], stacklevel=3)
        return fields

    def mark(self, text: str) -> None:
        """Writes a line into the records and to all clients that read events."""
        self._ask(f"MARK {text}")

    def track(
        self, name: str, x: float, y: float, kind: str = "", time: Optional[float] = None, storey: str = ""
    ) -> None:
        """Tells where a tracker sees a person or robot, for the page, the record and topics.

        ``time`` is that of the position, now by default; ``storey`` belongs to buildings.
        """
        self._ask(track_request(f"{storey}/" if storey else "", name, x, y, kind, time))

    def follow(self, *kinds: str) -> None:
        """Follow events of these kinds from now on, or of all."""
        self._ask("EVENTS " + ",".join(kinds) if kinds else "EVENTS")

    def unfollow(self) -> None:
        """Ends follow()."""
        self._ask("EVENTS off")

    def next_event(self, timeout: float = math.inf) -> Optional[Event]:
        """Returns the next event; None after this many seconds of wall time."""
        message = self.connection.next_event(timeout)
        if message is None:
            return None
        return Event(message.word(1), message.fields.number("t"), message.fields)

    def events(self, timeout: float = math.inf) -> Iterator[Event]:
        """Yields events, until a pause of this many seconds of wall time."""
        while (event := self.next_event(timeout)) is not None:
            yield event
