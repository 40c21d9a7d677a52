#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A reader that goes away ends every tool silently, as SIGPIPE would.
. "$(dirname "$0")/common.sh"

# into_closed_pipe COMMAND…: the reader is gone before the first byte is written.
into_closed_pipe() {
    local status=0
    (
        { sleep 0.2; "$@" 2>"$scratch/err"; echo $? >"$scratch/status"; } | true
    ) || true
    status=$(cat "$scratch/status")
    [ "$status" -eq 141 ] || fail "status $status, expected 141, of: $*"
    [ ! -s "$scratch/err" ] || fail "not silent: $*: $(cat "$scratch/err")"
    rm -f "$scratch/status"
}

into_closed_pipe envc "$data/room.env" --to glb
into_closed_pipe envc "$data/room.env" --to env
into_closed_pipe envc "$data/room.env" --info
into_closed_pipe arrange "$data/room.env" --sensor laser --strategy grid -X 2 -Y 2 --deg 4
into_closed_pipe scan "$data/room.env" "$data/room.3dm"
for format in mcap npz las; do
    into_closed_pipe scan "$data/room.env" "$data/room.3dm" --to $format
done
into_closed_pipe coverage "$data/room.env" "$data/room.3dm"
into_closed_pipe coverage "$data/room.env" "$data/room.3dm" --json

# The same with an ignored SIGPIPE, as under some shells and daemons: still no noise, no success.
(
    trap '' PIPE
    { sleep 0.2; envc "$data/room.env" --to env 2>err; echo $? >status; } | true
) || true
[ "$(cat status)" -ne 0 ] || fail "a lost output reported as success"
