#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ci.sh [FOLDER]: a test as a CI server runs it. A robot drives through the Intelligent Space; the
# run must do what is expected of it, and the layout must have seen enough of it. Leaves for the
# server: junit.xml (what was met), ways.png and seen.png (what it looked like), and the record.
# Ends with 3 if something is not as expected. Needs the tools in PATH.
set -eu
share=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "${1:-ispace-ci}"
cd "${1:-ispace-ci}"
room=$share/scenes/ispace.env
layout=$share/scenes/ispace.3dm

status=0
simrun "$room" "$layout" --clock fast --until 36 --script "$share/examples/drive.txt" --record run \
    --expect 'no collision' \
    --expect 'r1 within 0.1 of 0.5,-1.9 before 36' \
    --expect 'r1 in zone zps always' \
    --expect 'r* unseen at most 8' \
    --junit junit.xml >/dev/null || status=$?

# Whatever came of it: a picture of where it went, and what the lasers saw of it.
simrun --replay run "$room" "$layout" -o ways.png
coverage "$room" "$layout" --run run -o seen.png --report seen.json >seen.txt
sed -n '/^run/,$p' seen.txt
exit "$status"
