# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the parts of a sweep are, and which jobs failed."""

from __future__ import annotations

import time
from typing import Any, Iterator, Sequence

from . import parts
from .listing import dump
from .run import failure, status_of

ALIVE = 30.0  # seconds since the last sign of a run that has not ended


def lines(paths: Sequence[str], jobs: int, as_json: bool, version: str) -> Iterator[str]:
    """A summary of all parts; `jobs` are those of the whole sweep. Reads the small file beside each part, and the part
    itself where there is none."""
    now = time.time()
    done = failed = at_work = 0
    rate = 0.0
    for part in parts.in_order(paths):
        state = status_of(part.path) or _counted(part)
        done += state["done"]
        failed += state["failed"]
        if not state.get("ended", True) and now - state["now"] < ALIVE:
            at_work += 1
            took = state["now"] - state["begin"]
            rate += state["fresh"] / took if took > 0 else 0.0
    left = jobs - done
    seconds = left / rate if rate > 0 else None
    if as_json:
        yield dump({"schema": "ispace-sweep-status/1", "tool": "ispace-sweep", "version": version, "jobs": jobs,
                    "done": done, "failed": failed, "left": left, "parts": len(paths), "running": at_work,
                    "rate": round(rate, 3), "seconds_left": None if seconds is None else round(seconds)})
        return
    yield f"jobs     {jobs}"
    yield f"done     {done} ({100 * done / jobs if jobs else 100:.1f}%)"
    yield f"failed   {failed}"
    yield f"parts    {len(paths)}, of which {at_work} are being written"
    yield f"rate     {rate:.1f} jobs a second" if at_work else "rate     no run is at work"
    if left and seconds is not None:
        yield f"left     {left} jobs, {_duration(seconds)} at this rate"
    else:
        yield f"left     {left} jobs"


def _counted(part: parts.Part) -> dict[str, Any]:
    statuses = [row["status"] for row in part.lines()]
    return {"done": len(statuses), "failed": sum(status != 0 for status in statuses)}


def _duration(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {rest} s" if minutes else f"{rest} s"


def failures(paths: Sequence[str], as_json: bool) -> Iterator[str]:
    """A line for each job that failed, with its command and last message."""
    for row in parts.rows(parts.in_order(paths)):
        if row["status"] == 0:
            continue
        if as_json:
            yield dump({key: row.get(key) for key in ("job", "name", "status", "values", "commands", "messages")})
        else:
            yield failure(row["job"], row["name"], row["status"], row.get("commands", []),
                          row.get("messages", "")).removeprefix("warning: ")
