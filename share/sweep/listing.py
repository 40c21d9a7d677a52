# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists the jobs of a sweep for other programs: lines of the shell, JSON lines, names of files, rules for make."""

from __future__ import annotations

import json
import os
import re
from typing import Callable, Iterable, Iterator, Sequence

from .errors import DataError
from .model import CommandWriter, Job, Step, Sweep

Left = Callable[[Job], Sequence[Step]]  # the steps of a job that are to be listed, asked in the order of jobs


def commands(jobs: Iterable[Job], writer: CommandWriter, left: Left) -> Iterator[str]:
    """A line for each job that has steps left."""
    for job in jobs:
        steps = left(job)
        if steps:
            yield writer.line(job, steps)


def json_lines(sweep: Sweep, jobs: Iterable[Job], writer: CommandWriter, left: Left, version: str) -> Iterator[str]:
    """The same with all there is to know of a job, for programs: schema ispace-jobs/1."""
    yield dump({"schema": "ispace-jobs/1", "tool": "ispace-sweep", "version": version,
                "sweep": os.path.basename(sweep.file), "digest": sweep.digest})
    for job in jobs:
        steps = left(job)
        if steps:
            yield dump({"job": job.number, "name": job.name, "values": values(sweep, job),
                        "inputs": sweep.inputs(job),
                        "outputs": [job.path(suffix) for suffix in sweep.suffixes],
                        "command": writer.line(job, steps)})


def names(jobs: Iterable[Job], left: Left, suffix: str | None) -> Iterator[str]:
    """The files that the jobs make, a job's in the order of its steps."""
    for job in jobs:
        for made in (made for step in left(job) for made in step.files):
            if suffix is None or made == suffix:
                yield job.path(made)


def makefile(sweep: Sweep, jobs: Iterable[Job], writer: CommandWriter) -> Iterator[str]:
    """Rules for GNU make: one for each step of each job, and a target and a variable with all files,
    called like the sweep's file."""
    title = _make_title(sweep)
    yield f"# Made by ispace-sweep from {_make_comment(sweep.file)}; needs GNU make 4.3."
    yield f".PHONY: {title}"
    yield f"{title}: # all jobs"
    folder = "" if sweep.folder == "." else f" | {sweep.folder}"
    if folder:
        yield f"{sweep.folder}:\n\tmkdir -p $@"
    all_files: list[str] = []
    for job in jobs:
        inputs = "".join(" " + _make_name(name) for name in sweep.inputs(job))
        before = ""
        for step in sweep.steps:
            files = [job.path(suffix) for suffix in step.files]
            all_files += files
            grouped = " &:" if len(files) > 1 else ":"
            yield f"{' '.join(files)}{grouped}{inputs}{before}{folder}"
            yield "\t" + writer.step(job, step).replace("$", "$$")
            before += "".join(" " + name for name in files)
    yield f"{title} :="
    yield from (f"{title} += {name}" for name in all_files)
    yield f"{title}: $({title})"


# Words that begin a directive of make.
MAKE_WORDS = frozenset(("define else endef endif export ifdef ifeq ifndef ifneq include load override private "
                        "undefine unexport vpath").split())


def _make_title(sweep: Sweep) -> str:
    """The target and variable with all files. SHELL, PATH and the like belong to make and its environment."""
    stem = os.path.splitext(os.path.basename(sweep.file))[0]
    title = re.sub(r"[^A-Za-z0-9]+", "-", stem).strip("-") or "sweep"
    reserved = title == sweep.folder or title in MAKE_WORDS or re.fullmatch("[A-Z][A-Z0-9]*", title)
    return f"{title}-jobs" if reserved else title


def _make_comment(text: str) -> str:
    return re.sub(r"[\x00-\x1f\\]", "?", text)


def _make_name(name: str) -> str:
    """A file's name as a prerequisite."""
    if re.search(r"[:=;|%*?\[\]\\\"'~]", name):
        raise DataError([f"{name}: error: make cannot have a file of this name as a prerequisite; rename it"])
    return re.sub(r"([ #])", r"\\\1", name).replace("$", "$$")


def values(sweep: Sweep, job: Job) -> dict[str, str | float | int]:
    """The choice on each axis."""
    return {axis.name: number_or_text(choice.text) for axis, choice in zip(sweep.axes, job.choices)}


def number_or_text(text: str) -> str | float | int:
    """A number where the text is one that a double holds."""
    if re.fullmatch(r"-?[0-9]{1,15}", text):
        return int(text)
    if re.fullmatch(r"[+-]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][+-]?[0-9]+)?", text):
        number = float(text)
        if abs(number) < 1e300:
            return number
    return text


def dump(thing: object) -> str:
    return json.dumps(thing, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
