#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/batch with make: the single run's bytes; a second run skips all jobs, a job runs again when its room
# changes, and after the loss of some results only those are made.
. "$(dirname "$0")/batch.sh"

[[ $(make --version) =~ ^GNU\ Make\ (4\.([3-9]|[1-9][0-9])|[5-9]) ]] || skip "no GNU make 4.3"
set_up made
make -s -j2 -C made >out 2>err || fail "$(cat err)"
expect_single made
make -C made >out
grep -q 'Nothing to be done' out || fail "make does something twice: $(cat out)"

rm made/results/crowded_urg-04lx_count1_seed1.3dm made/results/l-room_urg-04lx_count2_seed3.json
make -j2 -C made >out 2>err || fail "$(cat err)"
[ "$(grep -c '^arrange ' out)" -eq 1 ] || fail "not one layout is made again: $(grep '^arrange ' out)"
[ "$(grep -c '^coverage ' out)" -eq 2 ] || fail "not two reports are made again: $(grep '^coverage ' out)"
expect_single made

echo '# changed' >>made/l-room.env
make -C made -n table.csv >out
[ "$(grep -c '^arrange l-room' out)" -eq 50 ] || fail "a changed room: $(grep -c '^arrange' out) of 50"
! grep -q '^arrange crowded' out || fail "jobs of another room are done again"
