#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""ispace-sweep reads the results of the tools: it writes a table in three forms, which other programs read, and
pictures; and it reports files of a wrong type."""

import csv
import io
import json
import os
import shutil
import zipfile

from sweeping import PROGRAM, Folder, check, same

TEXT = """
run:
  - arrange {room} --sensor {device}:{count} --strategy random --seed {seed} -q -o {out}.3dm
  - coverage {room} {out}.3dm -q --report {out}.json
axes:
  room: {files: [ispace.env, l-room.env]}
  device: [urg-04lx, "laser,range=4"]
  count: [1, 2]
  seed: [3, 4]
"""
SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "share", "scenes")
FIRST = "results/ispace_urg-04lx_count1_seed3"


def run_jobs(folder):
    for room in ("ispace.env", "l-room.env"):
        shutil.copy(os.path.join(SCENES, room), folder.path)
    folder.sweep("commands", text=TEXT)
    folder.sweep("plot", "--x", "count", status=1)
    same("results that are missing", [f"ispace-sweep: {FIRST}.3dm: error: not there",
                                      "ispace-sweep: error: no job is done: run those of `ispace-sweep commands`, or "
                                      "name the parts of `ispace-sweep run`"], folder.talk.splitlines())
    folder.run("bash", "-euo", "pipefail", "-c", "ispace-sweep commands sweep.yaml | sh")


def table(folder):
    rows = list(csv.DictReader(io.StringIO(folder.sweep("join"))))
    same("rows", 16, len(rows))
    for row in rows:
        stem = f"results/{row['name']}"
        report = json.loads(folder.read(stem + ".json"))
        layout = folder.read(stem + ".3dm").decode()
        same("coverage of the report", report["coverage"]["exact"], float(row["coverage.exact"]))
        check(f"coverage={100 * float(row['result.coverage']):.12g}% " in layout,
              f"coverage {row['result.coverage']} of {layout}")
        same("digest", report["digest"], row["digest"])
        check(row["digest"] in layout, "the layout's digest")
        same("version", f"coverage {report['version']}", row["version"])
        check(f"--seed {row['seed']}\n" in layout, "the seed of the history")
        check(f"{row['room']} --sensor {row['device']}:{row['count']} " in row["commands"], row["commands"])
        same("seen by none and more", 1, round(sum(float(row[f"redundancy.{k}"] or 0) for k in range(3)), 9))
    names = list(rows[0])
    same("redundancy stands together", ["redundancy.0", "redundancy.1", "redundancy.2"],
         names[names.index("redundancy.0"):][:3])
    same("equal bytes", folder.sweep("join"), folder.sweep("join"))
    part = list(csv.DictReader(io.StringIO(folder.sweep("join", "--only", "seed=4", "--only", "count=2"))))
    same("--only", 4, len(part))
    return rows


def lines(folder, rows):
    folder.sweep("join", "-o", "table.jsonl")
    header, *found = map(json.loads, folder.read("table.jsonl").splitlines())
    same("schema", ("ispace-sweep/1", "sweep.yaml", ["room", "device", "count", "seed"]),
         (header["schema"], header["sweep"], header["axes"]))
    same("rows", [(row["name"], float(row["coverage.exact"])) for row in rows],
         [(row["name"], row["results"]["coverage.exact"]) for row in found])
    same("seeds", [3, 4] * 8, [row["seed"] for row in found])
    same("history", ["arrange ispace.env --sensor urg-04lx:1 --strategy random --seed 3"], found[0]["history"])


def columns(folder, rows):
    found = list(csv.reader(io.StringIO(folder.sweep("join", "--columns", 'count,seed,"coverage.exact"'))))
    same("some columns", [["count", "seed", "coverage.exact"],
                          *([row["count"], row["seed"], row["coverage.exact"]] for row in rows)], found)
    for names, wanted in (("count,coverage.exat", "--columns: no column `coverage.exat`, did you mean `coverage.exact`?"),
                          ("qqqqq", "--columns: no column `qqqqq`; there are job, name, "),
                          ("", "--columns: no column ``; there are job, name, "),
                          ("seed,count,seed", "--columns: `seed` is given twice")):
        folder.sweep("join", "--columns", names, status=2)
        check(wanted in folder.talk and folder.talk.count("\n") == 1, folder.talk)
    folder.sweep("join", "--columns", "seed", "--to", "jsonl", status=2)
    check("--columns is for csv and npz" in folder.talk, folder.talk)
    folder.sweep("plot", "--x", "count", "--columns", "seed", status=2)
    check("--columns is not for `plot`" in folder.talk, folder.talk)
    folder.sweep("join", "-o", "some.npz", "--columns", "seed,name")
    with zipfile.ZipFile(folder / "some.npz") as file:
        same("arrays", ["seed.npy", "name.npy"], file.namelist())


def arrays(folder, rows):
    try:
        import numpy
    except ImportError:
        print("no numpy here: NPZ is not read")
        return
    folder.sweep("join", "-o", "table.npz")
    once = folder.read("table.npz")
    with numpy.load(folder / "table.npz", allow_pickle=False) as file:
        same("columns", list(rows[0]), list(file))
        same("figures", [float(row["coverage.exact"]) for row in rows], list(file["coverage.exact"]))
        same("words", [row["name"] for row in rows], list(file["name"]))
        check(numpy.isnan(file["redundancy.2"]).sum() == 8, "NaN where one sensor is all there is")
    folder.sweep("join", "-o", "again.npz")
    check(once == folder.read("again.npz"), "NPZ differs from run to run")


def pictures(folder):
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        folder.sweep("plot", "--x", "count", "-o", "no.svg", status=1)
        check("python3-matplotlib" in folder.talk, folder.talk)
        print("no matplotlib here: nothing is drawn")
        return
    folder.sweep("plot", "--x", "count", "--by", "device", "-o", "curves.svg")
    text = folder.read("curves.svg")
    check(text.count(b"<path") > 10 and b"</svg>" in text, "no drawing")
    same("equal bytes", text.decode(), folder.sweep("plot", "--x", "count", "--by", "device"))
    check(text.decode() != folder.sweep("plot", "--x", "count", "--by", "device", "--y", "result.area"), "--y is nothing")
    check(text.decode() != folder.sweep("plot", "--x", "count", "--by", "device", "--only", "room=ispace.env"),
          "--only is nothing")
    folder.sweep("plot", "--x", "device", "--over", "room", "-o", "heat.png")
    check(folder.read("heat.png").startswith(b"\x89PNG"), "no PNG")
    folder.sweep("plot", "--x", "seed", "--y", "free_coverage.exact", "-o", "one.pdf")
    check(folder.read("one.pdf").startswith(b"%PDF"), "no PDF")
    both = folder.sweep("plot", "--x", "count", "--by", "device", "--y", "coverage.exact,free_coverage.exact")
    check(both.count("<path") > text.decode().count("<path"), "a column is not drawn")
    for words, wanted in ((["--x", "conut"], "--x conut: no such axis, did you mean `count`?"),
                          (["--x", "count", "--y", "coverage.exat"], "--y coverage.exat: no column with numbers, "
                                                                     "did you mean `coverage.exact`?"),
                          (["--x", "count", "--y", "result.area,result.area"], "--y: `result.area` is given twice"),
                          (["--x", "device", "--over", "room", "--y", "result.area,coverage.exact"],
                           "--y: a heat map (--over) shows one column")):
        folder.sweep("plot", *words, status=2)
        check(folder.talk.startswith("ispace-sweep: " + wanted), folder.talk)


def gaps(folder):
    kept = {suffix: folder.read(FIRST + suffix) for suffix in (".3dm", ".json")}
    os.remove(folder / (FIRST + ".json"))
    folder.sweep("join", "-o", "gaps.csv", status=1)
    same("a job that is not done", [f"ispace-sweep: {FIRST}.json: error: not there",
                                    "ispace-sweep: error: 1 of 16 jobs are not done: `commands --missing` lists them, "
                                    "--partial does without them"], folder.talk.splitlines())
    check(not os.path.exists(folder / "gaps.csv"), "a table in spite of gaps")
    out = folder.run(PROGRAM, "join", "sweep.yaml", "--partial")
    same("rows of a part", 16, len(out.splitlines()))
    same("told", "ispace-sweep: warning: 1 of 16 jobs are not done\n", folder.talk)
    for text, wanted in (('{"coverage":', "not what .json files hold"), ("[1]", "not what .json files hold"),
                         ('{"a":NaN}', "not what .json files hold"), ("[" * 100000, "not what .json files hold"),
                         (b"\xff", "not what .json files hold"),
                         ('{"digest":"sha256:' + 64 * "0" + '"}', "about another room than the job's other files")):
        folder.write(FIRST + ".json", text)
        folder.sweep("join", status=1)
        check(folder.talk.startswith(f"ispace-sweep: {FIRST}.json: error: {wanted}"), f"of {text[:20]}: {folder.talk}")
    # The file chooses its keys; a reserved column name is not lost.
    folder.write(FIRST + ".json", '{"count":7,"nested":{"deep":[1,null,"x"]},"many":[[1]],"flag":true,"text":"a,\\"b"}')
    (row,) = csv.DictReader(io.StringIO(folder.sweep("join", "--only", "room=ispace.env", "--only", "device=urg-04lx",
                                                     "--only", "count=1", "--only", "seed=3")))
    same("a foreign report", ("1", "7", "1", "", "x", "true", 'a,"b'),
         tuple(row[key] for key in ("count", "results.count", "nested.deep.0", "nested.deep.1", "nested.deep.2",
                                    "flag", "text")))
    for text in ("#env 1\n", "#3dm 1\n# arrange room.gl", "#3dm 1"):
        folder.write(FIRST + ".3dm", text)
        folder.sweep("join", status=1)
        check(folder.talk.startswith(f"ispace-sweep: {FIRST}.3dm: error: not what .3dm files hold"), folder.talk)
    for suffix, text in kept.items():
        folder.write(FIRST + suffix, text)
    folder.sweep("join", text=TEXT.replace("axes:", "folder: elsewhere\naxes:"), status=1)
    same("findings", 2, len(folder.talk.splitlines()))
    check(folder.talk.startswith("ispace-sweep: elsewhere/"), folder.talk)
    folder.run(PROGRAM, "join", "sweep.yaml", "--partial", status=1)
    same("nothing", "ispace-sweep: error: no job is done yet\n", folder.talk)


def formulas(folder):
    """Texts that a spreadsheet would compute are quoted in CSV, numbers are not."""
    folder.sweep("commands", text="run: cp {word} {out}.json\naxes: {word: ['=a', '@b', '-c', '+d', '-1e3']}\n")
    for stem in ("a", "b", "c", "+d", "word-1e3"):
        folder.write(f"results/{stem}.json", '{"=1+2": "@SUM(A1)", "low": -3}')
    header, *rows = csv.reader(io.StringIO(folder.sweep("join")))
    same("a column's name", "'=1+2", header[3])
    same("choices", ["'=a", "'@b", "'-c", "'+d", "-1000.0"], [row[2] for row in rows])
    same("results", {("'@SUM(A1)", "-3")}, {tuple(row[3:5]) for row in rows})
    header, *rows = csv.reader(io.StringIO(folder.sweep("join", "--raw")))
    same("raw", ("=1+2", "=a", "@SUM(A1)"), (header[3], rows[0][2], rows[0][3]))
    folder.sweep("join", "--raw", "--to", "jsonl", status=2)


with Folder() as scratch:
    run_jobs(scratch)
    joined = table(scratch)
    lines(scratch, joined)
    columns(scratch, joined)
    arrays(scratch, joined)
    pictures(scratch)
    gaps(scratch)
with Folder() as scratch:
    formulas(scratch)
