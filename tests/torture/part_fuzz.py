# SPDX-License-Identifier: GPL-3.0-or-later
"""The fuzz targets of tests/fuzz and of extensions, all with the same time; build-fuzz/corpus stores their inputs."""
import glob
import os
import re
import shutil
import subprocess

import lab as labs

AT_ONCE = 2


def run(lab):
    if not shutil.which("clang++"):
        lab.say("left out: no clang++")
        return
    script = os.path.join(labs.SOURCE, ".ci", "fuzz")
    folders = ("tests/fuzz", "lib/extensions/*/fuzz")
    targets = [os.path.basename(path)[:-8] for folder in folders
               for path in glob.glob(os.path.join(labs.SOURCE, folder, "*_fuzz.cc"))]
    seconds = max(1, int(lab.seconds * AT_ONCE / len(targets)))
    # Building them takes extra time.
    process = subprocess.run([script, str(seconds), "-1", *sorted(targets)], env={**os.environ, "FUZZ_JOBS": str(AT_ONCE)},
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    for line, executions in re.findall(r"^(fuzz: \w+ (\d+) executions.*)$", process.stdout, re.M):
        lab.say(line)
        lab.count("targets")
        lab.count("executions", int(executions))
    if process.returncode != 0:
        lab.violated("a fuzzer found an input: " + process.stdout[-3000:])
