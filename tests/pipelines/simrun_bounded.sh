#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Requests that are much work: other clients are answered meanwhile, and TERM ends the run.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"
command -v python3 >/dev/null || skip "no python3 here"
# Instrumented, all takes several times as long.
grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" || export ISPACE_PATIENCE=12
heavy() { python3 "$source_dir/tests/simrun/heavy.py" "$port" "$server" "$1" || fail "$1"; }

cat >bounded.3dm <<'END'
#3dm 1
robot id=r1 at=-1,0
laser id=l1 at=0,-1.9 heading=90
END

awk 'BEGIN {
    long = "a"; while (length(long) < 1500) long = long long
    print "#env 1\nispace at=0,0 size=6,4"
    for (i = 0; i < 4000; ++i) print "zone id=" substr(long, 1, 1500) i " at=0,0 size=1,1"
}' >long.env
start long.env bounded.3dm --clock real
heavy globs
ended 0

# The record is whole: recorded lines stay, and no line names a missing picture.
start "$data/square.env" bounded.3dm --clock real --record run
heavy pictures
ended 0
steps=$(sed -n '2s/^[^,]*,[^,]*,\([0-9]*\),.*/\1/p' run/info.csv)
rows=$(($(wc -l <run/robots.csv) - 1))
[ "$rows" -eq $((steps + 1)) ] || fail "$rows rows of robots after $steps steps"
[ "$steps" -gt 100 ] || fail "$steps steps in three seconds"
python3 - <<'END' || fail "the scans of the record"
import json
import os

lines = [json.loads(line) for line in open("run/scans.jsonl", encoding="utf-8")][1:]
assert len(lines) > 5, len(lines)
for line in lines:
    assert "file" not in line or os.path.getsize("run/" + line["file"]) > 0, line["file"]
END
simrun --replay run --clock fast >/dev/null 2>err || fail "no replay: $(cat err)"

# People in a heap.
start "$data/square.env" bounded.3dm --clock real
heavy people
ended 0

# Motes that hear each other.
start "$data/square.env" bounded.3dm --clock real
heavy motes
ended 0

# Light meters among lamps, microphones among speakers.
for kind in lights sounds; do
    start "$data/square.env" bounded.3dm --clock real
    heavy $kind
    ended 0
done

# Memory of a recorded run does not grow with its steps.
python3 - "$data/square.env" <<'END' || fail "the memory of a recorded run grows"
import os
import subprocess
import sys


def peak(until):
    child = subprocess.Popen(
        ["simrun", sys.argv[1], "bounded.3dm", "--clock", "fast", "--until", until, "--record", "long"],
        stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    assert status == 0, status
    return used.ru_maxrss


few, many = peak("20"), peak("1200")
assert many < few + 4096, f"{few} kB after 20 s, {many} kB after 1200 s"
END

# Connections at every port.
{ cat bounded.3dm; echo "camera id=c1 at=0,-1.5,1 pixels=32,24"; } >places.3dm
rm -f port
simrun "$data/square.env" places.3dm --web 127.0.0.1:0 --scip l1=0 --cola l1=0 --mjpeg c1=0 --port-file port \
    >announced 2>simrun.err &
server=$!
eventually "the port file" test -s port
port=$(cat port)
heavy places
ended 0

# In little memory, which the sanitizers would not leave.
if grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt"; then
    ulimit -v 1700000
    start "$data/square.env" bounded.3dm --clock real
    heavy sums
    ended 0
fi
