#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""ispace-sweep reads a sweep's file: jobs, in order, with stable names and unchanged words; and it reports files that
are no sweeps."""

import json
import os
import shlex
import shutil
import sys
import time

from sweeping import PROGRAM, Folder, check, same

SMALL = """
run:
  - arrange {room} --sensor {device}:{count} {search} -o {out}.3dm
  - coverage {room} {out}.3dm --report={out}.json
axes:
  room: {files: ["*.env"]}
  device: [urg-04lx, "laser,range=4"]
  count: 1..2
  search: {quick: '', proven: --optimize exact}
exclude:
  - {device: urg-04lx, count: 2, search: [quick]}
"""


def order_and_names(folder):
    lines = folder.sweep("commands", text=SMALL).splitlines()
    same("jobs", 14, len(lines))
    same("first job", "mkdir -p results && arrange a.env --sensor urg-04lx:1 -o results/a_urg-04lx_count1_quick.3dm "
         ">/dev/null && coverage a.env results/a_urg-04lx_count1_quick.3dm "
         "--report=results/a_urg-04lx_count1_quick.json >/dev/null || exit", lines[0])
    stems = [os.path.splitext(name)[0] for name in folder.sweep("names", "--suffix", ".json").splitlines()]
    same("order", ["results/a_urg-04lx_count1_quick", "results/a_urg-04lx_count1_proven",
                   "results/a_urg-04lx_count2_proven", "results/a_laser-range-4_count1_quick",
                   "results/a_laser-range-4_count1_proven", "results/a_laser-range-4_count2_quick",
                   "results/a_laser-range-4_count2_proven"], stems[:7])
    same("all names differ", 28, len(set(folder.sweep("names").splitlines())))
    only = folder.sweep("names", "--only", "room=b.env", "--only", "count=2", "--suffix", ".3dm").splitlines()
    same("--only", 3, len(only))
    # A new choice on an axis changes no name.
    more = folder.sweep("names", text=SMALL.replace("1..2", "[1..2, 30]")).splitlines()
    check(set(folder.sweep("names", text=SMALL).splitlines()) < set(more), "names change when jobs are added")


def shards(folder):
    every = folder.sweep("commands", text=SMALL)
    for count in (1, 2, 3, 5, 14, 20):
        parts = [folder.sweep("commands", "--shard", f"{index}/{count}") for index in range(1, count + 1)]
        same(f"{count} shards", every, "".join(parts))
        sizes = [part.count("\n") for part in parts]
        check(max(sizes) - min(sizes) <= 1, f"shards of {sizes} jobs")


def missing(folder):
    folder.sweep("commands", text=SMALL)
    folder.write("results/a_urg-04lx_count1_quick.3dm", "#3dm 1\n")
    folder.write("results/a_urg-04lx_count1_proven.3dm", "#3dm 1\n")
    folder.write("results/a_urg-04lx_count1_proven.json", "{}\n")
    folder.write("results/a_urg-04lx_count2_proven.json", "")  # empty: never written to its end
    lines = folder.sweep("commands", "--missing").splitlines()
    same("jobs left", 13, len(lines))
    same("a job of which half is done", "mkdir -p results && coverage a.env results/a_urg-04lx_count1_quick.3dm "
         "--report=results/a_urg-04lx_count1_quick.json >/dev/null || exit", lines[0])
    check("arrange" in lines[1], "an empty output counts as done")
    same("files left", 25, len(folder.sweep("names", "--missing").splitlines()))
    # A part of all jobs, done or not.
    same("--shard with --missing", 1, folder.sweep("commands", "--missing", "--shard", "1/7").count("\n"))
    shutil.rmtree(folder / "results")


NASTY = ["plain", "two words", "a'b", 'a"b', "$HOME `id` $(id)", "a;b&c|d>e<f", "*", "back\\slash", "#hash",
         "-n", "~", "ü", "%", "{{", "a=b:c", "!x"]


def quoting(folder):
    """Each word reaches the program unchanged, by way of sh and of make."""
    folder.write("show", "#!/usr/bin/python3\nimport json, os, sys\n"
                 "os.makedirs('results', exist_ok=True)\n"
                 "json.dump(sys.argv[1:-2], open(sys.argv[-1], 'w'))\n")
    os.chmod(folder / "show", 0o755)
    folder.write("$dollar #1 ü.env", "x")
    choices = "".join(f"    n{index}: [{json.dumps(word)}]\n" for index, word in enumerate(NASTY))
    folder.sweep("commands", text="run: ./show {room} '{{}}' {word} x{word}y -o {out}.json\naxes:\n  word:\n"
                 + choices + "  room: {files: ['$dollar*.env']}\n")
    for runner in ("ispace-sweep commands sweep.yaml | sh",
                   "ispace-sweep makefile sweep.yaml -o sweep.mk && make -s -f sweep.mk"):
        folder.run("bash", "-euo", "pipefail", "-c", runner)
        for index, word in enumerate(NASTY):
            name = f"results/n{index}_dollar-1.json"
            same(f"{word!r} by {runner}", ["$dollar #1 ü.env", "{}", word, f"x{word}y"], json.loads(folder.read(name)))
        shutil.rmtree(folder / "results")
    for line in folder.sweep("commands").splitlines():
        check(len(shlex.split(line)) > 8, f"a line that is no command: {line}")


def hostile_names(folder):
    """Names of files, programs and sweeps that begin like an option, an assignment or a prefix of make."""
    show = "#!/usr/bin/python3\nimport json, os, sys\njson.dump(sys.argv[1:-2], open(sys.argv[-1], 'w'))\n"
    for name in ("@show", "-show", "+show", "A=show", "if", "show"):
        folder.write(f"bin/{name}", show)
        os.chmod(folder / f"bin/{name}", 0o755)
    folder.write("-i.env", "x")
    more = {"env": {**os.environ, "PATH": folder / "bin" + ":" + os.environ["PATH"]}}
    runners = ("ispace-sweep commands {} | sh",
               "ispace-sweep makefile {} -o sweep.mk && make -s -f sweep.mk >make.log 2>&1 && [ ! -s make.log ]")
    for program in ("@show", "-show", "+show", "A=show", "if"):
        text = f"run: '{program} {{room}} -o {{out}}.json'\naxes: {{room: {{files: ['-*.env']}}}}\n"
        folder.sweep("commands", text=text)
        for runner in runners:
            folder.run("bash", "-euo", "pipefail", "-c", runner.format("sweep.yaml"), **more)
            same(f"{program} by {runner}", ["./-i.env"], json.loads(folder.read("results/i.json")))
            shutil.rmtree(folder / "results")
    folder.write("--trace=victim.3dm", "x")
    line = folder.sweep("commands", text="run: show {room} -o {out}.json\naxes: {room: {files: ['*.3dm']}}\n")
    check("show ./--trace=victim.3dm -o" in line, line)
    for name in ("SHELL", "PATH", "MAKEFLAGS", "include", "define"):
        folder.write(f"{name}.yaml", "run: show {n} -o {out}.json\naxes: {n: 1}\n")
        folder.run("bash", "-euo", "pipefail", "-c", runners[1].format(f"{name}.yaml") + f" && make -sf sweep.mk {name}-jobs",
                   **more)
        same(f"a sweep called {name}", ["1"], json.loads(folder.read("results/n1.json")))
        shutil.rmtree(folder / "results")


def steps(folder):
    text = """
run:
  - sh -c 'echo $0; exit 3' {n} > {out}.txt
  - cp {out}.txt {out}.b.txt
axes: {n: [1, 2]}
accept: 3
folder: .
"""
    folder.sweep("commands", text=text)
    folder.run("bash", "-euo", "pipefail", "-c", "ispace-sweep commands sweep.yaml | sh")
    same("what a step prints", b"2\n", folder.read("n2.b.txt"))
    check(not os.path.exists(folder / "n2.txt.part"), "a .part is left")
    for name in ("n1.txt", "n2.b.txt"):
        os.remove(folder / name)
    folder.run("bash", "-euo", "pipefail", "-c", "ispace-sweep makefile sweep.yaml | make -s -f -")
    same("by make", b"1\n", folder.read("n1.txt"))
    # A failing step leaves no file that counts as complete.
    for name in ("n1.txt", "n1.b.txt"):
        os.remove(folder / name)
    folder.sweep("commands", text=text.replace("accept: 3", ""))
    folder.run("sh", "-ec", "ispace-sweep commands sweep.yaml --missing | sh", status=3)
    same("left", 1, folder.sweep("commands", "--missing").count("\n"))
    # So does one in the middle of a job, and the jobs behind it are not begun.
    folder.sweep("commands", text=text.replace("n: [1, 2]", "n: [5, 6]").replace("accept: 3", ""))
    folder.run("sh", "-c", "ispace-sweep commands sweep.yaml | sh", status=3)
    check(os.path.exists(folder / "n5.txt.part") and not os.path.exists(folder / "n6.txt.part"), "it went on")
    # Threads are for our tools alone.
    out = folder.sweep("commands", "-j", "2", text="run:\n- arrange r.env -o {out}.3dm\n"
                       "- /opt/bin/scan {n} -o {out}.jsonl\n- ispace envc r.env -o {out}.glb\n- other -o {out}.x\n"
                       "axes: {n: 1}\n")
    same("-j", 3, out.count(" -j 2 "))


def described(folder):
    folder.sweep("commands", text=SMALL)
    header, *jobs = map(json.loads, folder.sweep("commands", "--json").splitlines())
    same("schema", "ispace-jobs/1", header["schema"])
    commands = folder.sweep("commands").splitlines()
    same("commands", commands, [job["command"] for job in jobs])
    same("a job", ({"room": "a.env", "device": "laser,range=4", "count": 2, "search": "proven"}, ["a.env"],
                   ["results/a_laser-range-4_count2_proven.3dm", "results/a_laser-range-4_count2_proven.json"]),
         (jobs[6]["values"], jobs[6]["inputs"], jobs[6]["outputs"]))


def numbers(folder):
    """Any share equals its part of the whole list, with rules that overlap and pieces of axes of all kinds."""
    text = """
run: show {a} {b} {c} {d} -o {out}.json
axes: {a: [x, 1..3, 9], b: 1..4, c: {p: u, q: v}, d: 5..7}
exclude:
- {a: [x, 2..3], b: 2..3}
- {b: [1, 3], c: q, d: 6..7}
- {a: 9}
- {c: p, d: 5, b: 4}
"""
    lines = folder.sweep("commands", text=text).splitlines()
    left = [(a, b, c, d) for a in "x1239" for b in "1234" for c in "pq" for d in "567"
            if not (a in "x23" and b in "23") and not (b in "13" and c == "q" and d in "67") and a != "9"
            and not (c == "p" and d == "5" and b == "4")]
    same("the jobs that no rule excludes", [f"{'a' * (a != 'x')}{a}_b{b}_{c}_d{d}" for a, b, c, d in left],
         [name[len("results/"):-len(".json")] for name in folder.sweep("names").splitlines()])
    jobs = list(map(json.loads, folder.sweep("commands", "--json").splitlines()[1:]))
    same("numbers", list(range(1, len(lines) + 1)), [job["job"] for job in jobs])
    for count, shares in ((7, range(1, 8)), (len(lines), (1, 2, 30, len(lines)))):
        for index in shares:
            part = folder.sweep("commands", "--shard", f"{index}/{count}", "--json").splitlines()[1:]
            for job in map(json.loads, part):
                same("a job of a share", jobs[job["job"] - 1], job)
    only = list(map(json.loads, folder.sweep("commands", "--only", "c=q", "--only", "d=5", "--json").splitlines()[1:]))
    same("numbers with --only", [job for job in jobs if job["values"]["c"] == "q" and job["values"]["d"] == 5], only)


def millions(folder):
    """A share of a million jobs takes the time and memory of its own jobs."""
    folder.write("sweep.yaml", "run: a {n} {m} -o {out}.x\naxes: {n: 1..1000, m: 1..1000}\n"
                 "exclude: {n: 4, m: 5..999}\n")
    script = ("import resource, subprocess, sys\nsubprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)\n"
              "used = resource.getrusage(resource.RUSAGE_CHILDREN)\nprint(used.ru_maxrss, used.ru_utime)\n")
    run = [sys.executable, "-c", script, PROGRAM, "commands", "sweep.yaml", "--shard"]
    memory, seconds = map(float, folder.run(*run, "700/1000").split())
    check(memory < 60000, f"{memory} kB for a share of a thousand")
    one = float(folder.run(*run, "1/1").split()[1])
    check(seconds < one / 5, f"a thousandth takes {seconds} s, all take {one} s")
    last = folder.sweep("names", "--shard", "1000/1000").splitlines()[-1]
    same("the last of them", "results/n1000_m1000.x", last)


def many(folder):
    folder.write("sweep.yaml", "run: arrange {room} --sensor {device}:{count} --seed {seed} -o {out}.3dm\n"
                 "axes: {room: [a, b], device: [x, y], count: 1..25, seed: 1..100}\n")
    start = time.process_time(), time.monotonic()
    lines = folder.sweep("commands").splitlines()
    check(time.monotonic() - start[1] < 5, "10 000 jobs take longer than 5 s, where 0.2 s are usual")
    same("jobs", 10000, len(lines))
    same("names", 10000, len(set(folder.sweep("names").splitlines())))


# A sweep, and the first thing that is said of it.
ERRORS = [
    ("", "sweep.yaml: error: empty, where a sweep needs `run` and `axes`"),
    ("[1]", "sweep.yaml:1:1: error: a sweep is a map, `key: value`, not a list"),
    ("run: a -o {out}.x", "sweep.yaml:1:1: error: no `axes` in this sweep"),
    ("run: a\naxis: {}", "sweep.yaml:2:1: error: unknown key `axis`, did you mean `axes`?"),
    ("run: a\nrun: b\naxes: {}", "sweep.yaml:2:1: error: `run` is there twice"),
    ("run: a -o {out}.x {rom}\naxes: {room: x}", "sweep.yaml:1:6: error: unknown axis {rom}, did you mean `room`?"),
    ("run: a -o {out}.x\naxes: {room: x}", "sweep.yaml:1:6: error: no step uses {room}: its jobs would all be the same"),
    ("run: a {n}\naxes: {n: 1}", "sweep.yaml:1:6: error: this step leaves no file of its own that tells when it is "
     "done: name one, as in `-o {out}.3dm`"),
    ("run: a {n} -o {out}\naxes: {n: 1}", "sweep.yaml:1:6: error: this step leaves no file of its own"),
    ("run: a {n} -o {out}.x | b\naxes: {n: 1}", "sweep.yaml:1:6: error: `|`: a step is one program without a shell"),
    ("run: a {n} -o {out}/x\naxes: {n: 1}", "sweep.yaml:1:6: error: `{out}/x`: after {out} there may be a suffix"),
    ("run: a {n} } -o {out}.x\naxes: {n: 1}", "sweep.yaml:1:6: error: `}` in `}`: }} is a brace"),
    ("run: a '{n} -o {out}.x\naxes: {n: 1}", "sweep.yaml:1:6: error: a step has a quote that is not closed"),
    ("run: a x{n} -o {out}.x\naxes: {n: {b: p q}}", "sweep.yaml:1:6: error: `x{n}`: a choice of `n` is not one word"),
    ("run: a\naxes:\n  n: [1, 2, 1]", "sweep.yaml:3:13: error: `1` is twice among the choices of `n`"),
    ("run: a\naxes:\n  n: ['a,b', a=b]", "sweep.yaml:3:14: error: `a,b` and `a=b` would both be `a-b` in the names"),
    ("run: a\naxes:\n  n: ['?']", "sweep.yaml:3:7: error: `?` leaves nothing for the names of files"),
    ("run: a\naxes:\n  n: []", "sweep.yaml:3:3: error: axis `n` has no choices"),
    ("run: a\naxes:\n  n: 3..1", "sweep.yaml:3:6: error: `3..1` is no range"),
    ("run: a\naxes:\n  n: 1..999999999", "sweep.yaml:3:6: error: `1..999999999` is no range"),
    ("run: a\naxes:\n  n: [1..5, 4..8]", "sweep.yaml:3:13: error: `4` is twice among the choices of `n`"),
    ("run: a\naxes:\n  n: [7, 1..9]", "sweep.yaml:3:10: error: `7` is twice among the choices of `n`"),
    ("run: a {n} {m} -o {out}.x\naxes: {n: 1..20000, m: 1..20000}", "sweep.yaml:2:7: error: 400000000 jobs"),
    ("run: a\naxes:\n  n: {files: none*.env}", "sweep.yaml:3:14: error: no file matches `none*.env` here in "),
    ("run: a\naxes:\n  n: {files: none.env}", "sweep.yaml:3:14: error: no file `none.env` here in "),
    ("run: a\naxes: {Out: 1}", "sweep.yaml:2:8: error: `Out` is no name for an axis"),
    ("run: a\naxes: {digest: 1}", "sweep.yaml:2:8: error: an axis cannot be called `digest`"),
    ("run: a\naxes: {n: \"a\\nb\"}", "sweep.yaml:2:11: error: a choice of `n` holds a line break"),
    ("run: a\naxes: {n: [[1]]}", "sweep.yaml:2:12: error: a choice of `n` is a single value, not a list"),
    ("run: a {n} -o {out}.x\naxes: {n: 1}\nexclude: {m: 1}", "sweep.yaml:3:11: error: unknown axis `m`"),
    ("run: a {n} -o {out}.x\naxes: {n: 1}\nexclude: {n: 2}", "sweep.yaml:3:14: error: `2` is no choice of `n`"),
    ("run: a {n} -o {out}.x\naxes: {n: 1}\nfolder: a b", "sweep.yaml:3:9: error: `a b` is no folder"),
    ("run: a {n} -o {out}.x\naxes: {n: 1}\naccept: 256", "sweep.yaml:3:9: error: `256` is no exit status"),
    ("run: a {n} -o {out}.x\naxes: {n: " + "x" * 300 + "}", "sweep.yaml:2:7: error: names of files would have 301"),
    ("run: [\n", "sweep.yaml:2:1: error: "),
    ("run: a\n--- \nb", "sweep.yaml:"),
    (b"run: a\n# \xff\n", "sweep.yaml:2: error: not UTF-8"),
    ("run: a\0b", "sweep.yaml:"),
    ("[" * 100000, "sweep.yaml:1:9: error: more than 8 levels of lists and maps"),
    ("a: &a [*a]", "sweep.yaml:1:1: error: unknown key `a`"),
    ("run: a\naxes: &a {n: *a}", "sweep.yaml:"),
    ("#" * (5 << 20), "sweep.yaml: error: more than 4 MB"),
]

# Words, and the messages about them.
USAGE = [
    ([], "an action is needed: commands, names"),
    (["comands", "sweep.yaml"], "unknown action `comands`, did you mean `commands`?"),
    (["list", "sweep.yaml"], "unknown action `list`: one of commands, names, makefile, run, status, join, plot"),
    (["plot", "table.csv", "--x", "count"], "table.csv holds results: the sweep comes first, `ispace-sweep plot sweep.yaml PART...`"),
    (["commands"], "the sweep's file is needed"),
    (["commands", "sweep.yaml", "--partial"], "--partial is not for `commands`"),
    (["names", "sweep.yaml", "-j", "2"], "--threads is not for `names`"),
    (["commands", "sweep.yaml", "--shard", "0/3"], "--shard 0/3: I/N with I from 1 to N"),
    (["commands", "sweep.yaml", "-j", "many"], "-j many: not a number of threads"),
    (["commands", "sweep.yaml", "--only", "rom=a.env"], "--only rom=a.env: no such axis, did you mean `room`?"),
    (["commands", "sweep.yaml", "--only", "room=c.env"], "--only room=c.env: no such choice"),
    (["names", "sweep.yaml", "--suffix", ".png"], "--suffix .png: the jobs make .3dm, .json"),
    (["join", "sweep.yaml", "-o", "table.xls"], "table.xls: unknown suffix; join writes csv, jsonl, npz"),
    (["join", "sweep.yaml", "-o", "sweep.yaml"], "sweep.yaml is the sweep itself"),
    (["plot", "sweep.yaml"], "--x AXIS is needed"),
    (["plot", "sweep.yaml", "--x", "count", "--by", "count"], "`count` can lie one way alone"),
    (["commands", "sweep.yaml", "--frobnicate"], "unrecognized arguments: --frobnicate"),
]


def errors(folder):
    for text, wanted in ERRORS:
        folder.sweep("commands", text=text, status=1)
        first = folder.talk.splitlines()[0]
        check(first.startswith("ispace-sweep: " + wanted), f"of {text[:80]!r}:\n  wanted {wanted}\n  found  {first}")
        check(len(folder.talk.splitlines()) <= 20 and "Traceback" not in folder.talk, folder.talk)
    folder.sweep("commands", text="run: a\naxes: {n: [" + ", ".join(["[]"] * 50) + "]}", status=1)
    same("findings", 20, len(folder.talk.splitlines()))
    folder.run(PROGRAM, "commands", "none.yaml", status=1)
    same("no file", "ispace-sweep: none.yaml: error: No such file or directory\n", folder.talk)
    folder.write("sweep.yaml", SMALL)
    folder.run(sys.executable, "-S", PROGRAM, "names", "sweep.yaml", status=1)
    same("without PyYAML", "ispace-sweep: error: no PyYAML here: install Debian's python3-yaml\n", folder.talk)
    for words, wanted in USAGE:
        folder.run(PROGRAM, *words, status=2)
        check(folder.talk.startswith("ispace-sweep: " + wanted) and folder.talk.count("\n") == 1,
              f"of {words}:\n  wanted {wanted}\n  found  {folder.talk}")


def outputs(folder):
    folder.sweep("commands", text=SMALL)
    folder.sweep("commands", "-o", "all.sh")
    same("a file", folder.sweep("commands").encode(), folder.read("all.sh"))
    folder.sweep("commands", "-o", "/dev/full", status=1)
    same("a full disk", "ispace-sweep: /dev/full: error: No space left on device\n", folder.talk)
    folder.run("sh", "-c", "ispace-sweep commands sweep.yaml >/dev/full", status=1)
    same("the same", "ispace-sweep: stdout: error: No space left on device\n", folder.talk)
    folder.sweep("commands", "-o", "none/all.sh", status=1)
    check("none" in folder.talk and "No such file" in folder.talk, folder.talk)
    same("standard input", folder.sweep("names"), folder.run("sh", "-c", "ispace-sweep names - <sweep.yaml"))
    same("a closed pipe", "mkdir\n", folder.run("bash", "-c", "ispace-sweep commands sweep.yaml | head -c 5 && echo"))
    left = [name for name in os.listdir(folder.path) if "tmp" in name]
    same("nothing beside", [], left)


for part in (order_and_names, shards, missing, quoting, hostile_names, steps, described, numbers, millions, many, errors, outputs):
    with Folder() as scratch:
        scratch.write("b.env", "#env 1\n")
        scratch.write("a.env", "#env 1\n")
        part(scratch)
