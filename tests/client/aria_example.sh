#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The example for ARIA, unchanged but for the include path: by steps it does the same twice, and in a
# world that goes twenty times as fast as real it goes as fast.
. "$(dirname "$0")/../pipelines/common.sh"

# run CLOCK SECONDS
run() {
    rm -f port
    simrun "$scenes/ispace.env" "$scenes/ispace.3dm" --clock "$1" --port-file port >announced 2>warnings &
    server=$!
    trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    ISPACE_SIMRUN=127.0.0.1:$(cat port) timeout 60 "$binary_dir/examples/wander" "$2" >out ||
        fail "status $? with the clock $1: $(cat out)"
    grep -qE '^p2dx: [0-9]+ mm in [0-9]+ s, stalled [0-9]+ times, now at [-0-9. ]+, -?[0-9]+ mm/s$' out ||
        fail "with the clock $1: $(cat out)"
    way=$(sed 's/p2dx: \([0-9]*\) mm.*/\1/' out)
    [ "$way" -gt 1000 ] || fail "it hardly moves with the clock $1: $(cat out)"
    kill "$server"
    wait "$server" || fail "simrun ended with $?"
}
run step 60
cp out first
run step 60
expect_same first out "another way the second time"
begun=$(date +%s)
run real:20 40
[ $(($(date +%s) - begun)) -le 30 ] || fail "40 s took longer than 30 at twenty times real time"

status=0
ISPACE_SIMRUN=127.0.0.1:1 "$binary_dir/examples/wander" >out || status=$?
[ "$status" -eq 1 ] || fail "status $status without a server"
grep -q '^cannot open the port: ' out || fail "$(cat out)"
