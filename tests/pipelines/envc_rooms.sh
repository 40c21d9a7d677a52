#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The choice of a room: each point that `--rooms list` prints gives the area beside it, and a drawing of an import
# shows the rooms that are not kept. Drawings of other people, if ISPACE_TEST_DATA names their folder.
. "$(dirname "$0")/common.sh"

# expect_rooms COUNT FILE [OPTION]...: so many rooms, one of them kept; 0: any number above one.
expect_rooms() {
    python3 - "$@" <<'END' || fail "the rooms of $2"
import json, subprocess, sys
count, operands = int(sys.argv[1]), sys.argv[2:]
run = lambda *more: json.loads(subprocess.check_output(["envc", *operands, "-q", "--json", *more]))
rooms = run("--rooms", "list")["rooms"]
assert len(rooms) == count or count == 0 and len(rooms) > 1, f"{len(rooms)} rooms"
assert sum(room["kept"] for room in rooms) == 1, rooms
for room in rooms[:12]:
    point = ",".join(map(repr, room["inside"]))
    area = run("--inside", point, "--info")["indoor_area"]
    assert abs(area - room["area"]) <= 1e-3 * area, f"{point}: {area} instead of {room['area']}"
    if room["kept"]:
        kept = run("--info")["indoor_area"]
        assert abs(kept - area) <= 1e-3 * area, f"kept: {kept} instead of {area}"
END
}

envc "$data/rooms.env" -q --to dxf -o plan.dxf
expect_rooms 3 plan.dxf --wall-layer walls
expect_rooms 1 "$data/drawings/flat.svg" --wall-layer walls --door-layer 'Door*'
envc "$data/rooms.env" -q --to ros --resolution 0.1 -o plan.yaml
expect_rooms 0 plan.yaml
expect_rooms 0 plan.yaml --close-gaps 1 --reachable 0.2
envc plan.yaml -q -o plan.svg
grep -q -- '--inside ' plan.svg || fail "no point in the drawing"
grep -q 'not kept' plan.svg || fail "no other room in the drawing"
[ -z "${ISPACE_TEST_DATA:-}" ] && exit 0

folder=$ISPACE_TEST_DATA/strangers
area() { envc "$@" -q --info --json | sed -n 's/.*"indoor_area":\([0-9.e+-]*\).*/\1/p'; }
expect_area() {
    local wanted=$1
    shift
    awk -v f="$(area "$@")" -v w="$wanted" 'BEGIN { d = f - w; if (d < 0) d = -d; exit !(d <= 0.04 * w) }' ||
        fail "$*: $(area "$@") m2 instead of $wanted"
}
for drawing in hal9k ml3; do
    [ -e "$folder/dxf/$drawing.dxf" ] || skip "no $folder/dxf/$drawing.dxf"
    expect_rooms 0 "$folder/dxf/$drawing.dxf"
done
expect_area 166 "$folder/dxf/hal9k.dxf"
expect_area 4383 "$folder/dxf/ml3.dxf" --wall-layer Walls
envc "$folder/dxf/ml3.dxf" -o room.glb 2>talk
grep -q -- '--wall-layer Walls' talk || fail "no option named: $(cat talk)"
if envc "$folder/svg/oodavid.svg" -o room.glb 2>talk; then fail "oodavid has no scale"; fi
grep -q -- '--units .*--width-is' talk || fail "$(cat talk)"
[ "$(wc -l <talk)" -eq 1 ] || fail "more than one message: $(cat talk)"
# Doors and walls tell that a unit is 1 cm.
expect_area 50 "$folder/svg/shone.svg"
envc "$folder/svg/shone.svg" -o room.glb 2>talk
grep -q 'has no scale: its unit is read as 1 cm, in which doors are 0.84 m wide' talk || fail "$(cat talk)"
