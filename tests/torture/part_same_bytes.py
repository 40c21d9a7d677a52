# SPDX-License-Identifier: GPL-3.0-or-later
"""The same bytes of a command of each tool over threads, locales, time zones, umasks, and in an empty environment."""
import os
import shlex
import subprocess

import lab as labs

LOCALES = ("de_DE.utf8", "fr_FR.utf8", "tr_TR.utf8", "C.utf8")


def locales():
    """Those of LOCALES that are installed; C.utf8 always is."""
    try:
        installed = subprocess.run(["locale", "-a"], capture_output=True, text=True, check=True).stdout.split()
    except (OSError, subprocess.CalledProcessError):
        installed = []
    return [name for name in LOCALES if name in installed] or ["C.UTF-8"]


def ways():
    """{name: (arguments, changes of the environment, umask)}; None is the empty environment."""
    result = {"-j 1": (["-j", "1"], {}, -1), "-j 2": (["-j", "2"], {}, -1), "-j 8": (["-j", "8"], {}, -1)}
    for name in locales():
        result["LC_ALL=" + name] = ([], {"LC_ALL": name, "LANG": name}, -1)
    for zone in ("Asia/Kathmandu", "America/St_Johns", ":/missing"):
        result["TZ=" + zone] = ([], {"TZ": zone}, -1)
    for mask in (0o000, 0o077, 0o777):
        result[f"umask {mask:03o}"] = ([], {}, mask)
    result["env -i"] = ([], None, -1)
    result["HOME=/missing TMPDIR=."] = ([], {"HOME": "/missing", "TMPDIR": ".", "COLUMNS": "7", "TERM": "dumb"}, -1)
    return result


def run(lab):
    for job in labs.JOBS:
        folder = lab.inputs(job.product)
        expected = None
        for name, (arguments, changes, mask) in ways().items():
            if mask == 0o777 and (job.tool == "simrun" or os.geteuid() != 0):
                continue  # its own folder is shut then
            labs.remove_product(folder, job)
            environment = {} if changes is None else {**lab.environment, **changes}
            result = lab.run([*job.argv, *arguments], folder, env=environment, umask=mask)
            lab.count("runs")
            said = result.out + result.err if job.tool != "simrun" else result.err
            made = result.status, said, labs.product(folder, job)
            expected = expected or made
            if made != expected or result.status != 0:
                lab.violated(f"{shlex.join(job.argv)} with {name}: status {made[0]}, product {made[2][:12]}, said "
                             f"{made[1].decode(errors='replace')!r}; with -j 1 {expected[0]}, {expected[2][:12]}, "
                             f"{expected[1].decode(errors='replace')!r}",
                             f"cd {folder} && {name} {shlex.join(job.argv)}")
