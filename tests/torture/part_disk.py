# SPDX-License-Identifier: GPL-3.0-or-later
"""A small disk that is full at any byte of the output of a command of each tool: one line of error and status 1, the
old file stays, and a record ends with whole lines."""
import os
import shlex
import subprocess

import lab as labs
import part_kills

SIZE = 2 * labs.MIB


class Disk:
    """A tmpfs with the inputs of one job and ballast that leaves as much free as is asked for."""

    def __init__(self, lab, job):
        self.lab, self.job = lab, job
        plain = lab.inputs("plain-" + job.product)
        status = lab.run(job.argv, plain).status
        if status != 0:
            raise SystemExit(f"torture: {shlex.join(job.argv)}: status {status}")
        self.whole, self.need = labs.product(plain, job), measure(plain, job)
        self.folder = os.path.join(lab.folder, "disk-" + job.product)
        os.mkdir(self.folder)
        self.mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs", self.folder],
                                      stderr=subprocess.DEVNULL, check=False).returncode == 0
        if self.mounted:
            subprocess.run(["cp", "-r", "--", *(os.path.join(plain, name) for name in os.listdir(plain)), self.folder],
                           check=True)
            labs.remove_product(self.folder, job)

    def attempt(self, free):
        job = self.job
        labs.remove_product(self.folder, job)
        ballast = os.path.join(self.folder, "ballast")
        if os.path.exists(ballast):
            os.remove(ballast)
        if job.tool != "simrun":
            with open(os.path.join(self.folder, job.product), "w", encoding="ascii") as old:
                old.write("old\n")
        before = labs.product(self.folder, job)
        there = os.statvfs(self.folder)
        with open(ballast, "wb") as file:
            os.posix_fallocate(file.fileno(), 0, max(1, there.f_bavail * there.f_bsize - free))
        result = self.lab.run(job.argv, self.folder, env={**self.lab.environment, "TMPDIR": self.folder})
        self.lab.count("runs")
        broken = self.judge(result, before)
        if broken:
            self.lab.violated(f"{free} bytes free: {shlex.join(job.argv)}: {broken}")

    def judge(self, result, before):
        left = labs.stand_ins(self.folder)
        made = labs.product(self.folder, self.job)
        if left:
            return f"left behind: {left}"
        if result.status == 0:
            return "" if made == self.whole else "status 0, but another product"
        self.lab.count("refusals")
        lines = result.said().splitlines()
        if result.status != 1 or len(lines) != 1 or not lines[0].startswith(self.job.tool + ": ") or \
                "error: No space left on device" not in lines[0]:
            return f"status {result.status}: {result.said()}"
        if self.job.tool == "simrun":
            torn = list(part_kills.torn_files(os.path.join(self.folder, "run")))
            return f"half a line ends {', '.join(torn)}" if torn else ""
        return "" if made == before else "the old file is gone"

    def unmount(self):
        if self.mounted:
            subprocess.run(["umount", self.folder], check=True)


def measure(folder, job):
    path = os.path.join(folder, job.product)
    if not os.path.isdir(path):
        return os.path.getsize(path)
    return sum(os.path.getsize(os.path.join(where, name)) for where, _, names in os.walk(path) for name in names)


def run(lab):
    disks = []
    try:
        for job in labs.JOBS:
            disks.append(Disk(lab, job))
            if not disks[-1].mounted:
                lab.say("left out: no right to mount a small disk")
                return
        while lab.left() > 0:
            for disk in disks:
                disk.attempt(int(lab.random.random() * (1.2 * disk.need + 16384)))
    finally:
        for disk in disks:
            disk.unmount()
