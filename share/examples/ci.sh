#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ci.sh [FOLDER]: a test for a CI server. A robot drives through the Intelligent Space; the run must meet its
# expectations, and the layout must have seen enough of it. Writes for the server: junit.xml (the verdicts), ways.png
# and seen.png (pictures), and the record. Exit status 3: an expectation failed. Requires the tools in PATH.
set -eu
unset CDPATH
examples=$(cd "$(dirname "$0")" && pwd)
# Beside the examples, or in a copy of them those of the installation.
scenes=$examples/../scenes
[ -e "$scenes/ispace.env" ] || scenes=$(dirname "$(readlink -f "$(command -v ispace)")")/../share/ispace/scenes
mkdir -p "${1:-ispace-ci}"
cd "${1:-ispace-ci}"
room=$scenes/ispace.env
layout=$scenes/ispace.3dm

status=0
simrun "$room" "$layout" --clock fast --until 36 --script "$examples/drive.txt" --record run \
    --expect 'no collision' \
    --expect 'r1 within 0.1 of 0.5,-1.9 before 36' \
    --expect 'r1 in zone zps always' \
    --expect 'r* unseen at most 8' \
    --junit junit.xml >/dev/null || status=$?

# After success and failure: a picture of the way, and of its coverage by the lasers.
simrun --replay run "$room" "$layout" -o ways.png
coverage "$room" "$layout" --run run -o seen.png --report seen.json >seen.txt
sed -n '/^run/,$p' seen.txt
exit "$status"
