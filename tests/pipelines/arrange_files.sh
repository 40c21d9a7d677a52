#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The files beside a layout: given sites, curve, trace, rule for make; and no output replaces an input.
. "$(dirname "$0")/common.sh"

envc "$scenes/crowded.env" -o room.glb
printf 'x,y,heading\n# by the door\n-3,-2,90\n3,2,-90\n3,2,180\n0,0\n' >places.csv
arrange room.glb --sensor laser:2 --places places.csv -q -o listed.3dm
grep '^laser' listed.3dm | grep -vE 'at=(-3,-2|3,2|0,0),0.15' && fail "a place that is not in the list"
arrange room.glb --sensor laser:2 --places - -q <places.csv | grep -v '^#' >streamed.3dm
grep -v '^#' listed.3dm | cmp - streamed.3dm || fail "another layout from stdin"
printf '1,2\nfoo,3\n' >bad.csv
expect_error 1 arrange room.glb --sensor laser --places bad.csv
grep -q 'bad.csv:2:1: error' err || fail "no place of the error: $(cat err)"

arrange room.glb --sensor laser,range=4:5 --candidates 1,1,8 --curve curve.csv --trace tried.jsonl \
    -MD -o five.3dm 2>said
[ "$(wc -l <curve.csv)" -eq 6 ] || fail "not five points: $(cat curve.csv)"
grep -q '^five.3dm:' five.3dm.d && grep -q 'room.glb' five.3dm.d || fail "no rule: $(cat five.3dm.d)"
[ "$(grep -c '"chosen":true' tried.jsonl)" -eq 5 ] || fail "not five chosen ones"
candidates=$(grep -o 'candidates=[0-9]*' five.3dm | cut -d= -f2)
[ "$(wc -l <tried.jsonl)" -eq $((candidates + 1)) ] || fail "not a line a candidate"
coverage room.glb five.3dm --trace tried.jsonl -o map.png >/dev/null
[ -s map.png ] || fail "no map"
for suffix in png svg pdf; do
    arrange room.glb --sensor laser,range=4:2 --candidates 1,1,8 --curve "curve.$suffix" -q -o two.3dm
    [ -s "curve.$suffix" ] || fail "no curve.$suffix"
done

cp room.glb kept.glb
expect_error 2 arrange room.glb --sensor laser --trace room.glb -o out.3dm
expect_error 2 arrange room.glb --sensor laser --trace same --curve same -o out.3dm
expect_error 2 arrange room.glb --sensor laser --places places.csv --export-mps places.csv
echo old >out.3dm
ln -s out.3dm link.3dm
expect_error 2 arrange room.glb --sensor laser --trace ./out.3dm -o out.3dm
expect_error 2 arrange room.glb --sensor laser --trace link.3dm -o out.3dm
expect_error 2 arrange room.glb --sensor laser --trace /dev/stdout
expect_error 2 arrange - --sensor laser --places - </dev/null
expect_error 1 arrange room.glb --sensor laser -o missing/out.3dm
cmp room.glb kept.glb || fail "the room was written over"

# Arranging an existing layout again: only named sensors stay.
arrange room.glb five.3dm --fixed laser1 --candidates 1,1,8 -q -o again.3dm
[ "$(grep '^laser id=laser1 ' five.3dm)" = "$(grep '^laser id=laser1 ' again.3dm)" ] ||
    fail "the fixed one has moved"
[ "$(grep -c '^laser ' again.3dm)" -eq 5 ] || fail "not five lasers"
expect_error 2 arrange room.glb five.3dm --candidates 1,1,8
expect_error 2 arrange room.glb five.3dm --fixed laser9
