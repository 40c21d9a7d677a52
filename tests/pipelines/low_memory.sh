#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# However little memory there is, a tool does its work as always or ends with status 1 and one line;
# it does not crash, and does not do half of it.
. "$(dirname "$0")/common.sh"

! ldd "$(command -v envc)" | grep -q 'lib[at]san' || skip "sanitizers want all the memory there is"
ulimit -c 0

envc "$scenes/facilities.env" -o room.glb
arrange -q room.glb --sensor laser,range=4,fov=180:3 --strategy grid -X 6 -Y 6 --deg 8 -o best.3dm
{ cat best.3dm; echo 'ranger id=k at=-1,0,1 heading=40 tilt=-20 pixels=16,12 sigma=0.01'; } >more.3dm

jobs=(
    "envc $scenes/facilities.env --to glb"
    "envc $scenes/facilities.env --to png"
    "arrange room.glb --sensor laser,range=4:2 --strategy grid -X 4 -Y 4 --deg 4 -q"
    "scan room.glb more.3dm --noise"
    "coverage room.glb best.3dm -o map.png"
    "simrun $data/room.env $data/robots.3dm --until 1 --clock fast"
)

# product FILE: what was written, without what differs from run to run.
product() {
    { sed 's/"listen":"[^"]*"/"listen":""/' "$1"; [ ! -e map.png ] || cat map.png; } | cksum
}

# check_limit KILOBYTES JOB EXPECTED
check_limit() {
    local status=0 command=$2
    rm -f map.png
    # shellcheck disable=SC2086
    (ulimit -v "$1" && exec $command) >out 2>err || status=$?
    case $status in
        0)
            [ "$(product out)" = "$3" ] || fail "another product in $1 kB: $command"
            [ ! -s err ] || fail "done, but in $1 kB: $command: $(cat err)"
            ;;
        1)
            [ "$(wc -l <err)" -eq 1 ] || fail "not one line in $1 kB: $command: $(cat err)"
            grep -q "^${command%% *}: " err || fail "in $1 kB: $command: $(cat err)"
            ;;
        127)  # the system could not start it
            grep -q "error while loading shared libraries" err || fail "$command: $(cat err)"
            ;;
        *) fail "status $status in $1 kB: $command: $(cat err)" ;;
    esac
}

for job in "${jobs[@]}"; do
    rm -f map.png
    $job >out
    expected=$(product out)
    threads=1
    for limit in 20000 30000 $(seq 40000 2500 110000) $(seq 120000 68000 800000); do
        check_limit "$limit" "$job -j $threads" "$expected"
        threads=$((5 - threads))
    done
done
