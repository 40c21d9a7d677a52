#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""ispace-sweep run: the lines of a part hold what the jobs' files would, whatever ends it in the middle."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

from sweeping import PROGRAM, Folder, check, same

ROOM = """#env 1
fence path=-4,-3;4,-3;4,3;-4,3 closed=yes
table at=0.5,0.5
inside at=-2,0
"""
TENT = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n"
SWEEP = """
run:
  - arrange {room} --sensor laser,range=3,fov=180:{count} --strategy random --seed {seed} -q -o {out}.3dm
  - coverage {room} {out}.3dm -q --report {out}.json
axes:
  room: {files: [rooms/a.env, ../other/b.env]}
  count: 1..2
  seed: 1..4
"""


def rooms(folder):
    folder.write("here/rooms/a.env", ROOM)
    folder.write("other/b.env", ROOM + "mesh file=more/tent.obj at=-3,-2\n")
    folder.write("other/more/tent.obj", TENT)
    folder.path = folder / "here"


def sweep(folder, action, *words, status=0, **more):
    return folder.run(PROGRAM, action, "sweep.yaml", *words, status=status, **more)


def lines(text):
    if isinstance(text, bytes):
        text = text.decode()
    return [json.loads(line) for line in text.splitlines()]


def by_files(folder):
    """The results as files, by the shell."""
    sweep(folder, "commands", "-o", "all.sh")
    folder.run("sh", "all.sh")


def equals_files(folder):
    """Layouts and reports are those of the shell, byte for byte, with rooms in folders beside and above."""
    folder.write("sweep.yaml", SWEEP)
    by_files(folder)
    table = sweep(folder, "join")
    shutil.move(folder / "results", folder / "by_files")
    sweep(folder, "run", "-o", "part.jsonl")
    check(not os.path.exists(folder / "results"), "files are left")
    head, *jobs = lines(folder.read("part.jsonl"))
    same("the header", ("ispace-results/1", "1/1", 16, 1), (head["schema"], head["shard"], head["jobs"], head["first"]))
    same("the numbers", list(range(1, 17)), [job["job"] for job in jobs])
    for job in jobs:
        same("status", 0, job["status"])
        same(f"the layout of {job['name']}", folder.read(f"by_files/{job['name']}.3dm").decode(), job["files"][".3dm"])
        same(f"the report of {job['name']}", json.loads(folder.read(f"by_files/{job['name']}.json")),
             job["reports"][".json"])
    same("the table", table, sweep(folder, "join", "part.jsonl"))
    same("the table without the sweep", table, folder.run(PROGRAM, "join", "part.jsonl"))
    shutil.move(folder / "by_files", folder / "results")
    for form in ("jsonl", "npz"):
        sweep(folder, "join", "-o", f"files.{form}")
        sweep(folder, "join", "part.jsonl", "-o", f"lines.{form}")
        same(form, folder.read(f"files.{form}"), folder.read(f"lines.{form}"))


def rooms_of_commands(folder):
    """Rooms that commands name themselves, above and by absolute names, are found, and the same way from layouts."""
    os.symlink("rooms", folder / "link")
    for name in ("../other/b.env", str(folder / "rooms/a.env"), str(folder / "../other/b.env"), "link/a.env",
                 str(folder / "link/a.env")):
        folder.write("sweep.yaml", SWEEP.replace("{room}", name).replace("axes:\n", "axes:\n  #").replace("1..4", "1"))
        by_files(folder)
        wanted = folder.read("results/count1_seed1.3dm").decode()
        shutil.rmtree(folder / "results")
        deep = folder / "deep/er/tmp"
        os.makedirs(deep, exist_ok=True)
        for place in ("", str(deep)):
            job = lines(sweep(folder, "run", env=dict(os.environ, TMPDIR=place)))[1]
            same(f"status with {name}", 0, job["status"])
            same(f"a layout of {name} made in {place}", wanted, job["files"][".3dm"])


def shares(folder):
    """Shares, jobs at a time and standard output make the same lines."""
    folder.write("sweep.yaml", SWEEP)
    whole = sweep(folder, "run", "-j", "1").split("\n", 1)[1]
    same("three at a time", whole, sweep(folder, "run", "-j", "3").split("\n", 1)[1])
    joined = ""
    for index in range(1, 6):
        sweep(folder, "run", "--shard", f"{index}/5", "-o", f"{index}.jsonl")
        joined += folder.read(f"{index}.jsonl").decode().split("\n", 1)[1]
    same("shares", whole, joined)
    parts = [f"{index}.jsonl" for index in (4, 2, 5, 1, 3)]
    folder.write("part.jsonl", sweep(folder, "run"))
    same("parts in any order", sweep(folder, "join", "part.jsonl"), sweep(folder, "join", *parts))
    state = json.loads(sweep(folder, "status", *parts, "--json"))
    same("their status", (16, 16, 0, 0, 5), tuple(state[key] for key in ("jobs", "done", "failed", "left", "parts")))
    folder.write("6.jsonl", folder.read("1.jsonl"))
    sweep(folder, "join", "6.jsonl", *parts, status=1)
    check("give each part once" in folder.talk, folder.talk)
    sweep(folder, "join", "2.jsonl", status=1)
    check("13 of 16 jobs are not done" in folder.talk, folder.talk)
    same("rows of one", 4, sweep(folder, "join", "2.jsonl", "--partial", "-q").count("\n"))
    only = sweep(folder, "run", "--only", "count=2", "--only", "seed=3")
    same("--only keeps numbers", [7, 15], [job["job"] for job in lines(only)[1:]])


def ends_in_the_middle(folder):
    """A kill at any time loses no line and doubles none; what it leaves is removed by the next run."""
    folder.write("sweep.yaml", SWEEP)
    scratch = folder / "scratch"
    os.makedirs(scratch)
    more = {"env": {**os.environ, "TMPDIR": scratch}}
    wanted = sweep(folder, "run", **more)
    for number in (signal.SIGKILL, signal.SIGTERM):
        kills = 0
        for _ in range(40):
            with subprocess.Popen([PROGRAM, "run", "sweep.yaml", "-q", "-o", "part.jsonl", "-j", "2"], cwd=folder.path,
                                  **more) as running:
                begin = folder_size(folder, "part.jsonl")
                for _ in range(2000):
                    if folder_size(folder, "part.jsonl") > begin + 3000 or running.poll() is not None:
                        break
                    time.sleep(0.005)
                running.send_signal(number)
                status = running.wait()
            if status == 0:
                break
            same("the status of a kill", -number, status)
            kills += 1
        check(kills > 0, "it was never killed in the middle")
        sweep(folder, "run", "-o", "part.jsonl", **more)
        check(folder.read("part.jsonl").decode() == wanted, f"other bytes after {kills} kills")
        same("scratch folders", [], [name for name in os.listdir(scratch) if name.startswith("ispace-sweep.")])
        os.unlink(folder / "part.jsonl")
    # Every cut of the file continues to the same bytes.
    head = wanted.index("\n") + 1
    for cut in (0, 5, head - 1, head, head + 1, head + 700, len(wanted) - 1):
        folder.write("part.jsonl", wanted[:cut])
        sweep(folder, "run", "-o", "part.jsonl", **more)
        check(folder.read("part.jsonl").decode() == wanted, f"cut at {cut}, the run continues to other bytes")
    folder.write("part.jsonl", "mine\n")
    sweep(folder, "run", "-o", "part.jsonl", status=1, **more)
    same("another file", b"mine\n", folder.read("part.jsonl"))


def until(is_so):
    """Waits for a minute at most."""
    for _ in range(1200):
        if is_so():
            return
        time.sleep(0.05)
    sys.exit("failed: in vain")


def folder_size(folder, name):
    try:
        return os.path.getsize(folder / name)
    except OSError:
        return 0


FAILING = """
run:
  - sh -c 'echo told $0 >&2; test "$0" != 3 || test -e {fixed} || exit 7; echo $0' {n} > {out}.txt
  - cp {out}.txt {out}.b.txt
axes: {n: 1..5, fixed: FIXED}
"""


def failures(folder):
    """A job that fails ends no other, and is listed with its command."""
    fixed = folder / "fixed"
    folder.write("sweep.yaml", FAILING.replace("FIXED", "[" + json.dumps(fixed) + "]"))
    sweep(folder, "run", "-o", "part.jsonl", status=1)
    same("what is said", 2, folder.talk.count("\n"))
    check("job 3" in folder.talk and "status 7" in folder.talk and "1 job failed" in folder.talk, folder.talk)
    jobs = lines(folder.read("part.jsonl"))[1:]
    same("statuses", [0, 0, 7, 0, 0], [job["status"] for job in jobs])
    same("texts", "5\n", jobs[4]["files"][".b.txt"])
    same("messages", "told 3\n", jobs[2]["messages"])
    listed = sweep(folder, "status", "part.jsonl", "--failed")
    check(listed.startswith("job 3 ") and "sh -c" in listed and listed.count("\n") == 1, listed)
    same("as JSON", 3, lines(sweep(folder, "status", "part.jsonl", "--failed", "--json"))[0]["job"])
    same("rows", 5, sweep(folder, "join", "part.jsonl", "--partial", "-q").count("\n"))
    sweep(folder, "run", "-o", "part.jsonl", status=1)  # again: all is done
    folder.write("fixed", "")
    sweep(folder, "run", "-o", "part.jsonl", "--retry")
    same("after --retry", [0] * 5, [job["status"] for job in lines(folder.read("part.jsonl"))[1:]])
    folder.write("sweep.yaml", "run: no-such-program {n} -o {out}.x\naxes: {n: 1}\n")
    sweep(folder, "run", status=1)
    check("status 127" in folder.talk and "No such file" in folder.talk, folder.talk)
    folder.write("sweep.yaml", "run: \"true {n} -o {out}.x\"\naxes: {n: 1}\n")
    sweep(folder, "run", status=1)
    check("not written by this step" in folder.talk, folder.talk)


def others(folder):
    """What lies in the folder already stays, and is no result of a job."""
    folder.write("sweep.yaml", "run: sh -c 'test $0 = 2 || echo new $0' {n} > {out}.txt\naxes: {n: 1..2}\n")
    for number in (1, 2):
        folder.write(f"results/n{number}.txt", "old\n")
    sweep(folder, "run", "-o", "part.jsonl", status=1)
    jobs = lines(folder.read("part.jsonl"))[1:]
    same("statuses", [0, 1], [job["status"] for job in jobs])
    same("the new file", "new 1\n", jobs[0]["files"][".txt"])
    same("the old files", [b"old\n"] * 2, [folder.read(f"results/n{number}.txt") for number in (1, 2)])
    # Two at a time on one part: the second is refused, and the first loses no line.
    step = "test -e {fixed} || exit 1; while ! test -e {fixed}.go; do sleep 0.05; done; echo $0"
    folder.write("sweep.yaml", f"run: sh -c '{step}' {{n}} > {{out}}.txt\n"
                 f"axes: {{n: 1..6, fixed: [{json.dumps(folder / 'fixed')}]}}\n")
    sweep(folder, "run", "-o", "again.jsonl", "-q", status=1)
    folder.write("fixed", "")
    with subprocess.Popen([PROGRAM, "run", "sweep.yaml", "--retry", "-j", "1", "-o", "again.jsonl"],
                          cwd=folder.path) as first:
        until(lambda: os.path.exists(folder / "again.jsonl.retry"))
        for words in (["--retry"], []):
            sweep(folder, "run", "-o", "again.jsonl", *words, status=1)
            check("another run is writing it" in folder.talk, folder.talk)
        folder.write("fixed.go", "")
        same("the first retry", 0, first.wait())
    same("its lines", list(range(1, 7)), [job["job"] for job in lines(folder.read("again.jsonl"))[1:]])
    # Parts of --only interleave.
    folder.write("sweep.yaml", "run: echo {m} {n} > {out}.txt\naxes: {m: [x, y], n: 1..2}\n")
    for number in (1, 2):
        sweep(folder, "run", "--only", f"n={number}", "-o", f"only{number}.jsonl")
    joined = sweep(folder, "join", "only2.jsonl", "only1.jsonl")
    same("numbers of interleaved parts", ["1", "2", "3", "4"], [row.split(",")[0] for row in joined.splitlines()[1:]])
    folder.write("sweep.yaml", f"run: echo {{n}} > {{out}}.txt\naxes: {{n: 1..2}}\nfolder: {folder / 'there'}\n")
    sweep(folder, "run", status=2)
    check("run needs a relative folder" in folder.talk, folder.talk)


STEPS = """
run: sh -c 'until test -e {go} -o $0 -le 3; do sleep 0.02; done; echo $0' {n} > {out}.txt
axes: {n: 1..12, go: GO}
"""


def states_of_parts(folder):
    """`status` counts the lines of parts, and tells runs at work from those that a signal ended."""
    folder.write("sweep.yaml", STEPS.replace("GO", "[" + json.dumps(folder / "go") + "]"))
    for number in (signal.SIGKILL, signal.SIGINT):
        with subprocess.Popen([PROGRAM, "run", "sweep.yaml", "--shard", "1/2", "-j", "1", "-o", "1.jsonl"],
                              cwd=folder.path) as running:
            until(lambda: folder_size(folder, "1.jsonl") and folder.read("1.jsonl").count(b"\n") == 4)
            state = json.loads(sweep(folder, "status", "1.jsonl", "--json"))
            same("at work", (12, 3, 9, 1, 0), tuple(state[key] for key in ("jobs", "done", "left", "running", "stopped")))
            running.send_signal(number)
            same("the status of a kill", -number, running.wait())
        if number == signal.SIGINT:
            same("the end is written", True, lines(folder.read("1.jsonl.status"))[0]["ended"])
        # A signal between a line and the file beside the part.
        told = lines(folder.read("1.jsonl.status"))[0]
        folder.write("1.jsonl.status", json.dumps({**told, "done": 1, "fresh": 1, "now": time.time()}) + "\n")
        state = json.loads(sweep(folder, "status", "1.jsonl", "--json"))
        same("after it", (12, 3, 9, 0, 1, 0), tuple(state[key] for key in ("jobs", "done", "left", "running", "stopped",
                                                                           "rate")))
        found = sweep(folder, "status", "1.jsonl")
        check("parts    1: 0 complete, 0 being written, 1 stopped\n" in found and "no run is at work" in found and
              "stopped  1.jsonl: 3 of 6 jobs of shard 1/2; the same `run` continues it\n" in found and
              "absent   shard 2/2: not among these parts\n" in found, found)
        same("without the sweep", 6, json.loads(folder.run(PROGRAM, "status", "1.jsonl", "--json"))["jobs"])
        os.unlink(folder / "1.jsonl")
    # The lock of another machine may be invisible here: its run tells that it is alive.
    folder.write("go", "")
    sweep(folder, "run", "--shard", "1/2", "-o", "1.jsonl")
    told = lines(folder.read("1.jsonl.status"))[0]
    folder.write("1.jsonl", b"".join(folder.read("1.jsonl").splitlines(True)[:-2]))
    for ago, running in ((1, 1), (3600, 0)):
        far = {**told, "host": told["host"] + "x", "ended": False, "now": time.time() - ago}
        folder.write("1.jsonl.status", json.dumps(far) + "\n")
        same(f"{ago} s ago", running, json.loads(sweep(folder, "status", "1.jsonl", "--json"))["running"])
    folder.run(PROGRAM, "status", "1.jsonl", "--only", "n=1", status=2)
    check("give the sweep before its parts" in folder.talk, folder.talk)
    folder.run(PROGRAM, "commands", "1.jsonl", status=2)
    check("1.jsonl holds results: the sweep comes first, `ispace-sweep commands sweep.yaml`" in folder.talk, folder.talk)
    folder.write("table.jsonl", sweep(folder, "join", "1.jsonl", "--partial", "-q", "--to", "jsonl"))
    for action in ("status", "join"):  # a table, and a file that a kill left empty
        for name in ("table.jsonl", "empty.jsonl"):
            folder.write("empty.jsonl", "")
            folder.run(PROGRAM, action, name, status=1)
            check(folder.talk.startswith(f"ispace-sweep: {name}:1:1: error: no results of `ispace-sweep run`") and
                  folder.talk.count("\n") == 1, folder.talk)
    folder.write("sweep.yaml", STEPS.replace("GO", "[" + json.dumps(folder / "go") + "]") + "# other\n")
    sweep(folder, "status", "1.jsonl", status=1)
    check("1.jsonl: error: of another state of sweep.yaml" in folder.talk, folder.talk)


def parts_that_lack_jobs(folder):
    """`join` says which parts lack jobs; `commands --missing` lists these jobs, and so do `names` and JSON."""
    text = "run: sh -c 'test $0 != 5 && echo $0' {n} > {out}.txt\naxes: {n: 1..9}\n"
    folder.write("sweep.yaml", text)
    for index in (1, 2, 3):
        sweep(folder, "run", "--shard", f"{index}/3", "-q", "-o", f"part {index}.jsonl", status=index == 2)
    second = folder.read("part 2.jsonl")
    folder.write("part 2.jsonl", b"".join(second.splitlines(True)[:-1]))  # header, 4, and 5, which failed
    for named in (["sweep.yaml"], []):
        folder.run(PROGRAM, "join", *named, "part 1.jsonl", "part 2.jsonl", status=1)
        lacks = 5 if named else 2
        same("what is said", [
            "ispace-sweep: part 2.jsonl: error: 2 of 3 jobs of shard 2/3: "
            "`ispace-sweep run sweep.yaml --shard 2/3 -o 'part 2.jsonl'` continues it",
            "ispace-sweep: error: shard 3/3: not among these parts: "
            "`ispace-sweep run sweep.yaml --shard 3/3 -o part3.jsonl` runs it",
            "ispace-sweep: error: job 5 (n5) failed with status 1",
            f"ispace-sweep: error: {lacks} of {9 if named else 6} jobs are not done: `ispace-sweep commands sweep.yaml "
            "'part 1.jsonl' 'part 2.jsonl' --missing` lists them, --partial does without them"], folder.talk.splitlines())
    listing = folder.talk.split("`")[-2].removeprefix("ispace-sweep ")
    found = folder.run("sh", "-c", f"{PROGRAM} {listing}").splitlines()
    whole = sweep(folder, "commands").splitlines()
    same("as it says", [whole[number - 1] for number in (5, 6, 7, 8, 9)], found)
    same("by names", "".join(f"results/n{number}.txt\n" for number in (5, 6, 7, 8, 9)),
         sweep(folder, "names", "part 2.jsonl", "part 1.jsonl", "--missing"))
    told = lines(sweep(folder, "commands", "part 2.jsonl", "part 1.jsonl", "--missing", "--json", "--shard", "2/3"))
    same("by JSON, of a shard", [5, 6], [job["job"] for job in told[1:]])
    for number in (1, 2, 3, 4):
        folder.write(f"results/n{number}.txt", "x\n")  # files do not count
    same("with files", found, sweep(folder, "commands", "part 1.jsonl", "part 2.jsonl", "--missing").splitlines())
    folder.run(PROGRAM, "commands", "sweep.yaml", "part 1.jsonl", status=2)
    check("part 1.jsonl: `commands` takes parts with --missing" in folder.talk, folder.talk)
    folder.run(PROGRAM, "join", "part 1.jsonl", "part 3.jsonl")
    same("of a share that is not given", "ispace-sweep: warning: shard 2/3: not among these parts\n", folder.talk)
    # A part with its header alone, and many parts.
    folder.write("part 2.jsonl", second.splitlines(True)[0])
    folder.run(PROGRAM, "join", "part 2.jsonl", status=1)
    check("0 of 3 jobs of shard 2/3" in folder.talk and "no job is done" in folder.talk, folder.talk)
    folder.write("sweep.yaml", "run: echo {n} > {out}.txt\naxes: {n: 1..9}\n")
    parts = [f"{index}.jsonl" for index in (1, 2, 3, 4, 5)]
    for index, part in enumerate(parts, 1):
        sweep(folder, "run", "--shard", f"{index}/9", "-o", part)
    sweep(folder, "join", *parts, status=1)
    check("error: shards 6/9, 7/9, 8/9, 9/9: not among these parts: `ispace-sweep run sweep.yaml --shard 6/9 -o "
          "part6.jsonl` runs the first\n" in folder.talk, folder.talk)
    check("`ispace-sweep commands sweep.yaml PART... --missing`" in folder.talk, folder.talk)


def grown(folder):
    """--reuse takes the lines of a sweep before it grew: the bytes of a new run, and only new jobs run."""
    text = "run: sh -c 'echo $0 $1 >>{log}; echo $0-$1' {n} {m} > {out}.txt\naxes:\n  n: 1..3\n  m: [M]\n  log: [LOG]\n"
    text = text.replace("LOG", folder / "log")

    def ran():
        found = folder.read("log").decode().split("\n")[:-1] if os.path.exists(folder / "log") else []
        folder.write("log", "")
        return sorted(found)

    folder.write("sweep.yaml", text.replace("M", "a, b"))
    for index in (1, 2):
        sweep(folder, "run", "--shard", f"{index}/2", "-o", f"old{index}.jsonl")
    same("at first", ["1 a", "1 b", "2 a", "2 b", "3 a", "3 b"], ran())
    folder.write("old2.jsonl", folder.read("old2.jsonl")[:-20])  # a kill cut off the line of the sixth job
    folder.write("sweep.yaml", text.replace("M", "c, a, b"))
    sweep(folder, "run", "--shard", "1/2", "-o", "old1.jsonl", status=1)
    same("what is said", "ispace-sweep: old1.jsonl: error: made before sweep.yaml was changed: give -o another name, and "
         "--reuse old1.jsonl to take over the lines of equal jobs\n", folder.talk)
    sweep(folder, "run", "-o", "new.jsonl", "--reuse", "old1.jsonl", "old2.jsonl")
    same("new jobs", ["1 c", "2 c", "3 b", "3 c"], ran())
    same("what is said of reuse", "ispace-sweep: note: 5 jobs are those of old1.jsonl, old2.jsonl, 4 ran\n", folder.talk)
    status = json.loads(folder.read("new.jsonl.status"))
    same("jobs of this run by the file beside the part", (9, 4), (status["done"], status["fresh"]))
    same("the bytes of a new run", sweep(folder, "run").encode(), folder.read("new.jsonl"))
    ran()
    # Other shares of the same sweep.
    sweep(folder, "run", "-o", "new.jsonl", "--shard", "2/3", status=1)
    check("new.jsonl: error: shard 1/1 of this sweep, not 2/3: give -o another name, and --reuse" in folder.talk, folder.talk)
    sweep(folder, "run", "-o", "new.jsonl", "--only", "m=a", status=1)
    check("new.jsonl: error: made with other rules of --only: " in folder.talk, folder.talk)
    for index in (1, 2, 3):
        sweep(folder, "run", "--shard", f"{index}/3", "-o", f"{index}.jsonl", "--reuse", "new.jsonl")
    same("no job runs again", [], ran())
    same("the table", sweep(folder, "join", "new.jsonl"), sweep(folder, "join", "1.jsonl", "2.jsonl", "3.jsonl"))
    # Other commands, and other files of the same commands, are other jobs; so is one that failed.
    for other in (text.replace("$0-$1", "$1-$0"), text.replace("{out}.txt", "{out}.dat")):
        folder.write("sweep.yaml", other.replace("M", "a"))
        sweep(folder, "run", "-o", "other.jsonl", "--reuse", "new.jsonl")
        same("all run", ["1 a", "2 a", "3 a"], ran())
        check("warning: --reuse: these parts have no job of this run" in folder.talk, folder.talk)
        os.unlink(folder / "other.jsonl")
    folder.write("sweep.yaml", text.replace("M", "a"))
    folder.write("failed.jsonl", folder.read("new.jsonl").replace(b'"status":0', b'"status":1'))
    sweep(folder, "run", "-o", "other.jsonl", "--reuse", "failed.jsonl")
    same("what failed runs again", ["1 a", "2 a", "3 a"], ran())
    folder.write("failed.jsonl", folder.read("new.jsonl").replace(b'"version":"', b'"version":"9', 1))
    for words, status, wanted in ((["-o", "x.jsonl", "--reuse", "failed.jsonl"], 1, "error: made by version 9"),
                                  (["-o", "failed.jsonl"], 1, "error: made by version 9"),
                                  (["-o", "other.jsonl", "--reuse", "other.jsonl"], 2, "is one of the parts"),
                                  (["-o", "x.jsonl", "--reuse", "sweep.yaml"], 1, "no results of `ispace-sweep run`"),
                                  (["-o", "x.jsonl", "--reuse", "none.jsonl"], 1, "none.jsonl: error: No such file")):
        sweep(folder, "run", *words, status=status)
        check(wanted in folder.talk and folder.talk.count("\n") == 1, folder.talk)
    sweep(folder, "join", "--reuse", "new.jsonl", status=2)
    check("--reuse is not for `join`" in folder.talk, folder.talk)


def inputs_stay(folder):
    """A job whose output is its room fails, as it would alone: no output replaces a file that was read."""
    folder.write("sweep.yaml", """
run:
  - arrange rooms/a.env --sensor laser,range=3 --strategy random -q -o {out}.3dm
  - scan rooms/a.env {out}.3dm --to jsonl -q -o {onto} > {out}.txt
axes:
  onto: rooms/a.env
""")
    rows = lines(sweep(folder, "run", "-j", "1", status=1))[1:]
    same("statuses", [2], [row["status"] for row in rows])
    check("rooms/a.env is read by this command" in rows[0]["messages"], rows[0]["messages"])
    same("the room", ROOM, folder.read("rooms/a.env").decode())


def errors(folder):
    folder.write("sweep.yaml", "run: cp rooms/a.env {out}.{n}.env\naxes: {n: 1}\n".replace("{out}.{n}.env", "{out}.env")
                 .replace("cp", "cp -{n}").replace("axes: {n: 1}", "axes: {n: [f, p]}"))
    sweep(folder, "run", "-o", "part.jsonl")
    with subprocess.Popen(["flock", "part.jsonl", "sleep", "30"], cwd=folder.path) as holder:
        until(lambda: subprocess.run(["flock", "-n", "part.jsonl", "true"], cwd=folder.path, check=False).returncode)
        sweep(folder, "run", "-o", "part.jsonl", status=1)
        check("another run is writing it" in folder.talk, folder.talk)
        holder.kill()
    for words, status, wanted in (
            (["status"], 2, "status needs the parts"),
            (["run", "x.jsonl"], 2, "`run` takes one sweep"),
            (["join", "sweep.yaml.none"], 1, "No such file"),
            (["join", "sweep.yaml"], 1, "no results of `ispace-sweep run`"),
            (["run", "-o", "/dev/full"], 2, "a regular file, or standard output"),
            (["run", "--missing"], 2, "--missing is not for `run`")):
        folder.run(PROGRAM, words[0], "sweep.yaml", *words[1:], status=status)
        check(wanted in folder.talk and folder.talk.count("\n") == 1, f"of {words}: {folder.talk}")
    # Bytes that are no request.
    for bytes_sent in ("x\n", "3\nab\0", "99999999999\n", "2\na\0", "4\nabc\n", "5"):
        folder.run("envc", "--serve-jobs", status=2, input=bytes_sent)
        check("--serve-jobs" in folder.talk and folder.talk.count("\n") == 1, folder.talk)
    folder.run("sh", "-c", "ispace-sweep run sweep.yaml >/dev/full", status=1)
    check("stdout: error: No space left" in folder.talk, folder.talk)


for part in (equals_files, rooms_of_commands, shares, ends_in_the_middle, failures, states_of_parts,
             parts_that_lack_jobs, grown, others, inputs_stay, errors):
    with Folder() as scratch_folder:
        whole = scratch_folder.path
        rooms(scratch_folder)
        try:
            part(scratch_folder)
        finally:
            scratch_folder.path = whole
