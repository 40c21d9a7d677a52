# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of a sweep as one table: a row for each job, with the origin of its figures."""

from __future__ import annotations

import json
import os
import re
import shlex
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any, Iterable, Iterator, Mapping, Sequence

from .errors import MOST_FINDINGS, DataError
from .listing import number_or_text, values
from .model import CommandWriter, Job, Sweep

Value = str | float | int | bool | None
LONGEST_LIST = 16  # items of a list of numbers that become columns


@dataclass
class Row:
    """A job and its results. `digest` is that of its room, `history` the commands in its layouts and readings, `seed`
    theirs, `version` that of the tools in its reports."""

    number: int
    name: str
    values: dict[str, str | float | int]
    results: dict[str, Value] = field(default_factory=dict)
    digest: str | None = None
    seed: int | None = None
    version: dict[str, str] = field(default_factory=dict)
    history: list[str] = field(default_factory=list)
    commands: list[str] = field(default_factory=list)


class Gaps:
    """Jobs without results, by the names of what is missing, and files that are damaged."""

    def __init__(self) -> None:
        self.missing: list[str] = []
        self.count = 0
        self.broken: list[str] = []

    def add(self, what: str) -> None:
        self.count += 1
        if len(self.missing) < MOST_FINDINGS - 1:
            self.missing.append(what)

    def explain(self, reasons: Sequence[str]) -> None:
        """Puts reasons before the names of what is missing."""
        self.missing = [*reasons, *self.missing][:MOST_FINDINGS - 1]

    def check(self, jobs: int, partial: bool, listing: str = "commands --missing") -> None:
        """Throws DataError for damaged files; for missing results unless `partial`. `listing` is the command that lists
        them."""
        if self.broken:
            raise DataError(self.broken[:MOST_FINDINGS])
        if self.count and self.count == jobs and not partial:
            raise DataError([*self.missing[:1], "error: no job is done: run those of `ispace-sweep commands`, or name "
                                              "the parts of `ispace-sweep run`"])
        if self.count and not partial:
            raise DataError([*self.missing, f"error: {self.count} of {jobs} jobs are not done: `{listing}` lists "
                                            "them, --partial does without them"])


def from_files(sweep: Sweep, jobs: Iterable[Job], gaps: Gaps) -> Iterator[Row]:
    """The rows of complete jobs, one at a time, from their files."""
    writer = CommandWriter(sweep, None)
    for job in jobs:
        left = sweep.left(job)
        if left:
            gaps.add(f"{next(job.path(s) for s in left[0].files)}: error: not there")
            continue
        row = Row(job.number, job.name, values(sweep, job))
        row.commands = [" ".join(map(shlex.quote, writer.words(job, step))) for step in sweep.steps]
        try:
            for suffix in sweep.suffixes:
                _read_file(row, job.path(suffix), suffix)
        except DataError as error:
            gaps.broken += error.findings
        yield row


def from_lines(found: Iterable[dict[str, Any]], suffixes: Sequence[str], gaps: Gaps,
               wanted: Mapping[str, Value]) -> Iterator[Row]:
    """The rows of jobs that did not fail, from the lines of parts. `wanted` are the choices of --only."""
    for line in found:
        if any(line["values"].get(name) != value for name, value in wanted.items()):
            continue
        if line["status"] != 0:
            gaps.add(f"error: job {line['job']} ({line['name']}) failed with status {line['status']}")
            continue
        row = Row(line["job"], line["name"], line["values"])
        row.commands = [" ".join(map(shlex.quote, words)) for words in line.get("commands", [])]
        texts, reports = line.get("files", {}), line.get("reports", {})
        try:
            for suffix in suffixes:
                if suffix in reports or suffix in texts:
                    _read_content(row, f"job {line['job']}", suffix, reports.get(suffix), texts.get(suffix))
        except DataError as error:
            gaps.broken += error.findings
        yield row


def _read_file(row: Row, path: str, suffix: str) -> None:
    kind = os.path.splitext(suffix)[1] or suffix
    if kind not in (".3dm", ".json", ".jsonl"):
        return
    try:
        with open(path, encoding="utf-8") as file:
            text = file.readline() if kind == ".jsonl" else file.read()
    except OSError as error:
        raise DataError([f"{path}: error: {os.strerror(error.errno or 0)}"]) from None
    except UnicodeDecodeError:
        raise _damaged(path, kind) from None
    _read_content(row, path, suffix, None, text)


def _damaged(path: str, kind: str) -> DataError:
    return DataError([f"{path}: error: not what {kind} files hold; remove it and run the job again"])


def _read_content(row: Row, path: str, suffix: str, report: Any, text: str | None) -> None:
    """Reads the data of a file of the job; skips a file that is neither layout, report nor readings.
    `report` is the content of a report that is parsed already."""
    stem, kind = os.path.splitext(suffix)
    if not kind:
        stem, kind = "", suffix
    prefix = stem.lstrip(".") + "." if stem else ""
    try:
        if kind == ".3dm" and text is not None:
            _read_layout(row, path, prefix, text)
        elif kind == ".json":
            _read_report(row, path, prefix, json.loads(text or "", parse_constant=_no_number)
                         if report is None else report)
        elif kind == ".jsonl" and text is not None:
            _read_header(row, text.partition("\n")[0])
    except (ValueError, RecursionError):
        raise _damaged(path, kind) from None


def _read_layout(row: Row, path: str, prefix: str, text: str) -> None:
    if not text.startswith("#3dm ") or not text.endswith("\n"):  # cut off
        raise ValueError
    lines = text.splitlines()
    for line in lines[1:]:
        if not line.startswith("# "):
            break
        _add_history(row, line[2:])
    for line in lines:
        if line.startswith("result "):
            for key, value in _keys(line):
                row.results[f"{prefix}result.{key}"] = _figure(value)
        elif line.startswith("environment "):
            _add_digest(row, path, dict(_keys(line)).get("digest"))


def _keys(line: str) -> list[tuple[str, str]]:
    words = shlex.split(line, comments=True)[1:]
    return [(key, value) for key, _, value in (word.partition("=") for word in words)]


def _figure(text: str) -> Value:
    """A number, a share of per cent as a fraction, or a word."""
    if re.fullmatch(r"-?[0-9.]+(e-?[0-9]+)?%", text):
        return float(Decimal(text[:-1]) / 100)
    return number_or_text(text)


def _read_report(row: Row, path: str, prefix: str, report: Any) -> None:
    if not isinstance(report, dict):
        raise ValueError
    told = {key: report.pop(key, None) for key in ("schema", "tool", "version", "digest")}
    if isinstance(told["tool"], str) and isinstance(told["version"], str):
        row.version[told["tool"]] = told["version"]
    _add_digest(row, path, told["digest"])
    for key, value in report.items():
        _flatten(row.results, prefix + key, value)


def _flatten(results: dict[str, Value], name: str, value: Any) -> None:
    """Objects as name.key, short lists of single values as name.0, name.1 …; other lists are left out."""
    if isinstance(value, dict):
        for key, inner in value.items():
            _flatten(results, f"{name}.{key}", inner)
    elif isinstance(value, list):
        if len(value) <= LONGEST_LIST and not any(isinstance(inner, (list, dict)) for inner in value):
            for index, inner in enumerate(value):
                results[f"{name}.{index}"] = inner
    else:
        results[name] = value


def _read_header(row: Row, line: str) -> None:
    header = json.loads(line)
    if not isinstance(header, dict):
        raise ValueError
    history = header.get("history")
    for line in history if isinstance(history, list) else []:
        _add_history(row, str(line))
    if isinstance(header.get("seed"), int):
        row.seed = header["seed"]


def _add_history(row: Row, line: str) -> None:
    """Parses a command in a file. Without --seed its seed was 0, as the manual states."""
    row.history.append(line)
    seed = re.search(r"(?:^| )--seed[ =]([0-9]+)(?= |$)", line)
    row.seed = int(seed[1]) if seed else row.seed or 0


def _add_digest(row: Row, path: str, digest: Any) -> None:
    if not isinstance(digest, str) or not re.fullmatch("sha256:[0-9a-f]{64}", digest):
        return
    if row.digest not in (None, digest):
        raise DataError([f"{path}: error: about another room than the job's other files; remove them and run "
                         "the job again"])
    row.digest = digest


def _no_number(word: str) -> float:
    raise ValueError(word)
