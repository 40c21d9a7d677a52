#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The program that avoids obstacles drives through the thesis' scene (section 5.2.2) without contact: without noise, and
# with errors of odometry, slipping wheels, a slippery floor and a wrong start. By steps it does the same twice.
. "$(dirname "$0")/../pipelines/common.sh"

avoid=$binary_dir/examples/avoid
envc "$scenes/ispace.env" --slice 0.1 --resolution 0.02 --to ros -o map.yaml
envc "$scenes/ispace.env" --set blanket.friction=0.3 --to env -o slippery.env
envc "$scenes/ispace.3dm" --delete 'l*' --set r1.start_noise=0.05,3 \
    --set r1.odometry_noise=0.004,0.001,0.001,0.0005 --set r1.motion_noise=0.004,0.001,0.001,0.0005 \
    --to 3dm -o astray.3dm

# drive ENV LAYOUT SIMRUN_OPTION…: simrun judges the true way.
drive() {
    rm -f port
    simrun "$@" --clock step --port-file port --expect 'no collision' \
        --expect 'r1 within 0.4 of 0.5,-2 before 60' >announced 2>warnings &
    server=$!
    trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    timeout 60 "$avoid" map.yaml 0.5,2,-90 0.5,-2 -rrtp "$(cat port)" -o way.csv >out 2>err ||
        fail "status $? of avoid with $*: $(cat out err)"
    grep -q '^reached: 0\.[0-3][0-9] m from the goal after [0-9.]* s and [0-9.]* m$' out || fail "$(cat out)"
    kill "$server"
    wait "$server" || fail "simrun with $*: status $?, $(cat warnings)"
}
drive "$scenes/ispace.env" "$scenes/ispace.3dm"
cp way.csv first.csv
drive "$scenes/ispace.env" "$scenes/ispace.3dm"
expect_same first.csv way.csv "another way the second time"
for seed in 1 2 3 4 5; do
    drive slippery.env astray.3dm --noise --seed "$seed"
    ! cmp -s first.csv way.csv || fail "seed $seed drives as if nothing were wrong"
done

# The judge can say no: straight ahead is the barrier.
simrun "$scenes/ispace.env" "$scenes/ispace.3dm" --clock fast --until 20 --script - --expect 'no collision' \
    <<<'0 r1 FORWARD 4' >out 2>err && fail "the barrier is in nobody's way"

expect_status 0 "$avoid" --help
grep -q '^usage: avoid' out || fail "no help on standard output"
expect_status 2 "$avoid" map.yaml
expect_status 2 "$avoid" map.yaml 0.5,2,-90junk 0.5,-2 -rrtp 1
expect_status 1 "$avoid" map.yaml 0.5,2,-90 0.5,-2 -rrtp 1 -o none/way.csv
grep -q '^avoid: cannot write none/way.csv' err || fail "$(cat err)"
expect_status 1 "$avoid" none.yaml 0.5,2,-90 0.5,-2 -rrtp 1
expect_status 1 "$avoid" map.yaml 0.5,2,-90 0.5,-2 -rrtp 1
