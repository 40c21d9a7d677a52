# SPDX-License-Identifier: GPL-3.0-or-later
"""The choices on an axis. Ranges of numbers stay ranges, so that a million seeds take no memory."""

from __future__ import annotations

import bisect
import os
import re
from dataclasses import dataclass
from functools import cached_property
from typing import Iterator, Sequence


@dataclass(frozen=True)
class Choice:
    """One value of an axis: its part in the names of files, its text in the table, and the words of the command line
    that replace it."""

    part: str
    text: str
    words: tuple[str, ...]


def part_of(text: str, axis: str) -> str:
    """Converts a value to its part in the names of files: letters, digits, `.`, `+` and `-`. Of a path it is the base
    name without suffix; numbers get the name of their axis: count3."""
    if re.fullmatch(r"[+-]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][+-]?[0-9]+)?", text):
        return _clean(axis) + text
    return _clean(re.sub(r"(?<=.)[.]([A-Za-z][A-Za-z0-9]*|3dm)$", "", os.path.basename(text.rstrip("/"))))


def _clean(text: str) -> str:
    return re.sub(r"-{2,}", "-", re.sub(r"[^A-Za-z0-9.+-]", "-", text)).strip("-.")


@dataclass(frozen=True)
class Choices:
    """Choices in their order, of which each piece is one choice or a range of numbers of the axis `name`."""

    name: str
    pieces: tuple[Choice | range, ...]

    def __len__(self) -> int:
        return self._begins[-1]

    def __getitem__(self, index: int) -> Choice:
        place = bisect.bisect_right(self._begins, index) - 1
        piece = self.pieces[place]
        return piece if isinstance(piece, Choice) else self._numeral(piece[index - self._begins[place]])

    def __iter__(self) -> Iterator[Choice]:
        for piece in self.pieces:
            if isinstance(piece, Choice):
                yield piece
            else:
                yield from map(self._numeral, piece)

    @cached_property
    def _begins(self) -> list[int]:
        """The index at which each piece begins, and the number of choices."""
        begins = [0]
        for piece in self.pieces:
            begins.append(begins[-1] + (1 if isinstance(piece, Choice) else len(piece)))
        return begins

    def _numeral(self, number: int) -> Choice:
        text = str(number)
        return Choice(part_of(text, self.name), text, (text,))

    @cached_property
    def _singles(self) -> dict[str, int]:
        return {piece.text: begin for piece, begin in zip(self.pieces, self._begins) if isinstance(piece, Choice)}

    def index_of(self, text: str) -> int | None:
        """The index of the choice with this text."""
        if text in self._singles:
            return self._singles[text]
        if re.fullmatch(r"0|-?[1-9][0-9]{0,9}", text):
            for piece, begin in zip(self.pieces, self._begins):
                if isinstance(piece, range) and int(text) in piece:
                    return begin + int(text) - piece.start
        return None

    def indices_of(self, numbers: range) -> range | None:
        """The indices of these numbers if one piece holds them all."""
        for piece, begin in zip(self.pieces, self._begins):
            if isinstance(piece, range) and numbers[0] in piece and numbers[-1] in piece:
                return range(begin + numbers[0] - piece.start, begin + numbers[-1] - piece.start + 1)
        return None

    @property
    def longest_part(self) -> int:
        """The characters of the longest part of a name."""
        return max((len(choice.part) for choice in self._ends()), default=0)

    def _ends(self) -> Iterator[Choice]:
        """All choices that are no numbers of a range, and the ends of each range, which are its longest."""
        for piece in self.pieces:
            if isinstance(piece, Choice):
                yield piece
            else:
                yield self._numeral(piece[0])
                yield self._numeral(piece[-1])

    @property
    def are_words(self) -> bool:
        """Whether each is one word."""
        return all(len(choice.words) == 1 for choice in self._ends())

    def sample(self, most: int = 50) -> Sequence[str]:
        """Texts for a hint."""
        return [choice.text for choice, _ in zip(self._ends(), range(most))]
