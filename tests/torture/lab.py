# SPDX-License-Identifier: GPL-3.0-or-later
"""A lab: the tools, a scratch folder, a seed and a deadline for one part of the torture, and its counts."""
import hashlib
import os
import random
import shlex
import shutil
import signal
import subprocess
import threading
import time

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
DATA = os.path.join(SOURCE, "tests", "data")
SCENES = os.path.join(SOURCE, "share", "scenes")
TOOLS = ("envc", "arrange", "scan", "coverage", "simrun")
MIB = 1 << 20
MOST_TOLD = 20  # violations that one part prints


class Job:
    """A command of one tool that writes a product. The command has relative names and runs in a folder with INPUTS."""

    def __init__(self, product, *argv):
        self.argv, self.product, self.tool = list(argv), product, argv[0]


# The first word of each command is the tool; inputs are those of Inputs.
JOBS = (
    Job("room.out.glb", "envc", "crowded.env", "-o", "room.out.glb"),
    Job("map.yaml", "envc", "crowded.env", "--to", "ros", "-o", "map.yaml"),
    Job("best.out.3dm", "arrange", "room.glb", "--sensor", "laser,range=4,fov=180:3", "--strategy", "grid",
        "-X", "6", "-Y", "6", "--deg", "8", "-q", "-o", "best.out.3dm"),
    Job("scans.jsonl", "scan", "room.glb", "more.3dm", "--noise", "--frames", "10", "-o", "scans.jsonl"),
    Job("map.png", "coverage", "room.glb", "best.3dm", "-o", "map.png"),
    Job("run", "simrun", "room.env", "robots.3dm", "--until", "5", "--clock", "fast", "--record", "run"),
)


class Result:
    """The end of a command: status (negative for a signal, None if it had to be killed), output, seconds, bytes."""

    def __init__(self, status, out, err, wall, usage):
        self.status, self.out, self.err, self.wall = status, out, err, wall
        self.cpu, self.rss = usage.ru_utime, usage.ru_maxrss * 1024

    def said(self):
        return self.err.decode(errors="replace")


class Lab:
    def __init__(self, build, name, seed, minutes, share):
        """`share` of the minutes are for this part."""
        self.name, self.seed, self.build = name, seed, os.path.abspath(build)
        self.random = random.Random(f"{seed} {name}")
        self.minutes, self.seconds = minutes, 60 * minutes * share
        self.deadline = time.monotonic() + self.seconds
        self.folder = os.path.join(self.build, "torture", name)
        self.counts, self.violations = {}, 0
        self.environment = {**os.environ, "PATH": f"{self.build}/bin:{os.environ.get('PATH', '')}", "LC_ALL": "C"}
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)

    def left(self):
        return self.deadline - time.monotonic()

    def count(self, what, n=1):
        self.counts[what] = self.counts.get(what, 0) + n

    def say(self, text):
        print(f"torture: {self.name}: {text}", flush=True)

    def violated(self, text, repeat=""):
        self.violations += 1
        if self.violations <= MOST_TOLD:
            self.say("VIOLATED: " + text + (f"\n    again: {repeat}" if repeat else ""))

    def tool(self, name):
        return os.path.join(self.build, "bin", name)

    def inputs(self, name):
        """A new folder with the inputs of JOBS."""
        folder = os.path.join(self.folder, name)
        os.makedirs(folder)
        for file in ("room.env", "robots.3dm"):
            shutil.copy(os.path.join(DATA, file), folder)
        shutil.copy(os.path.join(SCENES, "crowded.env"), folder)
        for argv in (["envc", "crowded.env", "-o", "room.glb"],
                     ["arrange", "-q", "room.glb", "--sensor", "laser,range=4,fov=180:3", "--strategy", "grid",
                      "-X", "6", "-Y", "6", "--deg", "8", "-o", "best.3dm"]):
            result = self.run(argv, cwd=folder)
            if result.status != 0:
                raise SystemExit(f"torture: {shlex.join(argv)}: status {result.status}: {result.said()}")
        with open(os.path.join(folder, "best.3dm"), encoding="utf-8") as best, \
                open(os.path.join(folder, "more.3dm"), "w", encoding="utf-8") as more:
            more.write(best.read() + "ranger id=k at=-1,0,1 heading=40 tilt=-20 pixels=64,48 sigma=0.01\n")
        return folder

    def start(self, argv, cwd, env=None, out=subprocess.DEVNULL, err=subprocess.DEVNULL, stdin=subprocess.DEVNULL,
              umask=-1):
        """The command in a separate session, the tool from the build."""
        return subprocess.Popen([self.tool(argv[0]) if argv[0] in TOOLS else argv[0], *argv[1:]], cwd=cwd,
                                env=self.environment if env is None else env, stdin=stdin, stdout=out, stderr=err,
                                start_new_session=True, umask=umask)

    def run(self, argv, cwd, limit=60, **how):
        """Runs a command to its end, or kills it and all it started after `limit` seconds."""
        names = [os.path.join(self.folder, name) for name in (".out", ".err")]
        with open(names[0], "wb") as out, open(names[1], "wb") as err:
            begin = time.monotonic()
            process = self.start(argv, cwd, out=out, err=err, **how)
            late = threading.Event()

            def kill():
                late.set()
                kill_session(process.pid)

            timer = threading.Timer(limit, kill)
            timer.start()
            _, status, usage = os.wait4(process.pid, 0)
            timer.cancel()
            wall = time.monotonic() - begin
            process.returncode = os.waitstatus_to_exitcode(status)
            kill_session(process.pid)  # a child that outlived it
        texts = []
        for name in names:
            with open(name, "rb") as file:
                texts.append(file.read())
        return Result(None if late.is_set() else process.returncode, *texts, wall, usage)


def kill_session(leader):
    try:
        os.killpg(leader, signal.SIGKILL)
    except ProcessLookupError:
        pass


def patience(seconds):
    """More seconds on a machine that does something else besides, three times as many at most."""
    return seconds * min(3, max(1, os.getloadavg()[0] / os.cpu_count()))


# How many times as long answers and ends may take: --patience.
slowness = 1.0


def allowed(seconds):
    """The limit of a time that is judged."""
    return patience(seconds) * slowness


def product(folder, job):
    """A digest of all files of the job, without the parts that differ from run to run; "" without files."""
    path = os.path.join(folder, job.product)
    files = [path]
    if os.path.isdir(path):
        files = sorted(os.path.join(where, name) for where, _, names in os.walk(path) for name in names)
    elif path.endswith(".yaml"):
        files.append(path[:-5] + ".pgm")
    digest, found = hashlib.sha256(), False
    for file in files:
        if os.path.exists(file) and os.path.basename(file) != "timing.csv":
            found = True
            with open(file, "rb") as content:
                digest.update(os.path.relpath(file, folder).encode() + b"\0" + content.read())
    return digest.hexdigest() if found else ""


def remove_product(folder, job):
    path = os.path.join(folder, job.product)
    shutil.rmtree(path, ignore_errors=True)
    for file in (path, path[:-5] + ".pgm" if path.endswith(".yaml") else path):
        if os.path.lexists(file) and not os.path.isdir(file):
            os.remove(file)


def stand_ins(folder):
    """Temporary files of the tools that are left below the folder."""
    return [os.path.join(where, name) for where, folders, names in os.walk(folder)
            for name in names + folders if name.startswith(".ispace.tmp")]
