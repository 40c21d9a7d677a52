# SPDX-License-Identifier: GPL-3.0-or-later
"""wrong_values.py TOOLS: each option with a value of a form refuses another form and a missing value by itself.

The error is one line that begins with the option, and the exit status 2. Files, ids and texts have no form: NAMES are
the words for such values in `--help all`.
"""
import pathlib
import re
import subprocess
import sys

TOOLS = ("envc", "arrange", "scan", "coverage", "simrun")
NAMES = re.compile(r"(FILE|DIR|LIST|LOG|ENV|LAYOUT|RECORD|TEXT|GLOB|ID|ZONE|ROBOT|TOPIC|HOST|PATH|MODEL|SHARE$|SENTENCE|CIDR"
                   r"|FROM,TO|X,Y\|ZONE|\[N\]|inliers=)|=\[ADDR:\]PORT$")
folder = pathlib.Path(sys.argv[1])
faults, judged = [], 0


def error_of(*words):
    done = subprocess.run([folder / words[0], *words[1:]], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr.splitlines()


for tool in TOOLS:
    page = subprocess.run([folder / tool, "--help", "all"], capture_output=True, text=True, check=True).stdout
    for option, form in re.findall(r"^  (?:-\w, )?(--[a-z0-9-]+)[ =](\S.*?)(?:  |$)", page, re.MULTILINE):
        if NAMES.match(form) or form.endswith("=[ADDR:]PORT"):
            continue
        judged += 1
        for words in ([option, "%%"], [option, "nan"], [f"{option}="], [option]):
            if words == [option] and form.startswith("["):
                continue
            status, lines = error_of(tool, *words)
            if status != 2 or len(lines) != 1 or not lines[0].startswith(f"{tool}: error: {option}"):
                faults.append(f"{tool} {' '.join(words)} ({form}): status {status}, {lines[:2]}")

if judged < 80:
    faults.append(f"only {judged} options have a form")
for fault in faults:
    print(f"wrong_values: {fault}")
sys.exit(1 if faults else 0)
