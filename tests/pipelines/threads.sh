#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The same bytes for any number of threads, and from one run to the next.
. "$(dirname "$0")/common.sh"

run() {
    mkdir "$2"
    (
        cd "$2"
        envc "$scenes/crowded.env" -j "$1" -o room.glb
        arrange room.glb --sensor laser,range=4,fov=180:3 --strategy grid -X 6 -Y 6 --deg 8 \
            -j "$1" -o best.3dm
        scan room.glb best.3dm -j "$1" -o scans.jsonl
        { cat best.3dm; echo 'ranger id=k at=-1,0,1 heading=40 tilt=-20 pixels=64,48 sigma=0.01'; } >more.3dm
        for format in jsonl raw pcd ply png mcap npz las; do
            scan room.glb more.3dm --noise --frames 3 --to "$format" -j "$1" -o "$format/"
        done
        scan room.glb best.3dm --noise --frames 30 --to carmen -j "$1" -o logs/
        coverage room.glb best.3dm -j "$1" -o map.png >report.txt
        coverage room.glb best.3dm -j "$1" --json -o map.svg >report.json
    )
}

run 1 one
run 2 two
run 7 seven
run 2 again
for other in two seven again; do
    diff -r one "$other" || fail "-j changes the result ($other)"
done
