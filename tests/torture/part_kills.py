# SPDX-License-Identifier: GPL-3.0-or-later
"""SIGKILL, TERM and INT at random moments of each tool that writes: the target is the old file or the new one, TERM
and INT leave no temporary file, and a record keeps whole lines."""
import os
import shlex
import signal
import time

import lab as labs

SIGNALS = {"KILL": signal.SIGKILL, "TERM": signal.SIGTERM, "INT": signal.SIGINT}
SCAVENGER = 5  # seconds within which the process that outlives a killed simrun has cut off a piece of a line


class Target:
    def __init__(self, lab, job):
        self.lab, self.job = lab, job
        self.folder = lab.inputs(job.product)
        begin = time.monotonic()
        result = lab.run(job.argv, self.folder)
        if result.status != 0:
            raise SystemExit(f"torture: {shlex.join(job.argv)}: status {result.status}: {result.said()}")
        self.seconds = time.monotonic() - begin
        self.new = labs.product(self.folder, job)
        self.old = self.put_old()

    def put_old(self):
        labs.remove_product(self.folder, self.job)
        if self.job.tool == "simrun":
            return ""
        for suffix in (".yaml", ".pgm") if self.job.product.endswith(".yaml") else (self.job.product[-5:],):
            stem = self.job.product[:-5]
            with open(os.path.join(self.folder, stem + suffix), "w", encoding="ascii") as file:
                file.write("old\n")
        return labs.product(self.folder, self.job)

    def attempt(self, name, delay):
        self.put_old()
        process = self.lab.start(self.job.argv, self.folder)
        time.sleep(delay)
        begin = time.monotonic()
        process.send_signal(SIGNALS[name])
        status = process.wait()
        waited = time.monotonic() - begin
        self.lab.count("kills")
        if status != 0:
            self.lab.count("hits")
        broken = self.judge(name, status, waited)
        if broken:
            self.lab.violated(f"SIG{name} {delay:.4f} s after the start of {shlex.join(self.job.argv)}: {broken}",
                              f"cd {self.folder} && timeout -s {name} {delay:.4f} {self.lab.tool(self.job.tool)} "
                              f"{shlex.join(self.job.argv[1:])}")

    def judge(self, name, status, waited):
        if waited > labs.allowed(2):
            return f"ended {waited:.1f} s later"
        ends = {0, -SIGNALS[name], 128 + SIGNALS[name]}
        if status not in ends:
            return f"status {status}"
        left = labs.stand_ins(self.folder)
        for path in left:
            os.remove(path)
        if left and name != "KILL":
            return f"left behind: {left}"
        if self.job.tool == "simrun":
            return self.judge_record(name)
        made = labs.product(self.folder, self.job)
        # A layout that was cut short is a whole one, too.
        if made in (self.old, self.new) or self.is_layout():
            return ""
        if self.job.product.endswith(".yaml") and name == "KILL" and self.is_half_set():
            self.lab.count("sets of two runs")
            return ""
        return "neither the old file nor the new one"

    def is_layout(self):
        if not self.job.product.endswith(".3dm"):
            return False
        with open(os.path.join(self.folder, self.job.product), encoding="utf-8") as file:
            text = file.read()
        return "complete=no" in text and text.endswith("\n") and "\nresult " in text

    def is_half_set(self):
        """SIGKILL may come between two renames: each file is whole."""
        stem = os.path.join(self.folder, self.job.product[:-5])
        with open(stem + ".pgm", "rb") as pgm:
            content = pgm.read()
        return content == b"old\n" or content.startswith(b"P5")

    def judge_record(self, name):
        folder = os.path.join(self.folder, "run")
        end = time.monotonic() + (labs.patience(SCAVENGER) if name == "KILL" else 0)
        while True:
            torn = list(torn_files(folder))
            if not torn:
                return ""
            if time.monotonic() > end:
                return f"half a line ends {', '.join(torn)}"
            time.sleep(0.02)


def torn_files(folder):
    for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else []:
        path = os.path.join(folder, name)
        if name.endswith((".csv", ".jsonl")) and os.path.getsize(path) > 0:
            with open(path, "rb") as file:
                file.seek(-1, os.SEEK_END)
                if file.read(1) != b"\n":
                    yield name


def run(lab):
    targets = [Target(lab, job) for job in labs.JOBS]
    while lab.left() > 0:
        for target in targets:
            for name in SIGNALS:
                # Early and late moments alike; the last ones come after the end.
                target.attempt(name, target.seconds * 1.1 * lab.random.random() ** lab.random.choice((1, 2)))
