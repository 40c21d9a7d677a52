#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A session as a person types it into nc, with a world that runs 20 times as fast as real: motion,
# stall, conflict, garbage, and three readers of a laser meanwhile.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"

write_hall
start hall.env hall.3dm --clock real:20

for reader in one two three; do
    dial "$reader"
    expect "$reader" "LASER l1" \
        'OK LASER l1 angle_min=-90 angle_max=90 step=1 n=181 range_min=0 range_max=8 rate=10'
    expect "$reader" STREAM 'OK STREAM every=1'
done

dial driver
expect driver "FORWARD 1" 'ERR 405 .*ROBOT.*'
expect driver "ROBOT r9" 'ERR 404 .*r1.*'
expect driver "ROBOT r1" 'OK ROBOT r1 model=pioneer-2dx radius=0\.25 speed=0\.5 .* max_speed=1\.6 .*'
dial other
expect other "ROBOT r1" 'ERR 409 .*r1.*'

number='-?[0-9]+\.[0-9]{3}'
status="OK STATUS t=[0-9]+\.[0-9]{3} x=$number y=$number heading=$number speed=$number \
rotspeed=$number accel=[-0-9.]+ rotaccel=[-0-9.]+ stall=[01]"

# SPEED, and STOP that brakes over v^2 / 2a.
expect driver "SPEED 0.3" 'OK SPEED speed=0\.3'
at_speed() {
    expect driver STATUS "$status"
    [ "$(value speed)" = 0.300 ]
}
eventually "0.3 m/s" at_speed
expect driver STOP 'OK STOP'
expect driver STATUS "$status"
begun=$(value x) braking=$(value speed)
at_rest() {
    expect driver STATUS "$status"
    [ "$(value speed)" = 0.000 ]
}
eventually "rest" at_rest
# From the speed seen on the way down: v^2 / 2a with a = 0.3.
near "$(value x)" "$(awk -v x="$begun" -v v="$braking" 'BEGIN { print x + v * v / 0.6 }')" 0.003 \
    "the place where it stops"

# FORWARD ends within a millimetre, LEFT within a tenth of a degree.
done_line() { grep -qE "^DONE id=$1 t=[0-9]+\.[0-9]{3}$" driver.out; }
from=$(value x)
expect driver "FORWARD 1.5" 'OK FORWARD id=1 distance=1\.5'
eventually "DONE id=1" done_line 1
expect driver STATUS "$status"
# Both ends are told to the millimetre, so their difference may be one off.
near "$(value x)" "$(awk -v x="$from" 'BEGIN { print x + 1.5 }')" 0.00101 "FORWARD 1.5"
expect driver "LEFT 90" 'OK LEFT id=2 angle=90'
eventually "DONE id=2" done_line 2
expect driver STATUS "$status"
near "$(value heading)" 90 0.1 "LEFT 90"
near "$(value y)" 0 0.00101 "turning on the spot"

# Garbage, and values out of range.
expect driver "GO WEST" 'ERR 400 .*HELP.*'
expect driver "FORWARD much" 'ERR 400 .*'
expect driver "FORWARD -1" 'ERR 416 .*BACKWARD.*'
expect driver "SPEED 50" 'ERR 416 .*1\.6 m/s.*'
expect driver "forward 1" 'ERR 400 .*FORWARD.*'
expect driver "$(printf '\001\377\200')" 'ERR 400 .*'
expect driver HELP 'OK HELP .*FORWARD.*'

# Into the wall: y = 2 less the radius.
expect driver "FORWARD 5" 'OK FORWARD id=3 distance=5'
stalled() { grep -qE '^FAIL id=3 reason=stall t=[0-9]+\.[0-9]{3}$' driver.out; }
eventually "FAIL id=3" stalled
expect driver STATUS "$status"
[ "$(value stall)" = 1 ] && [ "$(value speed)" = 0.000 ] || fail "no stall: $reply"
near "$(value y)" 1.75 0.01 "where the wall stops it"
grep -qE '^simrun: warning: t=[0-9.]+ r1 at [-0-9.,]+ ran into ' simrun.err || fail "no warning: $(cat simrun.err)"
# In one piece each, so that a slow machine does not let the motion end before the next request.
expect driver "BACKWARD 1" 'OK BACKWARD id=4 distance=1'
expect driver STATUS "$status"
[ "$(value stall)" = 0 ] || fail "still stalled: $reply"
send driver 'LEFT 3600\nRIGHT 45\n'
replaced() { grep -qE '^FAIL id=5 reason=replaced t=' driver.out; }
eventually "FAIL id=5" replaced
send driver 'LEFT 3600\nSTOP\n'
stopped() { grep -qE '^FAIL id=7 reason=stopped t=' driver.out; }
eventually "FAIL id=7" stopped

# A client that leaves frees the robot.
expect driver QUIT 'OK QUIT'
freed() {
    ask other "ROBOT r1"
    [ "${reply%% *}" = OK ]
}
eventually "r1 to be free" freed
expect other QUIT 'OK QUIT'

# Every reader got every scan, and the same bytes.
expect one STOP 'OK STOP'
last=$(grep -a '^SCAN' one.out | tail -n 1 | sed 's/.* seq=\([0-9]*\) .*/\1/')
for reader in one two three; do
    reached() { [ "$(grep -a '^SCAN' $reader.out | tail -n 1 | sed 's/.* seq=\([0-9]*\) .*/\1/')" -ge "$last" ]; }
    eventually "scan $last for $reader" reached
    # Read to the end: the commands before awk would fail if it closed the pipe.
    grep -a '^SCAN' $reader.out | sed 's/.* seq=\([0-9]*\) .*/\1/' |
        awk -v last="$last" 'is_over { next } NR > 1 && $1 != before + 1 { print "after " before " came " $1; bad = 1 }
            { before = $1 } $1 == last { is_over = 1 } END { exit bad }' || fail "$reader missed a scan"
done
[ "$last" -gt 50 ] || fail "only $last scans"
for reader in two three; do
    common=$(comm -12 <(grep -a '^SCAN' one.out | LC_ALL=C sort) <(grep -a '^SCAN' $reader.out | LC_ALL=C sort) | wc -l)
    [ "$common" -gt $((last / 2)) ] || fail "only $common scans of $reader are those of one"
done
# The laser sees the robot pass: the beam ahead meets it before the wall in some scans.
grep -aE '^SCAN l1 t=[0-9.]+ seq=[0-9]+ angle_min=-90 angle_max=90 step=1 n=181 stream=1 r=' one.out |
    sed 's/.* r=//' | awk -F, '{ for (k = 1; k <= NF; k++) if ($k + 0 != first[k] + 0 && NR > 1) seen = 1
        if (NR == 1) for (k = 1; k <= NF; k++) first[k] = $k } END { exit !seen }' ||
    fail "the laser sees no robot"
stop TERM
