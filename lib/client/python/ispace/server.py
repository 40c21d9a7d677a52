# SPDX-License-Identifier: GPL-3.0-or-later
"""A simrun of one's own."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
import tempfile
import time
from typing import IO, Optional

from .bumpers import Bumpers
from .errors import ToolError
from .filters import Option, Placed, Room, arguments_of, last_line, operands, tool
from .floor import Floor
from .heads import Heads
from .movers import Person, Robot
from .locks import Locks
from .memory import Memory
from .meter import Meter
from .node import Node
from .radios import Radios
from .sensors import Camera, LaserSensor, Ranger, Sensor
from .world import World


class Simrun:
    """A running simrun, which ends with its context; no other is touched. See simrun()."""

    def __init__(self, room: Optional[Room], layout: Placed, clock: str, timeout: float, **options: Option) -> None:
        self._context = contextlib.ExitStack()
        self._errors: IO[bytes] = tempfile.TemporaryFile()
        self._said = ""
        self._process: Optional[subprocess.Popen[bytes]] = None
        self.status: Optional[int] = None  #: exit status once it has ended
        try:
            names = self._context.enter_context(operands(room, layout))
            words = arguments_of({"clock": clock, "listen": "127.0.0.1:0", **options})
            self._process = subprocess.Popen(
                [tool("simrun"), *names, *words],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                start_new_session=True,  # Ctrl-C is for the program; this ends it then
            )
            #: Where clients connect, HOST:PORT.
            self.address: str = json.loads(self._first_line(timeout))["listen"]
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Ends the run, and waits until it has ended."""
        process, self._process = self._process, None
        if process is not None:
            process.terminate()
            try:
                self.status = process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                self.status = process.wait()
            if process.stdout:
                process.stdout.close()
        if not self._errors.closed:
            self._said = self.messages
            self._errors.close()
        self._context.close()

    def wait(self, timeout: Optional[float] = None) -> int:
        """Waits for a run that ends by itself (``until=``, SHUTDOWN); its exit status."""
        if self._process is not None:
            self.status = self._process.wait(timeout)
            self.close()
        assert self.status is not None
        return self.status

    @property
    def messages(self) -> str:
        """Its messages so far: warnings, errors."""
        if self._errors.closed:
            return self._said
        return os.pread(self._errors.fileno(), 1 << 20, 0).decode(errors="replace")

    @property
    def pid(self) -> Optional[int]:
        """The process id of a running simrun, to watch or to signal it; None once it has ended."""
        return None if self._process is None else self._process.pid

    def robot(self, id: str) -> Robot:
        """Takes the role of a robot."""
        return Robot(self.address, id)

    def person(self, id: str) -> Person:
        """Takes the role of a person."""
        return Person(self.address, id)

    def laser(self, id: str) -> LaserSensor:
        """Reads a laser."""
        return LaserSensor(self.address, id)

    def camera(self, id: str) -> Camera:
        """Reads a camera."""
        return Camera(self.address, id)

    def ranger(self, id: str) -> Ranger:
        """Reads a ranger."""
        return Ranger(self.address, id)

    def sensor(self, id: str) -> Sensor:
        """Reads a sensor of any kind."""
        return Sensor(self.address, id)

    def node(self, id: str) -> Node:
        """Takes a node of its sensor network."""
        return Node(self.address, id)

    def memory(self, tags: str = "*") -> Memory:
        """Keeps contents at places, and hears what these tags touch."""
        return Memory(self.address, tags)

    def meter(self, plugs: str = "*") -> Meter:
        """Reads plugs that meter appliances."""
        return Meter(self.address, plugs)

    def locks(self, doors: str = "*") -> Locks:
        """Shows tags to doors with locks."""
        return Locks(self.address, doors)

    def heads(self, heads: str = "*") -> Heads:
        """Turns heads that carry cameras and lasers."""
        return Heads(self.address, heads)

    def radios(self, radios: str = "*") -> Radios:
        """Sends and receives messages by radios."""
        return Radios(self.address, radios)

    def bumpers(self, bumpers: str = "*") -> Bumpers:
        """Hears how hard robots run into things."""
        return Bumpers(self.address, bumpers)

    def floor(self, sensors: str = "*") -> Floor:
        """Reads floors, beds and chairs that feel weights."""
        return Floor(self.address, sensors)

    def world(self) -> World:
        """Watches and controls the world and its clock."""
        return World(self.address)

    def __enter__(self) -> Simrun:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def _first_line(self, timeout: float) -> bytes:
        assert self._process is not None and self._process.stdout is not None
        end = time.monotonic() + timeout
        line = b""
        while not line.endswith(b"\n"):
            ready, _, _ = select.select([self._process.stdout], [], [], max(0, end - time.monotonic()))
            data = os.read(self._process.stdout.fileno(), 65536) if ready else b""
            if not ready:
                raise ToolError(f"simrun does not begin within {timeout:g} s", -1)
            if not data:
                status = self._process.wait()
                raise ToolError(last_line(self.messages), status)
            line += data
        return line


def simrun(
    room: Optional[Room] = None,
    layout: Placed = None,
    clock: str = "real",
    timeout: float = 600,
    **options: Option,
) -> Simrun:
    """Starts simrun on a free port of this machine, and waits until it listens::

        with ispace.simrun("room.env", "robots.3dm", clock="real:20") as run:
            with run.robot("r1") as robot:
                robot.wait(robot.forward(1))

    ``clock`` and ``options`` are those of simrun(1): ``dt``, ``until``, ``script``, ``record`` …;
    ``simrun(replay="run")`` serves a recorded run again, in its room. At the end of the context it stops only the
    process that it has started. ``timeout``: seconds until it must listen.
    """
    return Simrun(room, layout, clock, timeout, **options)
