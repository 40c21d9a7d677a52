#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Maps that robots made, through the whole pipeline. ISPACE_TEST_DATA names their folder.
. "$(dirname "$0")/common.sh"

[ -n "${ISPACE_TEST_DATA:-}" ] || skip "ISPACE_TEST_DATA names no folder of real maps"

# through MAP MODEL LOWEST: at least LOWEST per cent of the floor are covered.
through() {
    local map=$ISPACE_TEST_DATA/$1.yaml
    [ -e "$map" ] || skip "no $map"
    mkdir "$1"
    cd "$1"
    envc "$map" -o room.glb
    envc room.glb --info --json >info.json
    for j in 1 2; do
        arrange room.glb --sensor "$2:3" --strategy grid -X 11 -Y 11 --deg 8 -j $j -o "best$j.3dm"
        scan room.glb "best$j.3dm" -j $j | tail -n +2 >"scans$j.jsonl"
    done
    expect_same best1.3dm best2.3dm "-j changes the layout in $1"
    expect_same scans1.jsonl scans2.jsonl "-j changes the scans in $1"
    [ "$(wc -l <scans1.jsonl)" -eq 3 ] || fail "not one scan of each sensor in $1"
    coverage room.glb best1.3dm --json -o room.png >report.json
    head -c 8 room.png | cmp - <(printf '\211PNG\r\n\032\n') || fail "no PNG of $1"
    arrange room.glb --sensor "$2:3" --strategy grid -X 11 -Y 11 --deg 8 |
        coverage room.glb -o pipe.png >pipe.txt
    expect_same room.png pipe.png "another picture through the pipe in $1"
    # "coverage":{"grid":0.97,…
    sed -n 's/.*"coverage":{"grid":\([0-9.e-]*\).*/\1/p' report.json |
        awk -v low="$3" '{ if ($1 * 100 < low || $1 > 1) exit 1; n++ } END { exit n != 1 }' ||
        fail "the coverage of $1 is not as expected: $(cat report.json)"
    # The layout says the same as the report.
    said=$(sed -n 's/^result.*coverage=\([0-9.e-]*\)%.*/\1/p' best1.3dm)
    sed -n 's/.*"coverage":{"grid":\([0-9.e-]*\).*/\1/p' report.json |
        awk -v said="$said" '{ d = $1 * 100 - said; if (said == "" || d > 1e-9 || d < -1e-9) exit 1 }' ||
        fail "the layout says $said%, the report another coverage"
    cat pipe.txt
    cd ..
}

through turtlebot3 urg-04lx 50
through willow-full utm-30lx 15
