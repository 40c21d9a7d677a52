# SPDX-License-Identifier: GPL-3.0-or-later
"""Radios by which robots and rooms send messages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from ._connection import Address, Client
from ._message import split


@dataclass(frozen=True)
class RadioMessage:
    """A text that a radio has received."""

    radio: str  #: that received it
    sender: str  #: the radio that sent it
    time: float  #: seconds
    margin: float  #: how much stronger than the weakest signal that is received, dB
    text: str


class Radios(Client):
    """Radios of robots, people and rooms (role RADIO): texts reach those of their kind and channel within the range.

    >>> with server.radios("base") as base, server.radios("rover") as rover:
    ...     base.send("base", "go to 3,4")
    ...     print(rover.next_message(timeout=60))
    """

    def __init__(self, address: Address, radios: str = "*", timeout: float = 10, token: str = "") -> None:
        """radios: those that it sends from and hears, a pattern of ids"""
        super().__init__(f"RADIO {radios}", address, timeout, token)
        self.radios = split(self.info["radios"], ",") if self.info.get("radios") else []  #: ids
        #: how many messages of its radios it has missed: next_message() was called too rarely, or too many came in a step
        self.missed = 0

    def __enter__(self) -> Radios:
        return self

    def send(self, id: str, text: str) -> None:
        """Sends a text from a radio, at most 1000 bytes without line breaks."""
        self._ask(f"SEND {id} {text}")

    def heard(self, id: str) -> int:
        """How many messages a radio has received since the run began."""
        return self._ask(f"READ {id}").fields.integer("heard")

    def next_message(self, timeout: float = 0) -> Optional[RadioMessage]:
        """The next message that one of its radios receives; None after this many seconds of wall time."""
        while (message := self.connection.next_event(timeout)) is not None:
            if message.word(1) == "missed":
                self.missed += message.fields.integer("n")
            if message.word(1) == "message":
                fields = message.fields
                return RadioMessage(fields["id"], fields["from"], fields.number("t"), fields.number("margin"), fields["text"])
        return None
