#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A run that falls behind the real clock says so once, with the time lost, and once when it keeps up again.
. "$(dirname "$0")/common.sh"

simrun "$data/room.env" "$data/robots.3dm" --port-file port >out 2>err &
run=$!
trap 'kill -CONT "$run" 2>/dev/null; kill "$run" 2>/dev/null; cleanup' EXIT

# until_said TEXT: waits until stderr has it, for half a minute.
until_said() {
    for _ in $(seq 300); do
        ! grep -qE "$1" err || return 0
        sleep 0.1
    done
    fail "not said: $1: $(cat err)"
}
for _ in $(seq 300); do [ ! -s port ] || break; sleep 0.1; done
sleep 0.5
kill -STOP "$run"
sleep 1
kill -CONT "$run"
until_said '^simrun: warning: t=[0-9.]+ the run falls behind real time, by [0-9.]+ s so far'
until_said '^simrun: warning: t=[0-9.]+ the run keeps up with real time again, [0-9.]+ s behind in all'
lost=$(sed -n 's/.*by \([0-9.]*\) s so far.*/\1/p' err | tail -n 1)
awk -v lost="$lost" 'BEGIN { exit !(lost > 0.25) }' || fail "lost $lost s: $(cat err)"
kill "$run"
wait "$run" || fail "status $? of TERM"
trap cleanup EXIT

expect_status 0 simrun "$data/room.env" "$data/robots.3dm" --clock fast --until 5
! grep -q 'real time' err || fail "a clock that is not real has no lag: $(cat err)"
