# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of results as CSV, JSON lines or NPZ. Equal rows make equal bytes, and rows take no memory: they wait in a
file until all columns are known."""

from __future__ import annotations

import csv
import dataclasses
import io
import json
import math
import shutil
import struct
import tempfile
import zipfile
from dataclasses import dataclass
from typing import IO, Any, Callable, Iterable, Iterator, Sequence

from .errors import UsageError, did_you_mean
from .listing import dump
from .results import Row, Value

FORMATS = ("csv", "jsonl", "npz")
DAWN = (1980, 1, 1, 0, 0, 0)  # the first day of ZIP: files made today and tomorrow are the same
Write = Callable[[bytes], None]


@dataclass
class Column:
    """A column, and what its values have in common."""

    name: str
    value: Callable[[Row], Value]
    width: int = 0  # of the longest text
    are_numbers: bool = True  # or unknown
    has_number: bool = False

    def take(self, value: Value) -> None:
        if value is None:
            return
        if isinstance(value, (int, float)):
            self.has_number = self.has_number or not isinstance(value, bool)
        else:
            self.are_numbers = False
        self.width = max(self.width, len(_cell(value)))


class Table:
    """The rows of a sweep, which are taken once, and read as often as a format needs."""

    def __init__(self, axes: Sequence[str], rows: Iterable[Row]) -> None:
        self.axes = list(axes)
        self.count = 0
        self._spool = tempfile.TemporaryFile("w+", encoding="utf-8", errors="surrogateescape")
        results: dict[str, Column] = {}
        order: list[str] = []
        fixed = self._fixed()
        for row in rows:
            self.count += 1
            self._spool.write(dump(dataclasses.asdict(row)) + "\n")
            _insert(row.results, results, order)
            for key, value in row.results.items():
                results[key].take(value)
            for column in (*fixed[0], *fixed[1]):
                column.take(column.value(row))
        names = {column.name for column in fixed[0]}
        for key in order:
            # The axis has the name; the report's value of the same name gets a prefix.
            results[key].name = f"results.{key}" if key in names else key
        self.columns = [*fixed[0], *(results[key] for key in order), *fixed[1]]

    def _fixed(self) -> tuple[list[Column], list[Column]]:
        """The columns before the results, and behind them."""
        before = [Column("job", lambda row: row.number), Column("name", lambda row: row.name)]
        before += [Column(axis, lambda row, axis=axis: row.values[axis]) for axis in self.axes]  # type: ignore[misc]
        behind = [Column("digest", lambda row: row.digest)]
        if "seed" not in self.axes:
            behind.append(Column("seed", lambda row: row.seed))
        behind.append(Column("version", _versions))
        behind.append(Column("commands", lambda row: " && ".join(row.commands)))
        return before, behind

    def pick(self, names: Sequence[str]) -> None:
        """Keeps the columns of these names, in their order. Throws UsageError for an unknown name, or one given
        twice."""
        known = {column.name: column for column in self.columns}
        for place, name in enumerate(names):
            if name not in known:
                hint = did_you_mean(name, known) or f"; there are {', '.join(known)}"
                raise UsageError(f"--columns: no column `{name}`{hint}")
            if name in names[:place]:
                raise UsageError(f"--columns: `{name}` is given twice")
        self.columns = [known[name] for name in names]

    def rows(self) -> Iterator[Row]:
        """All rows, again."""
        self._spool.seek(0)
        for line in self._spool:
            yield Row(**json.loads(line))


def _insert(found: dict[str, Value], results: dict[str, Column], order: list[str]) -> None:
    """Adds the keys of a row to those of all; a key of some rows only follows its predecessor there."""
    if found.keys() <= results.keys():
        return
    place = 0
    for key in found:
        if key in results:
            place = order.index(key) + 1
        else:
            order.insert(place, key)
            results[key] = Column(key, lambda row, key=key: row.results.get(key))  # type: ignore[misc]
            place += 1


def _versions(row: Row) -> str | None:
    return " ".join(f"{tool} {version}" for tool, version in row.version.items()) or None


def to_csv(table: Table, write: Write, raw: bool = False) -> None:
    """Unless `raw`, a text that a spreadsheet would take for a formula begins with an apostrophe."""
    cell = _cell if raw else _spreadsheet_cell
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([cell(column.name) for column in table.columns])
    for row in table.rows():
        writer.writerow([cell(column.value(row)) for column in table.columns])
        if out.tell() > 1 << 16:
            write(out.getvalue().encode("utf-8", "surrogateescape"))
            out.seek(0)
            out.truncate()
    write(out.getvalue().encode("utf-8", "surrogateescape"))


def _spreadsheet_cell(value: Value) -> str:
    if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return "'" + value
    return _cell(value)


def _cell(value: Value) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def to_jsonl(table: Table, write: Write, sweep: str, digest: str, version: str) -> None:
    """Schema ispace-sweep/1: a header line, then a line for each job."""
    write((dump({"schema": "ispace-sweep/1", "tool": "ispace-sweep", "version": version, "sweep": sweep,
                 "digest": digest, "axes": table.axes}) + "\n").encode("utf-8", "surrogateescape"))
    for row in table.rows():
        write((dump({"job": row.number, "name": row.name, "values": row.values, "results": row.results,
                     "digest": row.digest, "seed": row.seed, "version": row.version, "history": row.history,
                     "commands": row.commands}) + "\n").encode("utf-8", "surrogateescape"))


def to_npz(table: Table, write: Write) -> None:
    """An array for each column: doubles, NaN if unknown, or texts. numpy.load needs no pickle."""
    with tempfile.TemporaryDirectory(prefix="ispace-sweep.npz.") as folder:
        files = [open(f"{folder}/{index}", "wb") for index in range(len(table.columns))]
        for column, file in zip(table.columns, files):
            file.write(_npy_header(column, table.count))
        for row in table.rows():
            for column, file in zip(table.columns, files):
                file.write(_item(column, column.value(row)))
        for file in files:
            file.close()
        with open(f"{folder}/all", "w+b") as whole:
            _pack(table, folder, whole)
            whole.seek(0)
            while block := whole.read(1 << 20):
                write(block)


def _pack(table: Table, folder: str, whole: IO[bytes]) -> None:
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as archive:
        for index, column in enumerate(table.columns):
            info = zipfile.ZipInfo(column.name.replace("/", "_") + ".npy", DAWN)
            info.compress_type = zipfile.ZIP_DEFLATED
            with open(f"{folder}/{index}", "rb") as file, archive.open(info, "w", force_zip64=True) as member:
                shutil.copyfileobj(file, member, 1 << 20)


def _npy_header(column: Column, count: int) -> bytes:
    """Version 1.0 of numpy's format for arrays of one dimension."""
    kind = "<f8" if column.are_numbers else f"<U{max(1, column.width)}"
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': ({count},), }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode("latin-1")


def _item(column: Column, value: Any) -> bytes:
    if column.are_numbers:
        return struct.pack("<d", math.nan if value is None else value)
    return _cell(value).ljust(max(1, column.width), "\0").encode("utf-32-le")
