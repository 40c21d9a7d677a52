# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of results as CSV, JSON lines or NPZ. Equal rows make equal bytes."""

from __future__ import annotations

import csv
import io
import struct
import zipfile
from typing import Any, Callable, Sequence

from .listing import dump
from .model import Sweep
from .results import Row, Value

FORMATS = ("csv", "jsonl", "npz")
DAWN = (1980, 1, 1, 0, 0, 0)  # the first day of ZIP: files made today and tomorrow are the same


def columns(sweep: Sweep, rows: Sequence[Row]) -> dict[str, list[Value]]:
    """The table by column: job, name, axes, results in the order of the files, provenance."""
    axes = [axis.name for axis in sweep.axes]
    results = _in_order(rows)
    table: dict[str, list[Value]] = {"job": [row.job.number for row in rows],
                                     "name": [row.job.name for row in rows]}
    table.update({name: [row.values[name] for row in rows] for name in axes})
    for key in results:
        # The axis has the name; the report's value of the same name gets a prefix.
        table[f"results.{key}" if key in table else key] = [row.results.get(key) for row in rows]
    table["digest"] = [row.digest for row in rows]
    if "seed" not in axes:
        table["seed"] = [row.seed for row in rows]
    table["version"] = [" ".join(f"{tool} {version}" for tool, version in row.version.items()) or None
                        for row in rows]
    table["commands"] = [" && ".join(row.commands) for row in rows]
    return table


def _in_order(rows: Sequence[Row]) -> list[str]:
    """The keys of all results; a key of some rows only follows its predecessor there."""
    keys: list[str] = []
    known: set[str] = set()
    for row in rows:
        if row.results.keys() <= known:
            continue
        place = 0
        for key in row.results:
            if key in known:
                place = keys.index(key) + 1
            else:
                keys.insert(place, key)
                known.add(key)
                place += 1
    return keys


def to_csv(sweep: Sweep, rows: Sequence[Row], _version: str, raw: bool = False) -> bytes:
    """Unless `raw`, a text that a spreadsheet would take for a formula begins with an apostrophe."""
    table = columns(sweep, rows)
    cell = _cell if raw else _spreadsheet_cell
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([cell(name) for name in table])
    writer.writerows([cell(value) for value in line] for line in zip(*table.values()))
    return out.getvalue().encode()


def _spreadsheet_cell(value: Value) -> str:
    if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return "'" + value
    return _cell(value)


def _cell(value: Value) -> str:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def to_jsonl(sweep: Sweep, rows: Sequence[Row], version: str) -> bytes:
    """Schema ispace-sweep/1: a header line, then a line for each job."""
    lines = [dump({"schema": "ispace-sweep/1", "tool": "ispace-sweep", "version": version,
                   "sweep": sweep.file.rsplit("/", 1)[-1], "digest": sweep.digest,
                   "axes": [axis.name for axis in sweep.axes]})]
    lines += [dump({"job": row.job.number, "name": row.job.name, "values": row.values,
                    "results": row.results, "digest": row.digest, "seed": row.seed,
                    "version": row.version, "history": row.history, "commands": row.commands})
              for row in rows]
    return "".join(line + "\n" for line in lines).encode()


def to_npz(sweep: Sweep, rows: Sequence[Row], _version: str) -> bytes:
    """An array for each column: doubles, NaN if unknown, or texts. numpy.load needs no pickle."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, values in columns(sweep, rows).items():
            archive.writestr(_member(name), _npy(values))
    return out.getvalue()


def _member(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name.replace("/", "_") + ".npy", DAWN)
    info.compress_type = zipfile.ZIP_DEFLATED
    return info


def _npy(values: Sequence[Value]) -> bytes:
    """Version 1.0 of numpy's format for arrays of one dimension."""
    numbers: list[Any] = [float("nan") if value is None else value for value in values]
    if all(isinstance(value, (int, float)) for value in numbers):
        kind, data = "<f8", struct.pack(f"<{len(numbers)}d", *numbers)
    else:
        texts = [_cell(value) for value in values]
        width = max(map(len, texts))
        kind, data = f"<U{width}", b"".join(text.ljust(width, "\0").encode("utf-32-le") for text in texts)
    header = f"{{'descr': '{kind}', 'fortran_order': False, 'shape': ({len(values)},), }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode("latin-1") + data


WRITERS: dict[str, Callable[[Sweep, Sequence[Row], str], bytes]] = {"csv": to_csv, "jsonl": to_jsonl, "npz": to_npz}
