#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Programs for ARIA end where they end over the packets of a Pioneer: to the last digit of simrun's answer, or within 5 cm
# and 2 degrees if the firmware drives distances and headings.
. "$(dirname "$0")/../pipelines/common.sh"

echo '#3dm 1
robot id=r1 model=pioneer-3dx at=-1,-0.5' >r1.3dm

# pose CLIENT PROGRAM: the end pose
pose() {
    rm -f port
    simrun "$data/square.env" r1.3dm --clock step --p2os r1=0 --port-file port >announced 2>warnings &
    server=$!
    trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    ISPACE_SIMRUN=127.0.0.1:$(cat port) ISPACE_P2OS=$(sed 's/.*"p2os":{"r1":"\([^"]*\)".*/\1/' announced) \
        timeout 200 "$binary_dir/tests/$1" "$2" || fail "$1 $2 ended with $?"
    kill "$server"
    wait "$server" || fail "simrun ended with $?"
}

# same PROGRAM METRES DEGREES
same() {
    pose aria_drives_native "$1" >first
    pose aria_drives_p2os "$1" >second
    echo "$1: $(cat first) | $(cat second)"
    paste -d ' ' first second | awk -v metres="$2" -v degrees="$3" '{
        turn = $3 - $7; turn -= 360 * int(turn / 360); if (turn < 0) turn = -turn; if (turn > 180) turn = 360 - turn
        exit !(sqrt(($1 - $5) ^ 2 + ($2 - $6) ^ 2) <= metres && turn <= degrees && $4 == $8)
    }' || fail "$1 ends elsewhere"
}
for program in speeds wheels loop input goals wander placed; do same $program 0 0; done
same distances 0.05 2
