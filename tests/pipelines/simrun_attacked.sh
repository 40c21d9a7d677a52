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

# How late the steps are meanwhile: most of them no more than a step, on a machine with other work.
late() { # KIND: per mille of the steps
    local kind=$1
    start "$data/square.env" attacked.3dm --clock real --max-clients 1100 -v
    attack "$kind"
    stop
    grep 'began more than a step late' simrun.err | sed "s/^simrun: /$kind: /"
    late=$(sed -n 's/^simrun: \([0-9]*\) of \([0-9]*\) steps began.*/\1 \2/p' simrun.err |
        awk '{ print int(1000 * $1 / $2) }')
    [ -n "$late" ] || fail "$kind: nothing said: $(cat simrun.err)"
}
late idle
alone=$late
for kind in storm edits; do
    late "$kind"
    # Other tests run beside this one and take their share: the figure is for people, the bound for
    # a world that no longer goes on.
    [ "$late" -le $((alone + 600)) ] || fail "$kind: $late of 1000 steps are late, $alone without"
done

# Clients cannot end this run; the system can.
start "$data/square.env" attacked.3dm --clock step --no-shutdown
dial world
expect world WORLD 'OK WORLD .*'
expect world SHUTDOWN 'ERR 403 .*--no-shutdown'
expect world STEP 'OK STEP n=1 .*'
stop TERM
