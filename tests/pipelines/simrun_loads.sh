#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A thing in the hand goes upstairs with its person, and the replay shows the same states.
. "$(dirname "$0")/common.sh"

cp "$scenes"/house/*.env .
cat >load.3dm <<'END'
#3dm 1
human id=ground/ann at=6,1.6
cube id=ground/cup at=6.6,1.6 size=0.1 tag=c carried=ground/ann
tag id=ground/t on=cup at=0,0,0 rate=1
END
echo '0 ground/ann GOTO upper/4.5,3.5' >go.txt
simrun house.env load.3dm -q --clock fast --dt 0.05 --until 30 --script go.txt --record run >/dev/null
grep -q ',ground/ann,holds,cup$' run/upper/states.csv || fail "the cup is not upstairs"
grep -q 'ADD cube id=cup .*carried=ground/ann' run/upper/events.csv || fail "no change adds the cup"
grep -q '"sensor":"t"' run/upper/scans.jsonl || fail "its tag is not upstairs"
simrun --replay run -q --clock fast --record again >/dev/null
for room in ground upper; do
    for file in states people events; do
        expect_same run/$room/$file.csv again/$room/$file.csv "the replay of $room differs in $file"
    done
done
