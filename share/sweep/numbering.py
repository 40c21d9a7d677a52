# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers combinations of indices that no rule excludes, without listing those before."""

from __future__ import annotations

from typing import Iterator, Mapping, Sequence

Rule = Mapping[int, tuple[range, ...]]  # from axes to indices; it excludes what lies in all of them


class Numbering:
    """The combinations of one index below each of `sizes`, in lexicographic order, without those that a rule excludes.

    A state is an axis and the rules that the indices on the axes before fulfil. Combinations behind a state are counted
    once; an axis is divided into segments whose indices lead to the same state. Hence the n-th combination takes time
    in proportion to the axes and segments, not to n."""

    def __init__(self, sizes: Sequence[int], rules: Sequence[Rule]) -> None:
        self._sizes = list(sizes)
        self._rules = [rule for rule in rules if rule]
        self._last = [max(rule) for rule in self._rules]
        self._segments: dict[tuple[int, frozenset[int]], list[tuple[int, int, frozenset[int]]]] = {}
        self._counts: dict[tuple[int, frozenset[int]], int] = {}
        self._all = frozenset(range(len(self._rules)))
        self.count = self._behind(0, self._all)

    def indices_of(self, place: int) -> tuple[int, ...]:
        """The combination at a place, from 0."""
        return next(self.walk(place))

    def place_of(self, indices: Sequence[int]) -> int:
        """The place of a combination that no rule excludes."""
        place, fulfilled = 0, self._all
        for axis, index in enumerate(indices):
            for begin, end, state in self._parts(axis, fulfilled):
                each = self._behind(axis + 1, state)
                if index < end:
                    place += (index - begin) * each
                    fulfilled = state
                    break
                place += (end - begin) * each
        return place

    def walk(self, place: int = 0) -> Iterator[tuple[int, ...]]:
        """The combinations from a place on."""
        return self._walk(0, self._all, place)

    def _walk(self, axis: int, fulfilled: frozenset[int], skip: int) -> Iterator[tuple[int, ...]]:
        if axis == len(self._sizes):
            yield ()
            return
        for begin, end, state in self._parts(axis, fulfilled):
            each = self._behind(axis + 1, state)
            if skip >= each * (end - begin):
                skip -= each * (end - begin)
                continue
            first = begin + skip // each
            skip %= each
            for index in range(first, end):
                for rest in self._walk(axis + 1, state, skip):
                    yield (index, *rest)
                skip = 0

    def _behind(self, axis: int, fulfilled: frozenset[int]) -> int:
        """The combinations of indices on this axis and those after it."""
        if axis == len(self._sizes):
            return 1
        key = axis, fulfilled
        if key not in self._counts:
            self._counts[key] = sum((end - begin) * self._behind(axis + 1, state)
                                    for begin, end, state in self._parts(axis, fulfilled))
        return self._counts[key]

    def _parts(self, axis: int, fulfilled: frozenset[int]) -> list[tuple[int, int, frozenset[int]]]:
        """Ranges of the axis with the rules that remain fulfilled, without ranges that a rule excludes."""
        key = axis, fulfilled
        if key not in self._segments:
            cuts = {0, self._sizes[axis]}
            for rule in fulfilled:
                for span in self._rules[rule].get(axis, ()):
                    cuts |= {span.start, span.stop}
            edges = sorted(cut for cut in cuts if 0 <= cut <= self._sizes[axis])
            parts = []
            for begin, end in zip(edges, edges[1:]):
                state = frozenset(rule for rule in fulfilled
                                  if axis not in self._rules[rule]
                                  or any(begin in span for span in self._rules[rule][axis]))
                if not any(self._last[rule] == axis for rule in state):
                    parts.append((begin, end, state))
            self._segments[key] = parts
        return self._segments[key]
