#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tables.py FOLDER: writes the results FOLDER/BENCHMARK.json as FOLDER/BENCHMARK_TABLE.csv, a file for each table, or
FOLDER/BENCHMARK.csv where the table has the name of the benchmark. Rows are those printed; a benchmark that prints no
table of its own has its times and counters as columns. Exit status 1: a run missed its goal, or a result is incomplete,
as of a benchmark that ended early.
"""
import argparse
import csv
import json
import pathlib
import re
import sys

PLAIN = {"name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions", "repetition_index",
         "threads", "iterations", "time_unit", "real_time", "cpu_time", "error_occurred", "skipped"}
MEASURED = re.compile(r"/(iterations|min_time|repeats):[^/]*|/(manual|real|process)_time")  # in names
CELL_END = "\t"
SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}


def named(run):
    return MEASURED.sub("", run["name"])


def error_of(run):
    return run.get("error_message") or run.get("skip_message")


def printed(title, runs):
    """The rows of a table whose last line of the title holds the names of its columns."""
    def cells(line):
        return [cell.strip() for cell in line.removesuffix(CELL_END).split(CELL_END)]

    rows = [[named(run), error_of(run)] if error_of(run) else cells(run.get("label", "")) for run in runs]
    return [cells(title.splitlines()[-1]), *rows]


def counted(runs):
    """Times and counters of runs."""
    counters = list(dict.fromkeys(key for run in runs for key in run if key not in PLAIN))

    def row(run):
        def text(value):
            return f"{value:.6g}" if isinstance(value, (int, float)) else value

        times = [run[key] * 1e3 * SECONDS[run["time_unit"]] if key in run else "" for key in ("real_time", "cpu_time")]
        return [named(run), *map(text, times), *(text(run.get(key, "")) for key in counters)]

    return [["run", "real_time_ms", "cpu_time_ms", *counters], *map(row, runs)]


def tables_of(result):
    """{table: rows} of the JSON of a benchmark; the names of runs begin with the table."""
    groups = {}
    for run in result["benchmarks"]:
        if run.get("run_type") != "aggregate":
            groups.setdefault(named(run).split("/")[0], []).append(run)
    titles = {group: result["context"].get(f"table {group}") for group in groups}
    return {group: printed(titles[group], runs) if titles[group] else counted(runs) for group, runs in groups.items()}


def main():
    parser = argparse.ArgumentParser(description="results of benchmarks as CSV")
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    files = sorted(folder.glob("*.json"))
    if not files:
        sys.exit(f"tables.py: {folder} has no results *.json")
    status = 0
    for file in files:
        try:
            result = json.loads(file.read_text(encoding="utf-8"))
            tables = tables_of(result)
        except (ValueError, KeyError):
            print(f"tables.py: {file} is incomplete", file=sys.stderr)
            status = 1
            continue
        for run in result["benchmarks"]:
            if error_of(run):
                print(f"tables.py: {named(run)}: {error_of(run)}", file=sys.stderr)
                status = 1
        for group, rows in tables.items():
            name = file.stem if group == file.stem else f"{file.stem}_{group}"
            with open(folder / f"{name}.csv", "w", encoding="utf-8", newline="") as out:
                csv.writer(out, lineterminator="\n").writerows(rows)
    return status


if __name__ == "__main__":
    sys.exit(main())
