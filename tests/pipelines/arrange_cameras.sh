#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The question of a buyer of cameras, answered with its proof; and arrange and coverage agree on the area that cameras
# see with enough pixels.
. "$(dirname "$0")/common.sh"

sh "$source_dir/share/examples/cameras.sh" "$scratch/cameras" >out || fail "$(cat out)"
cd "$scratch/cameras"
grep -q '^arrange: 4 sensors, coverage .*(proven best)' ../out || fail "no proof: $(cat ../out)"
[ "$(grep -c 'none fewer than [0-9]* of these candidates can$' ../out)" -eq 2 ] ||
    fail "the fewest are not proven: $(cat ../out)"
grep -qx 'four domes of 110 degrees see 94.38 % of the floor; 3 see 91.65 %' ../out ||
    fail "other figures: $(tail -n 2 ../out)"
grep -qx 'to recognise people on 90 % of it takes 5: 92.43 %' ../out ||
    fail "other figures: $(tail -n 1 ../out)"

# agree LAYOUT OPTION…: its result is coverage's measurement, up to its 12 digits.
agree() {
    coverage office.glb "$1" --json "${@:2}" >measured.json
    sed -n 's/^result coverage=\([^%]*\)%.*/\1/p' "$1" >placed
    python3 -c 'import json
placed, measured = float(open("placed").read()), json.load(open("measured.json"))["coverage"]["grid"]
assert abs(placed - 100 * measured) < 1e-9, (placed, measured)' || fail "they differ about $1"
}
agree four.3dm
agree recognise.3dm --density recognise
arrange office.glb --sensor camera,focal=4mm,sensor=1/3in:2 --mount wall --density 40 --plane 1.6 \
    --candidates 1,1,8 --refine -q -o faces.3dm
agree faces.3dm --density 40 --plane 1.6
