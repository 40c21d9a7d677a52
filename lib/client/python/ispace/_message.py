# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of the protocol, taken apart."""

from __future__ import annotations

import base64
import math
import re
from dataclasses import dataclass, field
from typing import Dict, List, NamedTuple

from .errors import Error, ProtocolError


class Pose(NamedTuple):
    """Where something is in the room: m, and degrees in (-180, 180], counter-clockwise, 0 along x."""

    x: float
    y: float
    heading: float


class Pose3(NamedTuple):
    """The same in space, m and degrees; tilt is positive upward."""

    x: float
    y: float
    z: float
    heading: float
    tilt: float
    roll: float


def number_of(text: str) -> float:
    """The number that a text is; ``-``, no return, is infinity."""
    if text == "-":
        return math.inf
    try:
        return float(text)
    except ValueError:
        raise ProtocolError(f"the server sent `{text}` for a number") from None


def text_of(value: float) -> str:
    """The shortest text that the same number is read from."""
    if not math.isfinite(value):
        raise Error(f"a request has the number {value}")
    return repr(float(value)).removesuffix(".0")


def split(text: str, separator: str) -> List[str]:
    """Returns the parts between separators; an empty list for an empty text."""
    return text.split(separator) if text else []


class Fields(Dict[str, str]):
    """The ``key=value`` pairs of a line. Reading a missing key raises ProtocolError."""

    def __missing__(self, key: str) -> str:
        raise ProtocolError(f"the server's answer has no `{key}`")

    def number(self, key: str) -> float:
        """A number; infinity where the server writes ``-``."""
        return number_of(self[key])

    def integer(self, key: str) -> int:
        """A whole number."""
        return round(self.number(key))

    def flag(self, key: str) -> bool:
        """Whether it is 1."""
        return self[key] == "1"

    def list(self, key: str) -> List[str]:
        """Parts between commas."""
        return split(self[key], ",")

    def numbers(self, key: str) -> List[float]:
        """Numbers between commas."""
        return [number_of(part) for part in self.list(key)]

    def pose(self) -> Pose:
        """The pose in x=, y= and heading=."""
        return Pose(self.number("x"), self.number("y"), self.number("heading"))


@dataclass
class Message:
    """One line of the server, and the bytes that came with it."""

    line: str
    words: List[str] = field(default_factory=list)  #: what is no pair; the first is OK, ERR, SCAN …
    fields: Fields = field(default_factory=Fields)
    data: bytes = b""  #: the bytes behind a line with ``bytes=``, or in its ``base64=``

    def word(self, i: int) -> str:
        """Word i of the line, counted from 0 without the pairs; empty beyond the last."""
        return self.words[i] if i < len(self.words) else ""


def parse_message(line: str) -> Message:
    """Parses a line. ``text=`` and ``what=``, in events, and ``warning=`` reach to its end."""
    message = Message(line)
    ending = re.search(" (text|what|warning)=", line)
    head = line[: ending.start()] if ending else line
    for word in head.split(" "):
        key, equal, value = word.partition("=")
        if equal and message.words:
            message.fields[key] = value
        elif word:
            message.words.append(word)
    if ending:
        message.fields[ending.group(1)] = line[ending.end() :]
    if "base64" in message.fields:
        message.data = base64.b64decode(message.fields["base64"])
    return message
