# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of a sensor network: computers that own sensors, each with its clock and its line."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional, Type, TypeVar

from ._connection import Address, Client
from ._message import split, text_of
from .errors import Timeout
from .readings import Reading
from .world import track_request

R = TypeVar("R", bound=Reading)


@dataclass(frozen=True)
class NodeMessage:
    """A message that a node has received."""

    time: float  #: of arrival, by the receiver's clock, seconds
    sender: str  #: node
    number: int  #: of the sender's messages, from 1; gaps show lost ones
    text: str


class Node(Client):
    """A node (role NODE): reads its sensors, and talks to others over a line with delays and losses.

    All times are those of its clock.
    """

    def __init__(self, address: Address, id: str, timeout: float = 10, token: str = "") -> None:
        super().__init__(f"NODE {id}", address, timeout, token)
        self.id = id
        self.sensors = split(self.info["sensors"], ",") if "sensors" in self.info else []  #: ids
        self.lockstep = self.info.flag("lockstep")  #: the world waits for this program, see await_time()

    def __enter__(self) -> Node:
        return self

    def time(self) -> float:
        """The time on its clock."""
        return self._ask("TIME").fields.number("t")

    def await_time(self, time: float) -> float:
        """Waits until the clock shows this, and returns the time then.

        Of a node in lockstep, the world waits there for the next call. Raises Refused if the run ends before.
        """
        return self._ask(f"AWAIT {text_of(time)}", math.inf).fields.number("t")

    def scan(self, sensor: str, kind: Type[R]) -> R:
        """The newest reading of a sensor of this node: ``node.scan("l1", ispace.Scan)``."""
        return kind.from_message(self._ask(f"SCAN {sensor}"))

    def stream(self, sensor: str, every: int = 1) -> None:
        """Requests every new reading of a sensor, but of cameras and rangers."""
        self._ask(f"STREAM {sensor} every={every}")

    def next(self, kind: Type[R], timeout: Optional[float] = None) -> R:
        """The next reading of any stream; raises Timeout after seconds of wall time."""
        message = self.connection.next_scan(self.connection.timeout if timeout is None else timeout)
        if message is None:
            raise Timeout(f"no reading of node {self.id}")
        return kind.from_message(message)

    def send(self, text: str) -> int:
        """Sends a line to the nodes that hear this one; returns its number."""
        return self._ask(f"SEND {text}").fields.integer("n")

    def hear(self, *nodes: str) -> None:
        """Receives from now on what these nodes send, or all others."""
        self._ask(" ".join(("HEAR", *nodes)))

    def receive(self, timeout: float = 0) -> Optional[NodeMessage]:
        """The next message that has arrived; None after this many seconds of wall time."""
        while (message := self.connection.next_event(timeout)) is not None:
            if message.word(1) == "message":
                fields = message.fields
                return NodeMessage(fields.number("t"), fields["from"], fields.integer("n"), fields["text"])
        return None

    def track(self, name: str, x: float, y: float, time: float, kind: str = "") -> None:
        """Tells where a person or robot is, for the page, the record and topics."""
        self._ask(track_request("", name, x, y, kind, time))
