# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the jobs of a sweep, and writes their results as lines of one file."""

from __future__ import annotations

import collections
import concurrent.futures
import contextlib
import fcntl
import json
import os
import queue
import shlex
import time
from dataclasses import dataclass
from typing import Any, BinaryIO, Callable, Iterator, Sequence

from . import parts
from .errors import DataError, UsageError
from .listing import dump, values
from .model import CommandWriter, Job, Jobs, Sweep
from .workers import Outcome, Worker

STATUS = ".status"  # the suffix of the small file beside a part that tells how far it is
STATUS_EVERY = 2.0  # seconds


class Tally:
    """How far a run is, for the file beside its part: the time it began, and what it has done since."""

    def __init__(self, path: str | None, jobs: int) -> None:
        self._path = path + STATUS if path else None
        self.jobs = jobs
        self.done = self.failed = 0
        self._before = 0  # done in earlier runs, or copied from their parts
        self._begin = time.time()
        self._told = 0.0

    def resume(self, done: int, failed: int) -> None:
        self.done = self._before = done
        self.failed = failed

    def take(self, status: int, is_copied: bool = False) -> None:
        self.done += 1
        self._before += is_copied
        self.failed += status != 0
        if time.monotonic() >= self._told + STATUS_EVERY:
            self.tell()

    def tell(self, has_ended: bool = False) -> None:
        """Replaces the file, whole or not at all. A status that cannot be written stops no job."""
        self._told = time.monotonic()
        if self._path is None:
            return
        now = time.time()
        text = dump({"schema": "ispace-run-status/1", "jobs": self.jobs, "done": self.done, "failed": self.failed,
                     "begin": round(self._begin, 3), "now": round(now, 3), "fresh": self.done - self._before,
                     "ended": has_ended, "host": os.uname().nodename})
        try:
            with open(self._path + ".tmp", "w", encoding="utf-8") as file:
                file.write(text + "\n")
            os.replace(self._path + ".tmp", self._path)
        except OSError:
            pass


class _Target:
    """Where lines go: standard output, or a file that is continued where a run before it ended."""

    def __init__(self, path: str, head: str) -> None:
        self.path = path
        self.last = 0  # the last job that is there
        self.done = self.failed = 0
        if path == "-":
            self._file = os.dup(1)
            self.write(head.encode() + b"\n")
            return
        self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o666)
        _lock(self._file, path)
        if self._first_line() == head + "\n":
            self._continue()
        elif os.fstat(self._file).st_size and not self._is_torn(head):
            raise _not_ours(path, self._first_line(), head)
        else:
            os.ftruncate(self._file, 0)
            self.write(head.encode() + b"\n")

    def _first_line(self) -> str:
        with open(self.path, "rb") as file:
            return file.readline(parts.LONGEST_HEADER).decode("utf-8", "replace")

    def _is_torn(self, head: str) -> bool:
        """Whether a kill cut off the header itself."""
        first = self._first_line()
        return os.fstat(self._file).st_size < len(head.encode()) + 1 and head.startswith(first)

    def _continue(self) -> None:
        """Finds the last whole line, and removes what follows it."""
        end = 0
        with open(self.path, "rb") as file:
            for number, row in enumerate(file):
                if not row.endswith(b"\n"):
                    break
                if number > 0:
                    job, status = _job_and_status(row, self.path, number + 1)
                    self.last = job
                    self.done += 1
                    self.failed += status != 0
                end += len(row)
        os.ftruncate(self._file, end)

    def write(self, row: bytes) -> None:
        """Writes a line at once, so that a kill loses the jobs at work alone."""
        view = memoryview(row)
        while view:
            try:
                view = view[os.write(self._file, view):]
            except OSError as error:
                error.filename = "stdout" if self.path == "-" else self.path
                raise

    def close(self) -> None:
        os.close(self._file)


def _lock(file: int, path: str) -> None:
    """Locks a part, until it is closed. Throws DataError if another run has it."""
    for attempt in range(10):  # `status` holds the lock for an instant
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            if attempt == 9:
                raise DataError([f"{path}: error: another run is writing it"]) from None
            time.sleep(0.02)
        except OSError:
            return  # a file system without locks


def _not_ours(path: str, first: str, head: str) -> DataError:
    """About a file that begins with another line than `head`."""
    ours = json.loads(head)
    try:
        found = json.loads(first)
        changed = [key for key in ("schema", "version", "digest", "shard", "only") if found.get(key) != ours[key]]
    except (ValueError, AttributeError):
        changed = ["schema"]
    if not changed or changed[0] == "schema":
        return DataError([f"{path}: error: holds something else than this share of this sweep; move it away, or give "
                          "-o another name"])
    if changed[0] == "version":
        return DataError([f"{path}: error: made by version {found['version']}, this is {ours['version']}: give -o "
                          "another name"])
    if changed[0] == "digest":
        what = f"made before {ours['sweep']} was changed"
    elif changed[0] == "shard":
        what = f"shard {found['shard']} of this sweep, not {ours['shard']}"
    else:
        what = "made with other rules of --only"
    return DataError([f"{path}: error: {what}: give -o another name, and --reuse {shlex.quote(path)} to take over the "
                      "lines of equal jobs"])


def _job_and_status(row: bytes, path: str, number: int) -> tuple[int, int]:
    """Those of a line, which begins with them."""
    try:
        found = json.loads(row.decode("utf-8", "surrogateescape"))
        return int(found["job"]), int(found["status"])
    except (ValueError, KeyError, TypeError):
        raise DataError([f"{path}:{number}:1: error: no line of {parts.SCHEMA}: move the file away"]) from None


class _Crew:
    """Workers, of which each thread takes one for a job."""

    def __init__(self, sweep: Sweep, size: int) -> None:
        self._workers: queue.SimpleQueue[Worker] = queue.SimpleQueue()
        self._all = [Worker(sweep, 1) for _ in range(size)]
        for worker in self._all:
            self._workers.put(worker)

    def run(self, job: Job) -> Outcome:
        worker = self._workers.get()
        try:
            return worker.run(job)
        finally:
            self._workers.put(worker)

    def kill(self) -> None:
        """Ends all jobs at work."""
        for worker in self._all:
            worker.kill()

    def close(self) -> None:
        for worker in self._all:
            worker.close()


def _in_order(jobs: Jobs, work: Callable[[Job], Result], size: int,
              kill: Callable[[], None]) -> Iterator[tuple[Job, Result]]:
    """The results in the order of jobs, of which `size` are at work at a time and some more wait to be taken. `kill`
    ends those at work, if an exception ends the run."""
    with concurrent.futures.ThreadPoolExecutor(size) as pool:
        ahead: collections.deque[tuple[Job, concurrent.futures.Future[Result]]] = collections.deque()
        try:
            for job in jobs:
                ahead.append((job, pool.submit(work, job)))
                if len(ahead) >= 4 * size:
                    first, result = ahead.popleft()
                    yield first, result.result()
            while ahead:
                first, result = ahead.popleft()
                yield first, result.result()
        except BaseException:
            for _, result in ahead:
                result.cancel()
            kill()
            raise


@dataclass(frozen=True)
class Result:
    """The line of a job, and its status."""

    line: bytes
    status: int
    told: str = ""  # about a failure
    is_reused: bool = False


class _Earlier:
    """The lines of an earlier run that need no other: those of jobs that did not fail."""

    def __init__(self, path: str, head: str) -> None:
        self._places: dict[int, tuple[int, int]] = {}
        self._file = open(path, "rb")
        _lock(self._file.fileno(), path)  # as of a run, or another retry
        first = self._file.readline(parts.LONGEST_HEADER).decode("utf-8", "replace").rstrip("\n")
        if first != head:
            raise _not_ours(path, first, head)
        begin = self._file.tell()
        for number, row in enumerate(self._file, 2):
            if not row.endswith(b"\n"):
                break
            job, status = _job_and_status(row, path, number)
            if status == 0:
                self._places[job] = begin, len(row)
            begin += len(row)

    def line(self, job: Job) -> bytes | None:
        place = self._places.get(job.number)
        return os.pread(self._file.fileno(), place[1], place[0]) if place else None

    def close(self) -> None:
        self._file.close()


class _Reused:
    """Lines of other parts, as of this sweep before it grew, for jobs that are the same but for their numbers."""

    def __init__(self, paths: Sequence[str], sweep: Sweep, version: str) -> None:
        self._sweep = sweep
        self._writer = CommandWriter(sweep, None)
        self._places: dict[bytes, tuple[int, int, int]] = {}  # by names: descriptor, begin, length
        self._files: list[BinaryIO] = []
        for path in paths:
            made_by = parts.read_part(path).head.get("version")
            if made_by != version:
                raise DataError([f"{path}: error: made by version {made_by}: --reuse takes lines of {version} alone"])
            self._files.append(open(path, "rb"))
            self._find_lines(self._files[-1], path)

    def _find_lines(self, file: BinaryIO, path: str) -> None:
        file.readline(parts.LONGEST_HEADER)
        begin = file.tell()
        for number, row in enumerate(file, 2):
            if not row.endswith(b"\n"):
                break
            head = parts.HEAD.match(row)
            if head is None:
                raise DataError([f"{path}:{number}:1: error: no line of {parts.SCHEMA}"])
            if head["status"] == b"0":
                self._places[head["name"]] = file.fileno(), begin, len(row)
            begin += len(row)

    def line(self, job: Job) -> bytes | None:
        """The line that a run of the job would write, as far as its names, choices, commands and files tell."""
        place = self._places.get(dump(job.name).encode("utf-8", "surrogateescape"))
        if place is None:
            return None
        file, begin, length = place
        row = os.pread(file, length, begin)
        head = parts.HEAD.match(row)
        found = json.loads(row.decode("utf-8", "surrogateescape"))
        makes = [*found.get("reports", {}), *found.get("files", {}), *found.get("base64", {})]
        if (head is None or found["values"] != values(self._sweep, job)
                or found.get("commands") != [self._writer.words(job, step) for step in self._sweep.steps]
                or sorted(makes) != sorted(self._sweep.suffixes)):
            return None
        return b'{"job":%d' % job.number + row[head.end("job"):]

    def close(self) -> None:
        for file in self._files:
            file.close()


def run(sweep: Sweep, jobs: Jobs, share: parts.Share, path: str, version: str, size: int, retry: bool,
        reuse: Sequence[str], say: Callable[[list[str]], None], note: Callable[[str], None]) -> int:
    """Runs jobs, `size` at a time, and writes their lines to `path`. Returns how many failed, those of earlier runs
    included. With `retry` those that failed before run again. Jobs that have a line in the parts `reuse` do not run.
    `say` gets a line for each that fails, `note` how many did not run."""
    if path != "-" and os.path.exists(path) and not os.path.isfile(path):
        raise UsageError(f"-o {path}: a regular file, or standard output")
    reused = _Reused(reuse, sweep, version)
    head = parts.header(sweep, share, len(jobs), jobs.number_at(0) if len(jobs) else 0, version)
    earlier = None
    if retry and path != "-" and os.path.exists(path) and os.path.getsize(path):
        earlier = _Earlier(path, head)
    beside = path + ".retry" if earlier else path
    if earlier:
        with open(beside, "wb"):
            pass
    target = _Target(beside, head)
    if earlier:  # until the end the part stays as it was: `status` counts it
        with contextlib.suppress(OSError):
            os.unlink(path + STATUS)
    tally = Tally(None if path == "-" or earlier else path, len(jobs))
    tally.resume(target.done, target.failed)
    tally.tell()
    crew = _Crew(sweep, max(1, min(size, len(jobs) - target.done)))

    def work(job: Job) -> Result:
        if earlier and (row := earlier.line(job)):
            return Result(row, 0)
        if row := reused.line(job):
            return Result(row, 0, is_reused=True)
        outcome = crew.run(job)
        row = (parts.line(sweep, job, outcome) + "\n").encode("utf-8", "surrogateescape")
        told = (failure(job.number, job.name, outcome.status, outcome.commands, outcome.messages)
                if outcome.status else "")
        return Result(row, outcome.status, told)

    fresh = taken = 0
    try:
        for _, result in _in_order(jobs.behind(target.last), work, size, crew.kill):
            target.write(result.line)
            tally.take(result.status, result.is_reused)
            taken += result.is_reused
            fresh += not result.is_reused
            if result.told:
                say([result.told])
        if earlier:
            os.replace(beside, path)
    finally:  # of a signal as well
        crew.close()
        tally.tell(has_ended=True)
        target.close()
        reused.close()
        if earlier:
            earlier.close()
    if reuse and fresh and not taken:
        say(["warning: --reuse: these parts have no job of this run with the same choices, commands and files"])
    elif reuse and taken:
        note(f"note: {taken} jobs are those of {', '.join(reuse)}, {fresh} ran")
    return tally.failed


def failure(number: int, name: str, status: int, commands: list[list[str]], messages: str) -> str:
    """A sentence about a job that failed, with the command that did."""
    command = " ".join(map(shlex.quote, commands[-1])) if commands else ""
    lines = messages.strip().splitlines()
    reason = f": {lines[-1]}" if lines else ""
    return f"warning: job {number} ({name}) failed with status {status}: {command}{reason}"


def status_of(path: str) -> dict[str, Any] | None:
    """The content of the file beside a part."""
    try:
        with open(path + STATUS, encoding="utf-8") as file:
            found = json.load(file)
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and found.get("schema") == "ispace-run-status/1" else None
