#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A room is a building of one storey.

Each option of each tool runs on a room alone, on the same room as the only storey of a building, and as one of two
storeys under --storey. Exit status, messages, standard output and all files are equal but for the names of storeys.
The options are those that the tools print: one without a row fails this test.

    one_room.py --tools FOLDER [--only TOOL[:--OPTION]] [--keep FOLDER] [--jobs N]
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import options as rows

TOOLS = ("envc", "arrange", "scan", "coverage", "simrun")
FORMS = {"alone": [], "only": [], "two": ["--storey", "ground"]}
OTHERS = (b"\\", b"upper.env", b"upper.env:")  # of a rule for make: a building is read with all its storeys
LONGEST = 120  # seconds that a command takes at most


def listed(tools, tool):
    """Returns the options that the tool prints."""
    text = subprocess.run([tools / tool, "--help", "all"], capture_output=True, text=True, check=True).stdout
    heads = [line[2:26] for line in text.splitlines() if line.startswith("  -")]
    return {name for head in heads for name in re.findall(r"--?[A-Za-z][A-Za-z0-9-]*", head)}


def is_of_extension(tools, tool, option):
    """True for an option of an extension that this build lacks."""
    done = subprocess.run([tools / tool, option], capture_output=True, text=True, check=False)
    return "belongs to the extension" in done.stderr


def prepare(folder):
    """Writes the inputs of one form of the room."""
    folder.mkdir()
    for name, text in rows.FILES.items():
        if isinstance(text, bytes):
            (folder / name).write_bytes(text)
        else:
            (folder / name).write_text(text)
    form = folder.name
    if form == "alone":
        (folder / "room.env").write_text(rows.ROOM)
        return
    (folder / "ground.env").write_text(rows.ROOM)
    (folder / "upper.env").write_text(rows.UPPER)
    storeys = "#env 1\nstorey id=ground file=ground.env\n"
    if form == "two":
        storeys += "storey id=upper file=upper.env z=3\n"
    (folder / "room.env").write_text(storeys)


def plain(text):
    """Returns a text without names of storeys, ports, and what differs from run to run."""
    for name, value in (
        (rb"ground/", b""),
        (rb"ground\.env", b"room.env"),
        (rb" ?--storey ground", b""),
        (rb"=(header|command) \d+ [0-9a-f]+", b"=part"),
        (rb"\b\d+ [0-9a-f]{16}\b", b"SUM"),
        (rb"ispace-one-room-[\w-]+", b"NAME"),
        (rb"127\.0\.0\.1:\d+", b"127.0.0.1:PORT"),
        (rb"\d+(\.\d+)? (m?s|times as fast)\b", b"TIME"),
    ):
        text = re.sub(name, value, text)
    return text


def run(tools, tool, words, folder):
    """Runs a command in a copy of the inputs. Returns what can be compared: by name, bytes."""
    before = {path for path in folder.rglob("*")}
    done = subprocess.run(
        [tools / tool, *words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST, check=False
    )
    found = {"status": str(done.returncode).encode(), "stdout": plain(done.stdout), "stderr": plain(done.stderr)}
    for path in sorted(folder.rglob("*")):
        if path not in before and path.is_file() and path.name not in rows.OWN:
            found[str(path.relative_to(folder))] = plain(path.read_bytes())
    for name in found:
        if name == "rule" or name.endswith(".d"):
            found[name] = files_of_rule(found[name])
    return found


def files_of_rule(rule):
    """Returns the files that a rule for make names, in their order, each once."""
    return b" ".join(dict.fromkeys(word for word in rule.split() if word not in OTHERS))


def differences(a, b):
    names = sorted(set(a) | set(b))
    return [name for name in names if a.get(name) != b.get(name)]


def shown(name, a, b):
    """Returns the first place in which two outputs differ."""
    if a is None or b is None:
        return f"{name}: written by {'the first' if b is None else 'the second'} alone"
    lines = a.splitlines(), b.splitlines()
    for x, y in zip(*lines):
        if x != y:
            at = next((i for i, (c, d) in enumerate(zip(x, y)) if c != d), min(len(x), len(y)))
            first = max(0, at - 40)
            return f"{name}: {x[first:at + 120]!r}\n      is not {y[first:at + 120]!r}"
    return f"{name}: {len(lines[0])} lines and {len(lines[1])}"


def check(tools, scratch, tool, option, line):
    """Returns faults of one row: a text each."""
    base = rows.BASES[tool] if not line.startswith("!") else ""
    words = shlex.split(line.lstrip("!"))
    before = rows.BEFORE.get((tool, option), "")
    outcomes = {}
    for form, storey in FORMS.items():
        folder = scratch / f"{tool}{option}" / form
        folder.parent.mkdir(exist_ok=True)
        prepare(folder)
        for command in filter(None, before.split(" && ")):
            first, *rest = shlex.split(command)
            done = subprocess.run([tools / first, *rest, *(storey if "room.env" in rest else [])], cwd=folder,
                                  stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST, check=False)
            if done.returncode != 0:
                return [f"{form}: {command}: {done.stderr.decode(errors='replace')}"]
        own = f"{os.getpid()}{option}-{form}"
        command = [word.replace("{own}", own) for word in shlex.split(base) + words]
        outcomes[form] = run(tools, tool, command + ([] if line.startswith("!!") else storey), folder)
    faults = []
    expected = rows.STATUS.get((tool, option), 0)
    if outcomes["alone"]["status"] != str(expected).encode():
        message = outcomes["alone"]["stderr"].decode(errors="replace")
        faults.append(f"exit status {outcomes['alone']['status'].decode()} of the room alone, not {expected}: {message}")
    for form in list(FORMS)[1:]:
        if form == "only" and (tool, option) in rows.KEPT:
            continue
        for name in differences(outcomes["alone"], outcomes[form]):
            faults.append(f"{form}: " + shown(name, outcomes["alone"].get(name), outcomes[form].get(name)))
    return faults


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tools", type=pathlib.Path, required=True)
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    tools = arguments.tools.resolve()
    scratch = arguments.keep or pathlib.Path(tempfile.mkdtemp())
    scratch = scratch.resolve()
    scratch.mkdir(exist_ok=True)
    jobs, faults, exempt = [], 0, 0
    for tool in TOOLS:
        known = rows.COMMON | rows.OPTIONS[tool]
        for _, option, extension in (one for one in rows.MISPLACED if one[0] == tool):
            print(f"{tool} {option}: its row belongs to lib/extensions/{extension}/site_rows.py")
            faults += 1
        for option in sorted(listed(tools, tool)):
            if arguments.only and arguments.only not in (tool, f"{tool}:{option}"):
                continue
            if option not in known:
                print(f"{tool} {option}: no row in options.py or in site_rows.py of its extension")
                faults += 1
            elif isinstance(known[option], rows.Exempt):
                exempt += 1
            else:
                jobs.append((tool, option, known[option]))
        for option in sorted(set(rows.OPTIONS[tool]) - listed(tools, tool)):
            if is_of_extension(tools, tool, option):
                continue
            print(f"{tool} {option}: a row of an option that does not exist")
            faults += 1
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = pool.map(lambda job: check(tools, scratch, *job), jobs)
        for (tool, option, _), found in zip(jobs, results):
            for fault in found:
                print(f"{tool} {option}: {fault}", flush=True)
            faults += bool(found)
    if not arguments.keep:
        shutil.rmtree(scratch)
    print(f"{len(jobs)} options in {len(FORMS)} forms, {exempt} exempt, {faults} with faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
