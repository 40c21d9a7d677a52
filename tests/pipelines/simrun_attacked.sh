#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Clients up to no good: sums of memory, descriptors and threads hold, others go on.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"
command -v python3 >/dev/null || skip "no python3 here"
attack() { python3 "$source_dir/tests/simrun/attack.py" "$port" "$server" "$1" || fail "$1"; }

cat >attacked.3dm <<'END'
#3dm 1
robot id=r1 at=-1,0
laser id=l1 at=0,-1.9 heading=90
END
{ cat attacked.3dm; echo "laser id=big at=0,1 fov=360 step=0.0009"; } >big.3dm

start "$data/square.env" big.3dm --clock step
attack stall
stop
start "$data/square.env" attacked.3dm --clock real
attack noise
attack silent
attack flood
stop

# How late the steps are meanwhile: how many of a thousand by more than a step, and for how many
# milliseconds of that the program itself was at work, whatever else the machine does.
late() { # KIND
    local kind=$1
    start "$data/square.env" attacked.3dm --clock real --max-clients 1100 -v
    attack "$kind"
    stop
    grep 'began more than a step late' simrun.err | sed "s/^simrun: /$kind: /"
    read -r late own < <(sed -n 's/^simrun: \([0-9]*\) of \([0-9]*\) steps began.* at work for 0*\([0-9.]*\) s.*/\1 \2 \3/p' \
        simrun.err | awk '{ print int(1000 * $1 / $2), int(1000 * $3 + 0.5) }')
    [ -n "$own" ] || fail "$kind: nothing said: $(cat simrun.err)"
}
late idle
alone=$late
late storm
# No step is later than one step, 5 ms, but for the time that other programs take from this one.
[ "$own" -le 5 ] || fail "storm: at work for $own ms when a step was due"
[ "$late" -le $((alone + 300)) ] || fail "storm: $late of 1000 steps are late, $alone without"
late edits
# A change makes the room anew, which takes longer than a step.
[ "$own" -le 100 ] || fail "edits: at work for $own ms when a step was due"
[ "$late" -le $((alone + 300)) ] || fail "edits: $late of 1000 steps are late, $alone without"

# Clients cannot end this run; the system can.
start "$data/square.env" attacked.3dm --clock step --no-shutdown
dial world
expect world WORLD 'OK WORLD .*'
expect world SHUTDOWN 'ERR 403 .*--no-shutdown'
expect world STEP 'OK STEP n=1 .*'
stop TERM
