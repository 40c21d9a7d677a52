#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# demo.sh [FOLDER]: for two rooms of the thesis: the room, poses of three lasers, their readings and coverage, and a
# robot in one of them. Requires the tools in PATH; writes its files to FOLDER (default: ispace-demo).
set -eu
unset CDPATH
examples=$(cd "$(dirname "$0")" && pwd)
# Beside the examples, or in a copy of them those of the installation.
scenes=$examples/../scenes
[ -e "$scenes/ispace.env" ] || scenes=$(dirname "$(readlink -f "$(command -v ispace)")")/../share/ispace/scenes
mkdir -p "${1:-ispace-demo}"
cd "${1:-ispace-demo}"

run() {
    echo "\$ $*"
    "$@"
}

# The Intelligent Space of the thesis, looked over by two real scanners.
run envc "$scenes/ispace.env" -o ispace.glb
run arrange ispace.glb --sensor urg-04lx:2 -o ispace.3dm
run coverage ispace.glb ispace.3dm -o ispace.png

# A crowded room and the three 4 m, 180 degree lasers of its section 4.6.
run envc "$scenes/crowded.env" -o crowded.glb
run arrange crowded.glb --sensor laser,range=4,fov=180:3 --optimize exact -o crowded.3dm
run scan crowded.glb crowded.3dm -o crowded.jsonl
run coverage crowded.glb crowded.3dm -o crowded.png

# A robot drives around the barriers in the Intelligent Space; two lasers watch it, one is on it.
run simrun ispace.glb "$scenes/ispace.3dm" --clock fast --until 36 \
    --script "$examples/drive.txt" --record drive

echo
result=$(sed -n 's/^result.*coverage=\([^ ]*\).*/\1/p' crowded.3dm)
echo "the best there is for three lasers in the crowded room, coverage: $result"
way=$(awk -F, '$2 == "r1" { place = $3 + 0 ", " $4 + 0 } END { print place }' drive/robots.csv)
scans=$(($(wc -l <drive/scans.jsonl) - 1))
echo "robot r1 drove from 0.5, 2 to $way; $scans scans in drive/scans.jsonl"
echo "open the map: $(pwd)/crowded.png"
