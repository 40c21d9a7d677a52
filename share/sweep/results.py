# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of a sweep as one table: a row for each job, with the origin of its figures."""

from __future__ import annotations

import json
import os
import re
import shlex
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Any, Iterable

from .errors import MOST_FINDINGS, DataError
from .listing import number_or_text, values
from .model import CommandWriter, Job, Sweep

Value = str | float | int | bool | None
LONGEST_LIST = 16  # items of a list of numbers that become columns


@dataclass
class Row:
    """A job and its results. `digest` is that of its room, `history` the commands in its layouts and readings, `seed`
    theirs, `version` that of the tools in its reports."""

    job: Job
    values: dict[str, str | float | int]
    results: dict[str, Value] = field(default_factory=dict)
    digest: str | None = None
    seed: int | None = None
    version: dict[str, str] = field(default_factory=dict)
    history: list[str] = field(default_factory=list)
    commands: list[str] = field(default_factory=list)


def join(sweep: Sweep, jobs: Iterable[Job], partial: bool) -> list[Row]:
    """Returns the rows of complete jobs. Throws DataError that names the others, unless `partial`, and files of
    another type than their suffix."""
    writer = CommandWriter(sweep, None)
    rows: list[Row] = []
    missing: list[str] = []
    broken: list[str] = []
    for job in jobs:
        left = sweep.left(job)
        if left:
            missing.append(next(job.path(s) for s in left[0].files))
            continue
        row = Row(job, values(sweep, job))
        row.commands = [" ".join(map(shlex.quote, writer.words(job, step))) for step in sweep.steps]
        try:
            for suffix in sweep.suffixes:
                _read(row, job.path(suffix), suffix)
        except DataError as error:
            broken += error.findings
        rows.append(row)
    if broken:
        raise DataError(broken[:MOST_FINDINGS])
    if missing and not partial:
        raise DataError(_missing(missing, len(missing) + len(rows)))
    return rows


def _missing(files: list[str], jobs: int) -> list[str]:
    told = [f"{file}: error: not there" for file in files[:MOST_FINDINGS - 1]]
    return [*told, f"error: {len(files)} of {jobs} jobs are not done: `commands --missing` lists them, --partial "
                   "does without them"]


def _read(row: Row, path: str, suffix: str) -> None:
    """Reads the data of a file of the job; skips a file that is neither layout, report nor readings."""
    stem, kind = os.path.splitext(suffix)
    if not kind:
        stem, kind = "", suffix
    prefix = stem.lstrip(".") + "." if stem else ""
    try:
        if kind == ".3dm":
            _read_layout(row, path, prefix)
        elif kind == ".json":
            _read_report(row, path, prefix)
        elif kind == ".jsonl":
            _read_header(row, path)
    except OSError as error:
        raise DataError([f"{path}: error: {os.strerror(error.errno or 0)}"]) from None
    except (UnicodeDecodeError, ValueError, RecursionError):
        raise DataError([f"{path}: error: not what {kind} files hold; remove it and run the job again"]) from None


def _read_layout(row: Row, path: str, prefix: str) -> None:
    with open(path, encoding="utf-8") as file:
        text = file.read()
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


def _read_report(row: Row, path: str, prefix: str) -> None:
    with open(path, encoding="utf-8") as file:
        report = json.load(file, parse_constant=_no_number)
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


def _read_header(row: Row, path: str) -> None:
    with open(path, encoding="utf-8") as file:
        header = json.loads(file.readline())
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
