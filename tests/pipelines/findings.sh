#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One scene through all five tools: what is wrong with it is said in the same sentences.
. "$(dirname "$0")/common.sh"

cat >room.env <<'END'
#env 1
ispace id=room at=4,3 size=8,6
cube id=c at=2,2 size=1
END
cat >layout.3dm <<'END'
#3dm 1
laser id=out at=9,3
laser id=in at=2,2
laser id=low at=4,3,-0.1
robot id=r at=10,3
human id=h at=6,3 path=6,3;9,3
laser id=pending
END

out="layout.3dm:2:1: laser out stands outside the room at (9.0, 3.0); move it in"
in="layout.3dm:3:1: laser in stands inside cube c at (2.0, 2.0); move it, or raise it above 1.01 m"
low="layout.3dm:4:1: laser low stands below the floor at (4.0, 3.0); raise it by 0.10 m"
robot="layout.3dm:5:1: robot r stands outside the room at (10.0, 3.0); move it in"
path="layout.3dm:6:1: human h has a path that leaves the room at (9.0, 3.0); move that point in"
pending="layout.3dm:7:1: laser pending has no position and takes no readings; give it \`at\` or \`on\`, or let arrange place it"

# findings TOOL SENTENCE…: ./err holds these findings and no others, in any order.
findings() {
    local tool=$1
    shift
    printf '%s\n' "$@" | LC_ALL=C sort >wanted
    grep "^$tool: layout.3dm:" err | sed -E "s/^$tool: //; s/: (error|warning): /: /" |
        LC_ALL=C sort >said
    cmp -s wanted said || fail "$tool says other things: $(diff wanted said)"
}

expect_status 1 envc room.env layout.3dm --check
findings envc "$out" "$in" "$low" "$robot" "$path" "$pending"

# Each command of --suggest resolves the findings that it tells; the sensor without a position is a sixth.
expect_status 1 envc room.env layout.3dm --check --suggest 9
[ "$(sed -n 's/^    //p' out | wc -l)" -eq 5 ] || fail "not five suggestions: $(cat out)"
while IFS= read -r told && IFS= read -r command; do
    left=$(expr "$told" : '.* fewer, \([0-9]*\) left$') || fail "no gain: $told"
    (eval "$command -q") || fail "no such change: $command"
    expect_status 1 envc changed.env --check
    now=$(grep -c '^envc: changed.env:' err)
    [ "$now" -eq $((left + 1)) ] || fail "$command leaves $now findings, not $left and one: $(cat err)"
    rm changed.env
done < <(grep '^  ' out)
expect_status 1 envc room.env layout.3dm --check --suggest 1
[ "$(wc -l <out)" -eq 3 ] || fail "more than one suggestion: $(cat out)"
expect_error 2 envc room.env layout.3dm --suggest

expect_status 0 scan room.env layout.3dm
findings scan "$out" "$in" "$low" "$robot" "$pending"
expect_status 0 scan room.env layout.3dm --select 'o*'
findings scan "$out"
expect_status 0 coverage room.env layout.3dm
findings coverage "$out" "$in" "$low" "$robot" "$pending"
expect_status 0 simrun room.env layout.3dm --listen 127.0.0.1:0 --clock fast --until 0.1
findings simrun "$out" "$in" "$low" "$robot" "$path" "$pending"
expect_status 0 arrange room.env layout.3dm
findings arrange "$out" "$in" "$low" "$robot"
for tool in scan coverage; do
    expect_status 0 $tool -q room.env layout.3dm
    [ ! -s err ] || fail "$tool -q says: $(cat err)"
done

# A laser in the floor between two storeys: each tool tells, and none sees anything.
cat >house.env <<'ENV'
#env 1
storey id=ground file=room.env height=2.8
storey id=upper file=room.env z=3.1 height=2.8
stairs id=s storeys=ground,upper at=6,1 heading=90 size=1,3.5
ENV
printf '#env 1\nispace id=room at=4,3 size=8,6,2.5\n' >room.env
cat >layout.3dm <<'LAYOUT'
#3dm 1
laser id=ground/l at=2,3,3 range=0,20 fov=360 step=90
laser id=ground/s at=6,2.7,1.4 range=0,1
LAYOUT
slab="layout.3dm:2:1: ground: laser l stands inside the floor of upper, 2.80 m to 3.10 m high, at (2.0, 3.0); lower it to 2.80 m"
steps="layout.3dm:3:1: ground: laser s stands inside the steps of stairs s at (6.0, 2.7); move it, or raise it to 1.51 m"
expect_status 1 envc house.env layout.3dm --check
findings envc "$slab" "$steps"
expect_status 0 scan house.env layout.3dm
findings scan "$slab" "$steps"
expect_status 0 coverage house.env layout.3dm
findings coverage "$slab" "$steps"
grep -qE '^ground/l +laser +[0-9.]+ m2 +0.00 m2 +0.00 m2' out || fail "a blind laser covers floor: $(cat out)"
expect_status 0 simrun house.env layout.3dm --clock fast --until 0.1
findings simrun "$slab" "$steps"
