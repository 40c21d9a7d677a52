# SPDX-License-Identifier: GPL-3.0-or-later
"""YAML with positions: a file as PyYAML's nodes, and findings in it in the form of the other tools."""

from __future__ import annotations

import os
import sys
from typing import Any, Iterable

from .errors import MOST_FINDINGS, DataError, did_you_mean

try:
    import yaml
except ModuleNotFoundError:
    raise DataError(["error: no PyYAML here: install Debian's python3-yaml"]) from None

MOST_BYTES = 4 << 20
DEEPEST = 8  # far more than a sweep needs


class Tree:
    """A file's root node. Findings are collected, and thrown together by `check`."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.bytes = _read(file)
        self._findings: list[str] = []
        try:
            text = self.bytes.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = self.bytes.count(b"\n", 0, error.start) + 1
            raise DataError([f"{file}:{line}: error: not UTF-8"]) from None
        # libyaml's parser is ten times as fast, where PyYAML was built with it.
        loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
        try:
            self._check_depth(yaml.parse(text, Loader=loader))
            self.root: Any = yaml.compose(text, Loader=loader)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            place = f":{mark.line + 1}:{mark.column + 1}" if mark else ""
            raise DataError([f"{file}{place}: error: {error.problem or error.context}"]) from None
        except (yaml.YAMLError, ValueError) as error:
            raise DataError([f"{file}: error: {str(error).splitlines()[0]}"]) from None
        if self.root is None:
            raise DataError([f"{file}: error: empty, where a sweep needs `run` and `axes`"])

    def _check_depth(self, events: Iterable[Any]) -> None:
        depth = 0
        for event in events:
            if isinstance(event, yaml.CollectionStartEvent):
                depth += 1
                if depth > DEEPEST:
                    self.find(event, f"more than {DEEPEST} levels of lists and maps")
                    self.check()
            elif isinstance(event, yaml.CollectionEndEvent):
                depth -= 1

    # ---- Findings

    def find(self, node: Any, message: str) -> None:
        mark = node.start_mark
        self._findings.append(f"{self.file}:{mark.line + 1}:{mark.column + 1}: error: {message}")
        if len(self._findings) == MOST_FINDINGS:
            self.check()

    def check(self) -> None:
        """Throws the findings."""
        if self._findings:
            raise DataError(self._findings)

    # ---- Nodes

    def entries(self, node: Any, what: str, known: Iterable[str] = ()) -> list[tuple[str, Any, Any]]:
        """Returns (key, its node, node of its value) of a map, in order; adds findings if it is no map, or a key is
        doubled or not `known`."""
        if not isinstance(node, yaml.MappingNode):
            self.find(node, f"{what} is a map, `key: value`, not {_kind(node)}")
            return []
        found: dict[str, tuple[str, Any, Any]] = {}
        for key_node, value in node.value:
            key = self.scalar(key_node, "a key")
            if key is None:
                continue
            if key in found:
                self.find(key_node, f"`{key}` is there twice")
            elif known and key not in known:
                self.find(key_node, f"unknown key `{key}`{did_you_mean(key, known)}")
            else:
                found[key] = (key, key_node, value)
        return list(found.values())

    def items(self, node: Any) -> list[Any]:
        """The items of a list; of anything else, that."""
        return list(node.value) if isinstance(node, yaml.SequenceNode) else [node]

    def scalar(self, node: Any, what: str) -> str | None:
        """Returns a scalar's text; None, with a finding, for another node."""
        if not isinstance(node, yaml.ScalarNode):
            self.find(node, f"{what} is a single value, not {_kind(node)}")
            return None
        if any(ord(letter) < 32 or ord(letter) == 127 for letter in node.value):
            self.find(node, f"{what} holds a line break or another control character")
            return None
        return str(node.value)

    def is_map(self, node: Any) -> bool:
        return isinstance(node, yaml.MappingNode)

    def is_list(self, node: Any) -> bool:
        return isinstance(node, yaml.SequenceNode)


def _kind(node: Any) -> str:
    if isinstance(node, yaml.MappingNode):
        return "a map"
    if isinstance(node, yaml.SequenceNode):
        return "a list"
    return f"`{node.value[:40]}`"


def _read(file: str) -> bytes:
    try:
        if file == "-":
            data = sys.stdin.buffer.read(MOST_BYTES + 1)
        else:
            with open(file, "rb") as stream:
                data = stream.read(MOST_BYTES + 1)
    except OSError as error:
        raise DataError([f"{file}: error: {os.strerror(error.errno or 0)}"]) from None
    if len(data) > MOST_BYTES:
        raise DataError([f"{file}: error: more than {MOST_BYTES >> 20} MB"])
    return data
