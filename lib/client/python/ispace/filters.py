# SPDX-License-Identifier: GPL-3.0-or-later
"""The filters envc, arrange, scan and coverage as functions.

They run the tools: those of the folder in the variable ISPACE_BIN, else those of the command ``ispace`` where a
package keeps them apart from other programs of the same names, else those in PATH. Rooms and layouts
are names of files, or a Layout; options are those of the tool's manual, with ``_`` for ``-``::

    coverage("room.env", layout, require=["40%", "free:50%"], density="identify")

True stands for an option without value (False for its ``--no-`` form), a list for one that is repeated.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Union

from .errors import RequirementMissed, ToolError

Option = Union[None, bool, int, float, str, os.PathLike[str], Sequence[Any]]


class Object(Dict[str, Any]):
    """An object of JSON with its keys as attributes: ``report.coverage.exact``.

    share/ispace/schemas describes them. Angles in JSON are in radians, and poses ``[x, y, z, heading, tilt, roll]``.
    """

    def __getattr__(self, key: str) -> Any:
        try:
            return self[key]
        except KeyError:
            raise AttributeError(f"no `{key}` here, only {', '.join(self)}") from None


class Figure(Object):
    """A figure of a report, by cells and exact; None if unknown."""

    grid: Optional[float]
    exact: Optional[float]


class CoverageReport(Object):
    """The report of ``coverage --json``; share/ispace/schemas/coverage.json describes its keys.

    Keys that only some options or sensors cause are untyped attributes.
    """

    schema: str
    tool: str
    version: str
    digest: str
    limits: List[float]
    grid: List[int]
    height: float
    plane: float
    indoor_area: float
    free_area: float
    sensors: List[Object]
    total_effective_area: Figure
    outside_area: Optional[float]
    overlap_area: Figure
    coverage: Figure
    free_coverage: Figure
    redundancy: List[float]
    redundancy_exact: Optional[List[float]]
    zones: List[Object]
    pieces: Object
    unseen: List[Object]
    exact_missing: Optional[str]


def parse(text: str) -> Any:
    """JSON, with Objects for its objects."""
    return json.loads(text, object_hook=_object)


@dataclass(frozen=True)
class Record:
    """One line of an environment or layout."""

    keyword: str
    keys: Dict[str, str]


@dataclass(frozen=True)
class Layout:
    """A layout, as the text of a ``.3dm`` file."""

    text: str

    @property
    def records(self) -> List[Record]:
        """Its records, in order."""
        return [_record(line) for line in self.text.splitlines() if line and line[0] != "#"]

    @property
    def result(self) -> Dict[str, str]:
        """The result record of arrange: coverage, bound, strategy …; empty without one."""
        for record in self.records:
            if record.keyword == "result":
                return record.keys
        return {}

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes a ``.3dm``."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)


Room = Union[str, os.PathLike[str]]
Placed = Union[None, str, os.PathLike[str], Layout]


def coverage(room: Room, layout: Placed = None, **options: Option) -> CoverageReport:
    """Measures the coverage of a layout: returns the report of ``coverage --json``.

    Raises RequirementMissed, with the report as ``product``, if ``require`` is not met.
    """

    def report(text: str) -> CoverageReport:
        return CoverageReport(parse(text))

    return report(_run("coverage", room, layout, {"json": True, **options}, report))


def info(room: Room, **options: Option) -> Object:
    """Limits, areas and counts of a room: the report of ``envc --info``."""
    report: Object = parse(_run("envc", room, None, {"info": True, "json": True, **options}))
    return report


def arrange(room: Room, layout: Placed = None, **options: Option) -> Layout:
    """Computes poses for sensors: ``arrange("room.env", sensor="urg-04lx:3", optimize="exact")``.

    Sensors of ``layout`` get or keep their poses by the rules of arrange(1).
    """
    return Layout(_run("arrange", room, layout, {"quiet": True, **options}, Layout))


def scan(room: Room, layout: Placed = None, **options: Option) -> List[Object]:
    """Reads the sensors: returns the lines of ``scan``, less the header.

    Each has ``sensor``, ``t`` and ``pose``, a laser ``ranges`` (None: no return).
    """
    lines = _run("scan", room, layout, {"to": "jsonl", **options}).splitlines()
    return [parse(line) for line in lines[1:]]


def tool(name: str) -> str:
    """Where a tool is."""
    folder = os.environ.get("ISPACE_BIN")
    places: str = folder or os.environ.get("PATH") or os.defpath
    command = None if folder else shutil.which("ispace")
    if command is not None:
        own = os.path.join(os.path.dirname(os.path.realpath(command)), "..", "lib", "ispace", "bin")
        places = own + os.pathsep + places
    found = shutil.which(name, path=places)
    if found is None:
        where = folder or "PATH"
        raise ToolError(f"{name} is not in {where} (the variable ISPACE_BIN names a folder)", 127)
    return found


def arguments_of(options: Mapping[str, Option]) -> List[str]:
    """Options as words of a command line."""
    words: List[str] = []
    for key, value in options.items():
        name = key.rstrip("_").replace("_", "-")
        option = f"-{name}" if len(name) == 1 else f"--{name}"
        if value is None:
            continue
        if isinstance(value, bool):
            words.append(option if value else f"--no-{name}")
        elif isinstance(value, (list, tuple)):
            for item in value:
                words += [option, _word(item)]
        else:
            words += [option, _word(value)]
    return words


@contextlib.contextmanager
def operands(room: Optional[Room], layout: Placed) -> Iterator[List[str]]:
    """Names of files for a room and a layout, for as long as the context lasts."""
    names = [] if room is None else [os.fspath(room)]
    if not isinstance(layout, Layout):
        yield names + ([] if layout is None else [os.fspath(layout)])
        return
    with tempfile.TemporaryDirectory(prefix="ispace.") as folder:
        path = os.path.join(folder, "layout.3dm")
        layout.save(path)
        yield names + [path]


def last_line(text: str) -> str:
    """Returns the error message of a tool."""
    lines = text.strip().splitlines()
    return lines[-1] if lines else "no message"


def _object(keys: Dict[str, Any]) -> Object:
    return Figure(keys) if keys.keys() == {"grid", "exact"} else Object(keys)


def _word(value: Any) -> str:
    return str(os.fspath(value)) if isinstance(value, os.PathLike) else str(value)


def _record(line: str) -> Record:
    keyword, *words = _words(line)
    pairs = (word.partition("=") for word in words)
    return Record(keyword, {key: value.strip('"') for key, _, value in pairs})


def _words(line: str) -> List[str]:
    """Between blanks, but for those within quotes."""
    words, quoted = [""], False
    for character in line:
        quoted ^= character == '"'
        if character in " \t" and not quoted:
            words.append("")
        else:
            words[-1] += character
    return [word for word in words if word]


def _run(
    name: str,
    room: Room,
    layout: Placed,
    options: Mapping[str, Option],
    product: Callable[[str], Any] = str,
) -> str:
    with operands(room, layout) as names:
        command = [tool(name), *names, *arguments_of(options)]
        done = subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, check=False)
    out = done.stdout.decode()
    message = last_line(done.stderr.decode(errors="replace"))
    if done.returncode == 3 and out:
        raise RequirementMissed(message, product(out))
    if done.returncode != 0:
        raise ToolError(message, done.returncode)
    return out
