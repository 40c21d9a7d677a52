#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tables.py FOLDER: writes the results FOLDER/BENCHMARK.json as CSV: FOLDER/BENCHMARK.csv, or FOLDER/BENCHMARK_TABLE.csv
for each of its tables. The rows are those printed; a benchmark that prints no table of its own has its counters as
columns.
"""
import argparse
import csv
import json
import pathlib
import re
import sys

PLAIN = {"name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions", "repetition_index",
         "threads", "iterations", "cpu_time", "time_unit"}
MEASURED = re.compile(r"/(iterations|min_time|repeats):[^/]*|/(manual|real|process)_time")  # in names


def cells(lines):
    """Splits lines of columns, which blanks separate that all lines have in common."""
    width = max(map(len, lines))
    lines = [line.ljust(width) for line in lines]
    blank = [all(line[at] == " " for line in lines) for at in range(width)] + [True]
    columns, begin = [], None
    for at, is_blank in enumerate(blank):
        if not is_blank and begin is None:
            begin = at
        elif is_blank and begin is not None:
            columns.append((begin, at))
            begin = None
    return [[line[begin:end].strip() for begin, end in columns] for line in lines]


def counted(runs):
    """The counters of runs, with their names."""
    columns = list(dict.fromkeys(key for run in runs for key in run if key not in PLAIN))
    names = [f"{key}_{runs[0]['time_unit']}" if key == "real_time" else key for key in columns]

    def text(value):
        return f"{value:.6g}" if isinstance(value, (int, float)) else value

    return [["run", *names]] + [[MEASURED.sub("", run["name"]), *(text(run.get(key, "")) for key in columns)] for run in runs]


def tables_of(result):
    """{group: rows} of the JSON of a benchmark, whose names begin with the group."""
    groups = {}
    for run in result["benchmarks"]:
        if run.get("run_type") != "aggregate":
            groups.setdefault(run["name"].split("/")[0], []).append(run)
    tables = {}
    for group, runs in groups.items():
        title = result["context"].get(f"table {group}")
        if title is None:
            tables[group] = counted(runs)
        else:
            rows = [run.get("error_message") or run.get("skip_message") or run.get("label", "") for run in runs]
            tables[group] = cells([title.splitlines()[-1], *rows])
            tables[group][0][0] = tables[group][0][0] or group
    return tables


def main():
    parser = argparse.ArgumentParser(description="results of benchmarks as CSV")
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    files = sorted(folder.glob("*.json"))
    if not files:
        sys.exit(f"tables.py: {folder} has no results *.json")
    for file in files:
        text = file.read_text(encoding="utf-8")
        tables = tables_of(json.loads(text)) if text.strip() else {}
        for group, rows in tables.items():
            name = file.stem if len(tables) == 1 else f"{file.stem}_{group}"
            with open(folder / f"{name}.csv", "w", encoding="utf-8", newline="") as out:
                csv.writer(out, lineterminator="\n").writerows(rows)


if __name__ == "__main__":
    main()
