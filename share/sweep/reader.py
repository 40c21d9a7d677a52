# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a sweep's file."""

from __future__ import annotations

import glob
import hashlib
import os
import re
import shlex
from typing import Any, Iterable, Mapping

from .errors import did_you_mean
from .choices import Choice, Choices, part_of
from .model import OUT, Axis, Step, Sweep, Word
from .tree import Tree

KEYS = ("run", "axes", "exclude", "folder", "accept")
MOST_JOBS = 100_000_000
LONGEST_NAME = 200  # characters; with a suffix it must remain a file's name
# Columns of the table that no axis may be called.
RESERVED = (OUT, "job", "name", "digest", "version", "history", "commands")
OPERATORS = ("|", "||", "&&", ";", "&", "<", "<<", ">", ">>", "2>", "2>&1")


def read_sweep(file: str) -> Sweep:
    """The sweep of a file, `-` is standard input. Throws DataError with all that is wrong."""
    return _Reader(Tree(file)).read()


class _Reader:
    def __init__(self, tree: Tree) -> None:
        self.tree = tree

    def read(self) -> Sweep:
        tree = self.tree
        nodes = {key: node for key, _, node in tree.entries(tree.root, "a sweep", KEYS)}
        tree.check()
        for key in ("run", "axes"):
            if key not in nodes:
                tree.find(tree.root, f"no `{key}` in this sweep")
        tree.check()
        axes = self._axes(nodes["axes"])
        tree.check()  # placeholders that are unknown for want of an axis are not worth telling
        steps = self._steps(nodes["run"], {axis.name: axis for axis in axes})
        folder = self._folder(nodes["folder"]) if "folder" in nodes else "results"
        excluded = self._excluded(nodes["exclude"], axes) if "exclude" in nodes else []
        accept = self._accept(nodes["accept"]) if "accept" in nodes else []
        self._bounds(nodes["axes"], axes)
        tree.check()
        digest = "sha256:" + hashlib.sha256(tree.bytes).hexdigest()
        return Sweep(tree.file, digest, tuple(steps), tuple(axes), folder, tuple(excluded), tuple(accept))

    # ---- Axes

    def _axes(self, node: Any) -> list[Axis]:
        axes = []
        for name, key_node, value in self.tree.entries(node, "`axes`"):
            if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
                self.tree.find(key_node, f"`{name}` is no name for an axis: small letters, digits and _")
            elif name in RESERVED:
                self.tree.find(key_node, f"an axis cannot be called `{name}`: the table has a column of this name")
            else:
                axes.append(self._axis(name, key_node, value))
        return axes

    def _axis(self, name: str, key_node: Any, node: Any) -> Axis:
        files = False
        pieces: list[tuple[Any, Choice | range]]
        if self.tree.is_map(node):
            entries = self.tree.entries(node, f"`{name}`")
            files = [key for key, _, _ in entries] == ["files"]
            if files:
                pieces = list(self._files(name, entries[0][2]))
            else:
                pieces = [(key_at, self._named(key, key_at, value)) for key, key_at, value in entries]
        else:
            pieces = list(self._values(name, node))
        if not pieces:
            self.tree.find(key_node, f"axis `{name}` has no choices")
        self._distinct(name, pieces)
        return Axis(name, Choices(name, tuple(piece for _, piece in pieces)), files)

    def _values(self, name: str, node: Any) -> Iterable[tuple[Any, Choice | range]]:
        """Parses values, each one word; 1..8 are the numbers from 1 to 8."""
        for item in self.tree.items(node):
            text = self.tree.scalar(item, f"a choice of `{name}`")
            if text is None:
                continue
            span = re.fullmatch(r"(-?[0-9]{1,9})[.][.](-?[0-9]{1,9})", text)
            if not span:
                yield item, Choice(part_of(text, name), text, (text,))
                continue
            first, last = int(span[1]), int(span[2])
            if last < first or last - first >= MOST_JOBS:
                self.tree.find(item, f"`{text}` is no range of 1 to {MOST_JOBS} numbers")
                continue
            yield item, range(first, last + 1)

    def _named(self, key: str, key_node: Any, node: Any) -> Choice:
        """A choice with a name: any number of words, as the shell would split them."""
        if self.tree.is_list(node):
            texts = [self.tree.scalar(item, "a word") for item in self.tree.items(node)]
            words = tuple(text for text in texts if text is not None)
        else:
            words = tuple(self._split(node, f"`{key}`"))
        if key != part_of(key, "") and not re.fullmatch(r"[A-Za-z0-9.+-]+", key):
            self.tree.find(key_node, f"`{key}` is no name for a choice: letters, digits, `.`, `+` and `-`")
        return Choice(key, key, words)

    def _files(self, name: str, node: Any) -> Iterable[tuple[Any, Choice]]:
        """Files by name or by pattern, those of a pattern in the order of their bytes."""
        for item in self.tree.items(node):
            text = self.tree.scalar(item, f"a file of `{name}`")
            if text is None:
                continue
            found = sorted(glob.glob(text), key=os.fsencode) if glob.has_magic(text) else [text]
            if not found:
                self.tree.find(item, f"no file matches `{text}` here in {os.getcwd()}")
            for path in found:
                if not os.path.exists(path):
                    self.tree.find(item, f"no file `{path}` here in {os.getcwd()}")
                elif any(ord(letter) < 32 for letter in path):
                    self.tree.find(item, f"the name of {path!r} holds a control character")
                else:
                    # No program may take the name of a file for an option.
                    word = f"./{path}" if path.startswith("-") else path
                    yield item, Choice(part_of(path, name), path, (word,))

    def _distinct(self, name: str, pieces: list[tuple[Any, Choice | range]]) -> None:
        seen: dict[str, str] = {}
        spans: list[range] = []
        for node, piece in pieces:
            if isinstance(piece, range):
                texts = (text for text in seen.values() if re.fullmatch("0|-?[1-9][0-9]*", text))
                twice = [number for number in map(int, texts) if number in piece]
                twice += [max(piece[0], span[0]) for span in spans if piece[0] <= span[-1] and span[0] <= piece[-1]]
                if twice:
                    self.tree.find(node, f"`{min(twice)}` is twice among the choices of `{name}`")
                spans.append(piece)
                continue
            choice = piece
            is_number = re.fullmatch("0|-?[1-9][0-9]*", choice.text)
            if not choice.part:
                self.tree.find(node, f"`{choice.text}` leaves nothing for the names of files: give it a name, "
                                     f"`plain: '{choice.text}'` in a map instead of a list")
            elif is_number and any(int(choice.text) in span for span in spans):
                self.tree.find(node, f"`{choice.text}` is twice among the choices of `{name}`")
            elif choice.part not in seen:
                seen[choice.part] = choice.text
            elif seen[choice.part] == choice.text:
                self.tree.find(node, f"`{choice.text}` is twice among the choices of `{name}`")
            else:
                self.tree.find(node, f"`{seen[choice.part]}` and `{choice.text}` would both be `{choice.part}` in "
                                     "the names of files: make the axis a map that names its choices")

    def _bounds(self, node: Any, axes: list[Axis]) -> None:
        jobs = 1
        for axis in axes:
            jobs *= len(axis.choices)
        if jobs > MOST_JOBS:
            self.tree.find(node, f"{jobs} jobs, of which a sweep may have {MOST_JOBS}")
        longest = sum(axis.choices.longest_part + 1 for axis in axes)
        if longest > LONGEST_NAME:
            self.tree.find(node, f"names of files would have {longest} characters: give long values short names "
                                 "in a map")

    # ---- Steps

    def _steps(self, node: Any, axes: Mapping[str, Axis]) -> list[Step]:
        steps: list[Step] = []
        made: set[str] = set()
        used: set[str] = set()
        for item in self.tree.items(node):
            words = [self._word(item, text, axes) for text in self._split(item, "a step")]
            if not words:
                self.tree.find(item, "a step needs a program")
                continue
            words, redirect = self._redirect(item, words)
            named = [word.suffix for word in words if word.suffix is not None]
            if redirect is not None:
                named.append(redirect)
            makes = tuple(dict.fromkeys(suffix for suffix in named if suffix not in made))
            step = Step(tuple(words), makes, tuple(s for s in named if s in made), redirect)
            if not step.files:
                self.tree.find(item, "this step leaves no file of its own that tells when it is done: name one, "
                                     f"as in `-o {{{OUT}}}.3dm`")
            made.update(makes)
            used.update(name for word in words for name in word.placeholders)
            steps.append(step)
        for name in axes:
            if steps and name not in used:
                self.tree.find(node, f"no step uses {{{name}}}: its jobs would all be the same")
        return steps

    def _split(self, node: Any, what: str) -> list[str]:
        text = self.tree.scalar(node, what)
        if text is None:
            return []
        try:
            return shlex.split(text)
        except ValueError:
            self.tree.find(node, f"{what} has a quote that is not closed")
            return []

    def _word(self, node: Any, text: str, axes: Mapping[str, Axis]) -> Word:
        """`--seed={seed}` as its parts; {{ and }} are braces."""
        parts = [""]
        for piece in re.split(r"(\{\{|\}\}|\{[^{}]*\}|[{}])", text):
            if piece in ("{{", "}}"):
                parts[-1] += piece[0]
            elif piece in ("{", "}"):
                self.tree.find(node, f"`{piece}` in `{text}`: {piece * 2} is a brace, {{name}} a choice")
            elif piece.startswith("{"):
                self._placeholder(node, piece[1:-1], text, axes)
                parts += [piece[1:-1], ""]
            else:
                parts[-1] += piece
        if OUT in parts[1::2] and not re.fullmatch(r"([.][A-Za-z0-9._+-]*)?", parts[-1]):
            self.tree.find(node, f"`{text}`: after {{{OUT}}} there may be a suffix such as `.3dm`, and nothing else")
        elif OUT in parts[1:-2:2]:
            self.tree.find(node, f"`{text}` names more than one file")
        return Word(tuple(parts))

    def _placeholder(self, node: Any, name: str, text: str, axes: Mapping[str, Axis]) -> None:
        known = [*axes, OUT]
        if name not in known:
            self.tree.find(node, f"unknown axis {{{name}}}{did_you_mean(name, known)}")
        elif name != OUT and text != f"{{{name}}}" and not axes[name].choices.are_words:
            self.tree.find(node, f"`{text}`: a choice of `{name}` is not one word: {{{name}}} must stand alone")

    def _redirect(self, node: Any, words: list[Word]) -> tuple[list[Word], str | None]:
        """Takes `> {out}.json` from the end of a step."""
        redirect = None
        if len(words) > 2 and words[-2].parts == (">",) and words[-1].parts[:2] == ("", OUT) and words[-1].suffix:
            redirect = words[-1].suffix
            words = words[:-2]
        for word in words:
            if word.parts[0] in OPERATORS and len(word.parts) == 1:
                self.tree.find(node, f"`{word.parts[0]}`: a step is one program without a shell; a list has several "
                                     f"steps, and `> {{{OUT}}}.json` at its end keeps what a step prints")
        return words, redirect

    # ---- The rest

    def _folder(self, node: Any) -> str:
        text = self.tree.scalar(node, "`folder`")
        if text is None:
            return "."
        if not re.fullmatch(r"[A-Za-z0-9.+_/-]+", text) or text.startswith("-"):
            self.tree.find(node, f"`{text}` is no folder that every runner can name: letters, digits and . + _ - /")
        return os.path.normpath(text)

    def _accept(self, node: Any) -> list[int]:
        statuses = []
        for item in self.tree.items(node):
            text = self.tree.scalar(item, "a status") or ""
            if not re.fullmatch(r"[0-9]{1,3}", text) or not 1 <= int(text) <= 255:
                self.tree.find(item, f"`{text}` is no exit status from 1 to 255")
            else:
                statuses.append(int(text))
        return statuses

    def _excluded(self, node: Any, axes: list[Axis]) -> list[Mapping[str, tuple[range, ...]]]:
        by_name = {axis.name: axis for axis in axes}
        rules: list[Mapping[str, tuple[range, ...]]] = []
        for item in self.tree.items(node):
            rule: dict[str, tuple[range, ...]] = {}
            for name, key_node, value in self.tree.entries(item, "an item of `exclude`"):
                if name not in by_name:
                    self.tree.find(key_node, f"unknown axis `{name}`{did_you_mean(name, by_name)}")
                    continue
                rule[name] = tuple(self._indices(by_name[name], value))
            if rule:
                rules.append(rule)
        return rules

    def _indices(self, axis: Axis, node: Any) -> Iterable[range]:
        """The indices of choices."""
        for chosen, piece in self._values(axis.name, node):
            if isinstance(piece, range) and (indices := axis.choices.indices_of(piece)) is not None:
                yield indices
                continue
            texts = [piece.text] if isinstance(piece, Choice) else map(str, piece)
            for text in texts:
                index = axis.choices.index_of(text)
                if index is None:
                    self.tree.find(chosen, f"`{text}` is no choice of `{axis.name}`"
                                           f"{did_you_mean(text, axis.choices.sample())}")
                    break
                yield range(index, index + 1)
