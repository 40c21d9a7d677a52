# SPDX-License-Identifier: GPL-3.0-or-later
"""Spatial memory: contents kept at places of a room, which tags in people's hands touch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence

from ._connection import Address, Client
from ._message import Message, split


@dataclass(frozen=True)
class Touch:
    """A tag comes into a volume (``touch``), stays there (``dwell``), or has left it (``leave``)."""

    kind: str
    time: float  #: seconds
    volume: str
    tag: str
    lasted: float  #: since the touch, seconds
    content: str


class Memory(Client):
    """The contents of a room (role MEMORY); tells what tags touch, by their measured positions.

    >>> with server.memory() as memory:
    ...     memory.store("news", 1.0, 0.5, 1.6, "today's headline", radius=0.2)
    ...     while touch := memory.next_touch(timeout=60):
    ...         print(touch.tag, touch.kind, touch.content)
    """

    def __init__(self, address: Address, tags: str = "*", timeout: float = 10, token: str = "") -> None:
        """tags: those that it hears of, a pattern of ids"""
        super().__init__(f"MEMORY {tags}", address, timeout, token)
        self.tags = split(self.info["tags"], ",") if self.info.get("tags") else []  #: ids

    def __enter__(self) -> Memory:
        return self

    def store(
        self, id: str, x: float, y: float, z: float = 1.2, content: str = "", radius: Optional[float] = None, storey: str = ""
    ) -> None:
        """Keeps a content at a place, in a ball; without a content or a radius those of before stay."""
        place = f"{storey}/" if storey else ""
        words = [f"STORE {id} {place}{x:.6g},{y:.6g},{z:.6g}"]
        if radius is not None:
            words.append(f"radius={radius:.6g}")
        self._ask(" ".join([*words, content]).rstrip())

    def forget(self, id: str) -> None:
        """Removes a volume."""
        self._ask(f"FORGET {id}")

    def at(self, x: float, y: float, z: float, storey: str = "") -> List[str]:
        """The volumes that contain a point, the nearest centre first."""
        place = f"{storey}/" if storey else ""
        return self._found(f"{place}{x:.6g},{y:.6g},{z:.6g}")

    def find(self, text: str) -> List[str]:
        """The volumes with this text in their content, in capitals or not."""
        return self._found(text)

    def _found(self, what: str) -> List[str]:
        ids = self._ask(f"FIND {what}").fields["ids"]
        return split(ids, ",") if ids else []

    def recall(self, id: str) -> str:
        """The content of a volume."""
        return self._ask(f"RECALL {id}").fields["text"]

    def tags_at(self, id: str) -> Sequence[str]:
        """The tags in a volume now."""
        tags = self._ask(f"RECALL {id}").fields["by"]
        return split(tags, ",") if tags else []

    def next_touch(self, timeout: float = 0) -> Optional[Touch]:
        """The next touch, stay or leave; None after this many seconds of wall time."""
        while (message := self.connection.next_event(timeout)) is not None:
            if message.word(1) in ("touch", "dwell", "leave"):
                return _touch(message)
        return None


def _touch(message: Message) -> Touch:
    fields = message.fields
    return Touch(message.word(1), fields.number("t"), fields["id"], fields["by"], fields.number("for"), fields["text"])
