#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# kind_files.sh [ROOT]: a kind of sensor or actuator is named by its own files, by those of other kinds, which may read
# it, and by at most eight further ones, which the table of docs/internals.md lists. It first shows on a made-up tree
# that it can fail.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/../.." && pwd)}

# Prints one line per violation. $1: a tree. Rows are | `KIND` | own files | other files |; an own FILE.h defines a type
# FileInCapitals. A file names a kind by its keyword in quotes, by that type, or by an #include of an own header.
violations() {
    python3 - "$1" <<'END_OF_PROGRAM'
import pathlib, re, sys
root, most = pathlib.Path(sys.argv[1]), 8
# Doors and windows are older than their motors and blinds, which are states. RFID readers added the key `tag`, light
# meters the key `lumens`. SVG has an element <switch>, rays have contacts, and ROS has messages with names of readings.
pattern_of = {"door": '{"door", "', "rfid": '"rfid"|\\btagKey\\b', "lux": '"lux"|"lumens"'}
unrelated = {("switch", "lib/extensions/cad/svg.cc"), ("contact", "lib/kernel/trace/flat_packet.cc")}
unrelated |= {(kind, f"lib/kernel/sense/formats/ros_{part}") for kind in ("lux", "thermometer", "imu")
              for part in ("types.h", "types.cc", "messages.h")}
files = {}
for folder in ("lib", "tools", "share/schemas", "share/sweep"):
    for path in (root / folder).rglob("*"):
        name = path.relative_to(root).as_posix()
        if path.suffix in (".cc", ".h", ".py", ".js", ".json") and not name.endswith(("_test.cc", "_test.h")):
            files[name] = path.read_text(encoding="utf-8")

def found(cell):
    """The files of a cell: paths, or names that one file of the tree has."""
    listed = set()
    for name in re.findall(r"`([^`]+)`", cell):
        matches = [path for path in files if path == name or path.endswith("/" + name)]
        if len(matches) != 1:
            print(f"docs/internals.md: {name} is {len(matches)} files")
        listed.update(matches)
    return listed

rows = {}
page = (root / "docs/internals.md").read_text(encoding="utf-8")
for line in page.partition("| kind | its own files |")[2].splitlines():
    row = re.fullmatch(r"\| `(\w+)` \| (.*) \| (.*) \|", line)
    if row:
        rows[row[1]] = found(row[2]), found(row[3])
owned = set().union(*(own for own, _ in rows.values()))
for kind, (own, others) in rows.items():
    patterns = [pattern_of.get(kind, f'"{kind}"')]
    for path in own:
        if path.endswith(".h"):
            name = "/".join(path.split("/")[-2:])
            patterns.append('#include ["<](?:[\\w/]+/)?' + re.escape(name) + '[">]')
            patterns.append(r"\b" + pathlib.Path(path).stem.title().replace("_", "") + r"\b")
    # A plain search first: it is much faster.
    words = [re.sub(r"^\\b|\\b$", "", word) for word in "|".join(patterns).split("|") if "#include" not in word]
    words += [name for name in own if name.endswith(".h")]
    named = {path for path, text in files.items()
             if any(word.split("/")[-1] in text for word in words)
             and re.search("|".join(patterns), text) and (kind, path) not in unrelated}
    for path in sorted(named - owned - others):
        print(f"{path}: names {kind}, whose row of docs/internals.md lacks it")
    for path in sorted(others - (named - owned)):
        print(f"docs/internals.md: {path} does not name {kind}, or belongs to a kind")
    if len(others) > most:
        print(f"docs/internals.md: {len(others)} files besides its own name {kind}, more than {most}")
if not rows:
    print("docs/internals.md: no table of kinds")
END_OF_PROGRAM
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$scratch"/lib/kernel/scene "$scratch"/docs
# page OTHERS: writes a table with one row.
page() {
    printf '%s\n' '| kind | its own files | others that name it |' '|---|---|---|' \
        "| \`pir\` | \`pir.h\` | $* |" >"$scratch/docs/internals.md"
}
page "\`kinds.h\`"
printf 'struct Pir;\n' >"$scratch/lib/kernel/scene/pir.h"
printf '#include "scene/pir.h"\n' >"$scratch/lib/kernel/scene/kinds.h"
[ -z "$(violations "$scratch")" ] || { echo "a violation in a good tree: $(violations "$scratch")"; exit 1; }
printf 'keyword == "pir"\n' >"$scratch/lib/kernel/scene/other.cc"
[ -n "$(violations "$scratch")" ] || { echo "no violation found in a bad tree"; exit 1; }
for i in 1 2 3 4 5 6 7 8; do printf 'Pir\n' >"$scratch/lib/kernel/scene/f$i.cc"; done
rm "$scratch/lib/kernel/scene/other.cc"
page "\`kinds.h\`" "\`f"{1..8}".cc\`"
violations "$scratch" | grep -q 'more than 8' || { echo "nine files pass"; exit 1; }

found=$(violations "$root")
[ -z "$found" ] || { printf '%s\n' "$found"; exit 1; }
