#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The model of a small job, solved by GLPK and by CBC: their optimum is ours.
. "$(dirname "$0")/common.sh"

command -v glpsol >/dev/null || skip "no glpsol"
command -v cbc >/dev/null || skip "no cbc"
cat >room.env <<'END'
#env 1
ispace size=6,4
desk at=1,0.5 heading=30
zone id=corner at=2,1 size=2,2
END

# check NAME OPTION…: value of the layout in cells (or their weights), by all three.
check() {
    local name=$1
    shift
    arrange room.env "$@" --optimize exact --export-mps "$name.mps" -o "$name.3dm" 2>said ||
        fail "$name: $(cat said)"
    grep -q 'proven best' said || fail "$name is not proven: $(cat said)"
    timeout 120 glpsol --freemps "$name.mps" -o "$name.glpk" >glpk.log || fail "glpsol: $(tail -n 5 glpk.log)"
    grep -q 'INTEGER OPTIMAL' "$name.glpk" || fail "$name: glpsol did not solve it"
    timeout 120 cbc "$name.mps" solve solution "$name.cbc" >cbc.log || fail "cbc: $(tail -n 5 cbc.log)"
    python3 - "$name" <<'END' || fail "$name: the optima differ"
import re, sys
name = sys.argv[1]
glpk = float(re.search(r"Objective:\s+\S+ = (\S+)", open(name + ".glpk").read()).group(1))
cbc = float(re.search(r"objective value (\S+)", open(name + ".cbc").readline()).group(1))
result = open(name + ".3dm").read().splitlines()[-1]
ours = float(re.search(r"value=([0-9.e+-]+)%", result).group(1)) / 100
head = open(name + ".mps").read(2000)
total = float(re.search(r"weights of all cells together: (\d+)", head).group(1))
met = float(re.search(r"the value is (\d+) minus the objective", head).group(1))
print(name, -glpk + met, -cbc + met, ours * total)
assert abs(-glpk + met - ours * total) < 1e-3, (glpk, met, ours * total)
assert abs(-cbc + met - ours * total) < 1e-3, (cbc, met, ours * total)
END
}

check plain --sensor laser,range=2:2 --candidates 1,1,4 --grid 20,14
check twice --sensor laser,range=3:2 --candidates 3,3,2 --redundancy 2 --grid 12,8
check bought --sensor laser,range=2,cost=1 --sensor laser,range=3,fov=270,cost=2.5 --budget 4 \
    --candidates 2,2,4 --grid 20,14
check weighted --sensor laser,range=2:2 --candidates 1,1,4 --grid 20,14 \
    --weight corner=3 --zone rect:-3,-2,3,1
