# SPDX-License-Identifier: GPL-3.0-or-later
"""A sweep: axes with their choices, the steps of each job, and the jobs these make."""

from __future__ import annotations

import os
import re
import shlex
from dataclasses import dataclass
from functools import cached_property
from typing import Iterator, Mapping, Sequence

from .choices import Choice, Choices
from .numbering import Numbering

TOOLS = ("envc", "arrange", "scan", "coverage", "simrun")
OUT = "out"  # the placeholder of a job's own files


@dataclass(frozen=True)
class Axis:
    """A name, and the choices over which it varies; choices of files are inputs of the jobs."""

    name: str
    choices: Choices
    files: bool


@dataclass(frozen=True)
class Word:
    """A word of a command: texts and names of placeholders in turn, beginning with a text."""

    parts: tuple[str, ...]

    @property
    def placeholders(self) -> tuple[str, ...]:
        return self.parts[1::2]

    @property
    def suffix(self) -> str | None:
        """The text after {out} at the end of the word; None if it names no file of the job."""
        if len(self.parts) >= 3 and self.parts[-2] == OUT:
            return self.parts[-1]
        return None


@dataclass(frozen=True)
class Step:
    """A program and its arguments. `makes` and `reads` are suffixes of the job's files; standard output
    is kept in that with `redirect`, else discarded."""

    words: tuple[Word, ...]
    makes: tuple[str, ...]
    reads: tuple[str, ...]
    redirect: str | None

    @property
    def files(self) -> tuple[str, ...]:
        """The files that mark a complete step: outputs with a suffix, as folders mark none."""
        return tuple(suffix for suffix in self.makes if suffix)


@dataclass(frozen=True)
class Job:
    """One combination of choices, numbered from 1; `stem` is its files' path without suffix."""

    number: int
    name: str
    stem: str
    choices: tuple[Choice, ...]

    def path(self, suffix: str) -> str:
        return self.stem + suffix


@dataclass(frozen=True)
class Sweep:
    """The content of a sweep's file. `excluded` are combinations to skip: names of axes to the indices of choices;
    `accept` are exit statuses of a step that count as success, besides 0."""

    file: str
    digest: str
    steps: tuple[Step, ...]
    axes: tuple[Axis, ...]
    folder: str
    excluded: tuple[Mapping[str, tuple[range, ...]], ...] = ()
    accept: tuple[int, ...] = ()

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Of the files that every job makes, in the order of its steps."""
        return tuple(suffix for step in self.steps for suffix in step.files)

    @cached_property
    def numbering(self) -> Numbering:
        """Of all jobs."""
        return self._numbering([])

    def _numbering(self, more: list[dict[int, tuple[range, ...]]]) -> Numbering:
        places = {axis.name: place for place, axis in enumerate(self.axes)}
        rules = [{places[name]: ranges for name, ranges in rule.items()} for rule in self.excluded]
        return Numbering([len(axis.choices) for axis in self.axes], rules + more)

    def jobs(self, only: Mapping[int, int] | None = None) -> Jobs:
        """All jobs, or with `only` those that have these choices: places of axes to the indices of choices. The last
        axis varies fastest. They depend on the sweep's file alone (and, with patterns, on the names of files that
        match), not on completed jobs."""
        if not only:
            return Jobs(self, self.numbering, range(self.numbering.count))
        others: list[dict[int, tuple[range, ...]]] = [
            {place: (range(index), range(index + 1, len(self.axes[place].choices)))}
            for place, index in only.items()]
        chosen = self._numbering(others)
        return Jobs(self, chosen, range(chosen.count))

    def job(self, number: int, indices: Sequence[int]) -> Job:
        """The job of this number, which has the choices of these indices."""
        choices = tuple(axis.choices[index] for axis, index in zip(self.axes, indices))
        name = "_".join(choice.part for choice in choices) or "job"
        return Job(number, name, os.path.join(self.folder, name), choices)

    def inputs(self, job: Job) -> list[str]:
        """Files that the job reads and no job makes."""
        return [choice.text for axis, choice in zip(self.axes, job.choices) if axis.files]

    def done(self, job: Job, step: Step) -> bool:
        """Whether all files of a step are there. Tools write theirs whole or not at all."""
        return all(_is_there(job.path(suffix)) for suffix in step.files)

    def left(self, job: Job) -> list[Step]:
        """The steps from the first that is not done."""
        for index, step in enumerate(self.steps):
            if not self.done(job, step):
                return list(self.steps[index:])
        return []


def _is_there(path: str) -> bool:
    try:
        return os.stat(path).st_size > 0
    except OSError:
        return False


class Jobs:
    """Jobs of a sweep in their order. Each is computed when it is asked for: the list takes no memory, and its first
    job no longer than any other."""

    def __init__(self, sweep: Sweep, numbering: Numbering, places: range) -> None:
        self._sweep = sweep
        self._numbering = numbering
        self._places = places

    def __len__(self) -> int:
        return len(self._places)

    def __iter__(self) -> Iterator[Job]:
        every = self._sweep.numbering
        is_whole = self._numbering is every
        for place, indices in zip(self._places, self._numbering.walk(self._places.start)):
            yield self._sweep.job(1 + (place if is_whole else every.place_of(indices)), indices)

    def share(self, index: int, count: int) -> Jobs:
        """The part `index`, from 1, of `count` parts whose sizes differ by at most one."""
        size, more = divmod(len(self), count)
        begin = (index - 1) * size + min(index - 1, more)
        return Jobs(self._sweep, self._numbering, self._places[begin:begin + size + (index <= more)])

    def behind(self, number: int) -> Jobs:
        """Those with greater numbers."""
        low, high = 0, len(self)
        while low < high:
            middle = (low + high) // 2
            if self.number_at(middle) > number:
                high = middle
            else:
                low = middle + 1
        return Jobs(self._sweep, self._numbering, self._places[low:])

    def number_at(self, place: int) -> int:
        """The number of the job at a place of this list."""
        indices = self._numbering.indices_of(self._places[place])
        return 1 + self._sweep.numbering.place_of(indices)


class CommandWriter:
    """Commands of the shell for the jobs of a sweep."""

    def __init__(self, sweep: Sweep, threads: int | None) -> None:
        self._sweep = sweep
        self._threads = threads
        self._places = {axis.name: index for index, axis in enumerate(sweep.axes)}

    def words(self, job: Job, step: Step) -> list[str]:
        """The words of a step, as the program gets them."""
        words: list[str] = []
        for word in step.words:
            parts = word.parts
            if len(parts) == 1:
                words.append(parts[0])
            elif len(parts) == 3 and parts[0] == parts[2] == "" and parts[1] != OUT:
                words += job.choices[self._places[parts[1]]].words
            else:
                words.append("".join(
                    part if index % 2 == 0 else job.stem if part == OUT
                    else job.choices[self._places[part]].words[0]
                    for index, part in enumerate(parts)))
        if self._threads is not None and _runs_tool(words):
            words += ["-j", str(self._threads)]
        return words

    def step(self, job: Job, step: Step) -> str:
        """One step for sh: discards its output or writes it, by way of a temporary name, into its file."""
        program, *arguments = self.words(job, step)
        line = " ".join([_quote_program(program), *map(shlex.quote, arguments)])
        accepted = "".join(f" || [ $? -eq {status} ]" for status in self._sweep.accept)
        if step.redirect is None:
            return f"{line} >/dev/null{accepted}"
        target = shlex.quote(job.path(step.redirect))
        part = shlex.quote(job.path(step.redirect) + ".part")
        return f"{line} >{part}{accepted} && mv -f {part} {target}"

    def line(self, job: Job, steps: Sequence[Step]) -> str:
        """The steps as one line, which ends the shell with the status of the first that fails: under `sh -e`
        a failure inside a list of && would go unnoticed."""
        commands = [self.step(job, step) for step in steps]
        if self._sweep.folder != ".":
            commands.insert(0, f"mkdir -p {shlex.quote(self._sweep.folder)}")
        return " && ".join(commands) + " || exit"


# Words that begin a compound command of sh.
SHELL_WORDS = frozenset(("case do done elif else esac fi for function if in select then time until while").split())


def _quote_program(word: str) -> str:
    """The first word of a line. There sh knows assignments and its own words, make the prefixes @, - and +."""
    if re.fullmatch(r"[A-Za-z0-9_./][A-Za-z0-9_./+-]*", word) and word not in SHELL_WORDS:
        return word
    return "'" + word.replace("'", "'\"'\"'") + "'"


def _runs_tool(words: Sequence[str]) -> bool:
    """`arrange …`, `/opt/bin/arrange …` or `ispace arrange …`."""
    program = os.path.basename(words[0])
    return program in TOOLS or (program == "ispace" and len(words) > 1 and words[1] in TOOLS)
