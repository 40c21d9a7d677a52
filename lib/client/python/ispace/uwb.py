# SPDX-License-Identifier: GPL-3.0-or-later
"""Ultra-wideband anchors, which measure the ranges of tags."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Tuple

from .errors import ProtocolError
from .readings import Reading
from .sensors import SensorOf


@dataclass
class TagRange:
    """The range of a tag, and its position by all anchors."""

    tag: str
    range: float  #: m
    blocked: bool  #: a wall or a mover is between
    position: Optional[Tuple[float, float, float]]  #: m; None: not located
    ambiguous: bool  #: the position is one of two, mirror images


@dataclass
class TagRanges(Reading):
    """The tags that an anchor reaches."""

    def _check(self) -> None:
        fields = self.fields
        texts = [fields.list(key) for key in ("tags", "x", "y", "z", "ambiguous")]
        numbers = [fields.numbers(key) for key in ("ranges", "blocked")]
        sizes = {len(column) for column in texts} | {len(column) for column in numbers}
        if sizes != {fields.integer("n")}:
            raise ProtocolError(f"a reading of {self.sensor} is incomplete")
        #: sorted
        self.tags: List[TagRange] = [
            TagRange(
                tag,
                range_,
                bool(blocked),
                None if x == "-" else (float(x), float(y), float(z)),
                ambiguous == "1",
            )
            for tag, x, y, z, ambiguous, range_, blocked in zip(*texts, *numbers)
        ]


class Uwb(SensorOf[TagRanges]):
    """An ultra-wideband anchor."""

    _reading = TagRanges

    def __enter__(self) -> Uwb:
        return self
