# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the parts of a sweep are, and which jobs failed."""

from __future__ import annotations

import os
import time
from typing import Any, Iterator, Sequence

from . import parts
from .errors import MOST_FINDINGS
from .listing import dump
from .run import failure, status_of

ALIVE = 30.0  # seconds since the last sign of a run on another machine, or on a file system without locks


def lines(found: Sequence[parts.Part], jobs: int, as_json: bool, version: str) -> Iterator[str]:
    """A summary of all parts; `jobs` are those of the whole sweep. Counts the lines of the parts: after a kill the
    small file beside each is out of date, and serves the rate alone."""
    now = time.time()
    done = failed = at_work = complete = 0
    rate = 0.0
    stopped: list[parts.Part] = []
    for part in found:
        state = status_of(part.path)
        is_running = _is_running(part, state, now)  # before its lines are counted: it may end meanwhile
        for _ in part.lines(briefly=True):
            pass
        done += part.count
        failed += part.failed
        if is_running:
            at_work += 1
            rate += _rate(part, state, now)
        elif part.count < part.jobs:
            stopped.append(part)
        else:
            complete += 1
    left = jobs - done
    seconds = left / rate if rate > 0 else None
    if as_json:
        yield dump({"schema": "ispace-sweep-status/1", "tool": "ispace-sweep", "version": version, "jobs": jobs,
                    "done": done, "failed": failed, "left": left, "parts": len(found), "running": at_work,
                    "stopped": len(stopped), "rate": round(rate, 3),
                    "seconds_left": None if seconds is None else round(seconds)})
        return
    yield f"jobs     {jobs}"
    yield f"done     {done} ({100 * done / jobs if jobs else 100:.1f}%)"
    yield f"failed   {failed}"
    yield f"parts    {len(found)}: {complete} complete, {at_work} being written, {len(stopped)} stopped"
    if rate > 0:
        yield f"rate     {rate:.1f} jobs a second"
    else:
        yield "rate     no job has ended yet" if at_work else "rate     no run is at work"
    if left and seconds is not None:
        yield f"left     {left} jobs, {_duration(seconds)} at this rate"
    else:
        yield f"left     {left} jobs"
    for part in stopped[:MOST_FINDINGS]:
        yield f"stopped  {part.path}: {parts.extent(part)}; the same `run` continues it"
    if len(stopped) > MOST_FINDINGS:
        yield f"stopped  {len(stopped) - MOST_FINDINGS} more parts"
    missing = parts.absent(found)
    if missing:
        yield f"absent   {parts.shard_list(missing)}: not among these parts"


def _is_running(part: parts.Part, state: dict[str, Any] | None, now: float) -> bool:
    """Whether a run holds the part's lock. The lock of another machine may be invisible here: its run has told how far
    it is lately."""
    is_locked = part.is_locked()
    here = os.uname().nodename
    if is_locked or state is None or (is_locked is False and state.get("host", here) == here):
        return bool(is_locked)
    return not state.get("ended", True) and now - state["now"] < ALIVE


def _rate(part: parts.Part, state: dict[str, Any] | None, now: float) -> float:
    """Jobs a second since the run began; 0 without its file, as during --retry."""
    if state is None:
        return 0.0
    before = int(state["done"]) - int(state["fresh"])
    return max(0, part.count - before) / max(now - float(state["begin"]), 0.001)


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s" if minutes else f"{rest} s"


def failures(found: Sequence[parts.Part], as_json: bool) -> Iterator[str]:
    """A line for each job that failed, with its command and last message."""
    for row in parts.rows(found):
        if row["status"] == 0:
            continue
        if as_json:
            yield dump({key: row.get(key) for key in ("job", "name", "status", "values", "commands", "messages")})
        else:
            yield failure(row["job"], row["name"], row["status"], row.get("commands", []),
                          row.get("messages", "")).removeprefix("warning: ")
