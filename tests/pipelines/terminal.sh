#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# On a terminal: no binary data, no waiting for input, progress without being asked. script(1)
# pretends to be one.
. "$(dirname "$0")/common.sh"

command -v script >/dev/null || skip "no script(1) here"
script -qec true /dev/null >/dev/null 2>&1 </dev/null || skip "no pseudo-terminals here"

# on_terminal STATUS COMMAND: all three streams are the terminal; its text goes to ./said.
on_terminal() {
    local status=0
    # The terminal is closed at once for a tool that reads it in spite of everything.
    timeout 20 script -qec "$2" /dev/null </dev/null >said 2>&1 || status=$?
    [ "$status" -eq "$1" ] || fail "status $status, expected $1, of: $2: $(cat said)"
}

on_terminal 2 "envc '$data/room.env'"
grep -q 'GLB is binary and stdout a terminal' said || fail "$(cat said)"
for command in "envc --to env" "scan '$data/room.env'" "coverage '$data/room.env'"; do
    on_terminal 2 "$command"
    grep -q 'stdin is a terminal' said || fail "$command: $(cat said)"
done
on_terminal 0 "envc '$data/room.env' --to env"
grep -q '^fence' said || fail "$(cat said)"

arrange="arrange '$data/room.env' --sensor laser --strategy grid -X 9 -Y 9 -o best.3dm"
on_terminal 0 "$arrange"
grep -q '100 %' said || fail "no progress on a terminal"
on_terminal 0 "coverage '$data/room.env' best.3dm --suggest -q --progress"
grep -q 'views of sensors .*100 %' said && grep -q 'areas of views .*100 %' said ||
    fail "no progress of a measurement: $(cat said)"
grep -q 'poses of sensors .*100 %' said || fail "no progress of suggestions: $(cat said)"
on_terminal 0 "arrange '$data/room.env' --sensor laser:3 --curve curve.csv -o best3.3dm"
grep -q 'curve .*100 %' said || fail "no progress of the curve: $(cat said)"
on_terminal 0 "$arrange --no-progress -q"
[ ! -s said ] || fail "progress in spite of --no-progress: $(cat said)"
