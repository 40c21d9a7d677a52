# SPDX-License-Identifier: GPL-3.0-or-later
"""Every n-th allocation and system call fails, for a command of each tool.

It ends with status 1 and one line, or completes its work if the fault does no harm; it neither crashes nor hangs,
and the target is the old file or the new one. Calls that are interrupted, or do less than requested, change no
byte.
"""
import os
import re
import shlex
import shutil
import signal
import struct
import subprocess

import lab as labs

HERE = os.path.dirname(os.path.abspath(__file__))
KINDS = ("alloc", "call", "short")
# Embree 3.13 destroys the task group of a build that memory ended between its start and its wait; TBB throws there,
# and the process ends: std::terminate below a destructor of the library's, which no caller can catch.
ENDED_BY_EMBREE = re.compile(r"(?:\S*libstdc\+\+\S+\n){2}\S*libembree3")
LIMIT = 30  # seconds after which a command hangs; one takes a tenth of one


class Target:
    """One job, its product without faults, and how often each kind is counted."""

    def __init__(self, lab, library, job):
        self.lab, self.library, self.job = lab, library, job
        self.folder = lab.inputs(f"{job.tool}-{job.product}")
        status, said = self.attempt("alloc", 0, 0)
        if status != 0:
            raise SystemExit(f"torture: {shlex.join(job.argv)}: status {status}: {said}")
        self.whole = labs.product(self.folder, job)
        with open(self.counts, "rb") as file:
            alloc, call = struct.unpack("qq", file.read(16))
        self.totals = {"alloc": alloc, "call": call, "short": call}

    def environment(self, kind, n, most):
        self.counts = os.path.join(self.lab.folder, "counts")
        return {"LD_PRELOAD": self.library, "FAULT": f"{kind},{n},{most}", "FAULT_COUNTS": self.counts}

    def attempt(self, kind, n, most, threads=1):
        labs.remove_product(self.folder, self.job)
        faults = self.environment(kind, n, most)
        if os.path.exists(self.counts):
            os.remove(self.counts)
        result = self.lab.run([*self.job.argv, "-j", str(threads)], self.folder, LIMIT,
                              env={**self.lab.environment, **faults})
        self.lab.count("faults")
        return result.status, result.said()

    def check(self, kind, n, most, threads):
        status, said = self.attempt(kind, n, most, threads)
        broken = self.judge(kind, status, said)
        left = labs.stand_ins(self.folder)
        if left and not broken:
            broken = f"left behind: {left}"
        for path in left:
            shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
        if broken:
            faults = " ".join(f"{key}={value}" for key, value in self.environment(kind, n, most).items())
            self.lab.violated(f"{kind} {n} of {self.totals[kind]} fails ({most or 'all from there on'}): {broken}",
                              f"cd {self.folder} && {faults} {self.lab.tool(self.job.tool)} "
                              f"{shlex.join(self.job.argv[1:])} -j {threads}")

    def judge(self, kind, status, said):
        """Describes the violation by that end, or ""."""
        job, made = self.job, labs.product(self.folder, self.job)
        if status is None:
            return f"hangs for {LIMIT} s"
        if status == 0:
            return "" if made == self.whole else "status 0, but another product"
        if kind == "short":
            return f"status {status}: {said}"
        if status == -signal.SIGABRT and ENDED_BY_EMBREE.search(said):
            self.lab.count("ends in Embree")
            return ""
        if status != 1:
            return f"status {status}: {said}"
        lines = said.splitlines()
        if len(lines) != 1 or not re.match(rf"{job.tool}: .*error: .", said):
            return f"not one line of error: {said}"
        self.lab.count("errors")
        # A record is kept up to the fault.
        return "" if job.tool == "simrun" or made in ("", self.whole) else "half a product under its name"


def build_library(lab):
    library = os.path.join(lab.folder, "faults.so")
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-U_FORTIFY_SOURCE", os.path.join(HERE, "faults.c"), "-o", library,
                    "-ldl"], check=True)
    return library


def orders(lab, targets):
    """Faults without end: the first calls of each target in turn, and any other ones in between."""
    n = 0
    while True:
        n += 1
        for target in targets:
            for kind in KINDS:
                total = target.totals[kind]
                drawn = min(total, int(total ** lab.random.random()) + 1)
                # Threads count in any order, which reaches more states and is not repeated exactly.
                yield target, kind, n if n <= total and kind != "alloc" else drawn, lab.random.choice((0, 1, 1, 3)), 1
                yield target, kind, lab.random.randint(1, max(1, total)), lab.random.choice((0, 1, 5)), 2


def run(lab):
    if not shutil.which("cc"):
        lab.say("left out: no C compiler")
        return
    library = build_library(lab)
    targets = [Target(lab, library, job) for job in labs.JOBS]
    lab.say("; ".join(f"{target.job.tool} {target.totals['alloc']} allocations, {target.totals['call']} calls"
                      for target in targets))
    for target, kind, n, most, threads in orders(lab, targets):
        if lab.left() <= 0:
            break
        target.check(kind, n, most, threads)
