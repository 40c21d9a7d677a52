# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of results: the JSON lines of `ispace-sweep run`, schema ispace-results/1, a header and a line for each job."""

from __future__ import annotations

import base64
import collections
import fcntl
import heapq
import json
import os
import re
from dataclasses import dataclass
from typing import Any, BinaryIO, Iterator, Sequence

from .errors import MOST_FINDINGS, DataError
from .listing import dump, values
from .model import Job, Sweep
from .workers import Outcome

SCHEMA = "ispace-results/1"
LONGEST_HEADER = 1 << 20
HEAD = re.compile(rb'\{"job":(?P<job>[0-9]+),"name":(?P<name>"(?:[^"\\]|\\.)*"),"status":(?P<status>-?[0-9]+),')  # of a line


@dataclass(frozen=True)
class Share:
    """Which of a sweep's jobs a part holds: the part `index` of `count`, and the rules of --only."""

    index: int = 1
    count: int = 1
    only: tuple[str, ...] = ()


def header(sweep: Sweep, share: Share, jobs: int, first: int, version: str) -> str:
    """The first line of a part. A part that begins with another line is not of the same run."""
    return dump({"schema": SCHEMA, "tool": "ispace-sweep", "version": version,
                 "sweep": os.path.basename(sweep.file), "digest": sweep.digest,
                 "axes": [axis.name for axis in sweep.axes], "suffixes": list(sweep.suffixes), "shard": f"{share.index}/{share.count}",
                 "only": list(share.only), "first": first, "jobs": jobs})


def line(sweep: Sweep, job: Job, outcome: Outcome) -> str:
    """The line of a job. Layouts and other texts stand in it as they are, reports as JSON."""
    head = dump({"job": job.number, "name": job.name, "status": outcome.status, "values": values(sweep, job),
                 "commands": outcome.commands})
    reports, texts, binary = [], {}, {}
    for suffix, content in outcome.files.items():
        report = _one_line(content) if suffix.endswith(".json") else None
        if report is not None:
            reports.append(f"{dump(suffix)}:{report}")
            continue
        try:
            texts[suffix] = content.decode()
        except UnicodeDecodeError:
            binary[suffix] = base64.b64encode(content).decode()
    more = dump(({"base64": binary} if binary else {}) | ({"messages": outcome.messages} if outcome.messages else {}))
    return (f'{head[:-1]},"reports":{{{",".join(reports)}}},"files":{dump(texts)}'
            + (f",{more[1:-1]}" if len(more) > 2 else "") + "}")


def _one_line(content: bytes) -> str | None:
    """A JSON document in one line, its numbers as they were written; None if it is none."""
    try:
        text = content.decode()
        json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        return None
    return " ".join(text.split("\n")).strip() if "\n" in text.strip() else text.strip()


def _refuse(word: str) -> float:
    raise ValueError(word)


@dataclass
class Part:
    """A file of results. Lines are read one at a time; a last one without its end was cut off by a kill, and is left
    out. `count` is the number of lines that were read, `failed` that of failed jobs among them."""

    path: str
    head: dict[str, Any]
    count: int = 0
    failed: int = 0

    def lines(self, briefly: bool = False) -> Iterator[dict[str, Any]]:
        """All lines; with `briefly` their `job` and `status` alone, which are not parsed further."""
        self.count = self.failed = 0
        with _open(self.path) as file:
            file.readline(LONGEST_HEADER)
            for number, row in enumerate(file, 2):
                if not row.endswith(b"\n"):
                    return
                begin = HEAD.match(row) if briefly else None
                if begin:
                    found: dict[str, Any] = {"job": int(begin["job"]), "status": int(begin["status"])}
                else:
                    found = parse_line(row, self.path, number)
                self.count += 1
                self.failed += found["status"] != 0
                yield found

    @property
    def jobs(self) -> int:
        """The number of its share's jobs, those without a line included."""
        return int(self.head.get("jobs") or 0)

    @property
    def share(self) -> Share:
        index, _, count = str(self.head.get("shard")).partition("/")
        numbers = (int(index), int(count)) if index.isdigit() and count.isdigit() else (1, 1)
        return Share(*numbers, tuple(self.head.get("only") or ()))

    def is_locked(self) -> bool | None:
        """Whether a run is writing it; unknown on a file system without locks."""
        with _open(self.path) as file:
            try:
                fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
            except BlockingIOError:
                return True
            except OSError:
                return None
        return False


def parse_line(row: bytes, path: str, number: int) -> dict[str, Any]:
    """Throws DataError with the number of the line if it is no job's."""
    try:
        found: dict[str, Any] = json.loads(row.decode("utf-8", "surrogateescape"))
        found["job"], found["status"], found["values"]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise DataError([f"{path}:{number}:1: error: no line of {SCHEMA}"]) from None
    return found


def read_part(path: str) -> Part:
    """Opens a file of results. Throws DataError for another file."""
    with _open(path) as file:
        row = file.readline(LONGEST_HEADER)
    try:
        head = json.loads(row)
        if head["schema"] != SCHEMA:
            raise ValueError
    except (ValueError, KeyError, TypeError, RecursionError):
        raise DataError([f"{path}:1:1: error: no results of `ispace-sweep run`: they begin with a line of "
                         f"{SCHEMA}"]) from None
    return Part(path, head)


def _open(path: str) -> BinaryIO:
    try:
        return open(path, "rb")
    except OSError as error:
        raise DataError([f"{path}: error: {os.strerror(error.errno or 0)}"]) from None


def is_part(path: str) -> bool:
    """Whether a file begins as results do."""
    try:
        with open(path, "rb") as file:
            return file.read(64).startswith(b'{"schema":"' + SCHEMA.encode() + b'"')
    except OSError:
        return False


def in_order(paths: Sequence[str]) -> list[Part]:
    """The parts of one sweep by their first jobs. Throws DataError for parts of several sweeps."""
    parts = sorted((read_part(path) for path in paths), key=lambda part: int(part.head.get("first") or 0))
    wrong = [f"{part.path}: error: of another sweep than {parts[0].path} (the sweeps' files differ)"
             for part in parts if part.head.get("digest") != parts[0].head.get("digest")]
    if wrong:
        raise DataError(wrong[:MOST_FINDINGS])
    return parts


def absent(parts: Sequence[Part]) -> list[Share]:
    """The shares of their run that these parts lack; an empty list for parts of several runs."""
    shares = [part.share for part in parts]
    if len({(share.count, share.only) for share in shares}) != 1:
        return []
    given = {share.index for share in shares}
    return [Share(index, shares[0].count, shares[0].only) for index in range(1, shares[0].count + 1)
            if index not in given]


class DoneJobs:
    """The jobs that have a line in these parts and did not fail."""

    def __init__(self, found: Sequence[Part]) -> None:
        self._numbers = (row["job"] for row in rows(found, briefly=True) if row["status"] == 0)
        self._next: int | None = next(self._numbers, None)

    def has(self, number: int) -> bool:
        """To be asked in the order of jobs."""
        while self._next is not None and self._next < number:
            self._next = next(self._numbers, None)
        return self._next == number


def extent(part: Part) -> str:
    """How far a part is whose lines were read."""
    share = part.share
    which = f" of shard {share.index}/{share.count}" if share.count > 1 else ""
    return f"{part.count} of {part.jobs} jobs{which}"


def shard_list(shares: Sequence[Share], most: int = 5) -> str:
    """The first of them, and the number of the others."""
    told = ", ".join(f"{share.index}/{share.count}" for share in shares[:most])
    more = f" and {len(shares) - most} more" if len(shares) > most else ""
    return f"shard{'s' if len(shares) > 1 else ''} {told}{more}"


def rows(parts: Sequence[Part], briefly: bool = False) -> Iterator[dict[str, Any]]:
    """The lines of all parts in the order of jobs, or `briefly` their `job` and `status` alone. Throws DataError for a
    job that is in two parts."""
    last, where = 0, ""
    waiting = collections.deque(parts)  # by their first jobs; opened when one is due
    due: list[tuple[int, int, Part, Iterator[dict[str, Any]], dict[str, Any]]] = []

    def push(order: int, part: Part, lines: Iterator[dict[str, Any]]) -> None:
        row = next(lines, None)
        if row is not None:
            heapq.heappush(due, (row["job"], order, part, lines, row))

    while waiting or due:
        while waiting and (not due or int(waiting[0].head.get("first") or 0) <= due[0][0]):
            part = waiting.popleft()
            push(len(waiting), part, part.lines(briefly))
        if not due:
            break
        job, order, part, lines, row = heapq.heappop(due)
        if job <= last:
            raise DataError([f"{part.path}: error: job {job} comes after job {last} of {where}: give each part once"])
        last, where = job, part.path
        yield row
        push(order, part, lines)
