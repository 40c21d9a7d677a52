#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The demo runs and ends with a coverage figure and a picture that is there.
. "$(dirname "$0")/common.sh"

bash "$source_dir/share/examples/demo.sh" "$scratch/demo" >out 2>err || fail "$(cat err)"
tail -n 4 out | has -E 'coverage: [0-9.]+%$' || fail "no coverage figure at the end: $(cat out)"
# Around the barrier, without collision.
grep -qx 'robot r1 drove from 0.5, 2 to 0.5, -1.9; 1083 scans in drive/scans.jsonl' out ||
    fail "another drive: $(tail -n 3 out)"
! grep -q warning err || fail "a collision: $(cat err)"
picture=$(tail -n 1 out | sed 's/.* //')
head -c 8 "$picture" | cmp - <(printf '\211PNG\r\n\032\n') || fail "no picture: $(tail -n 1 out)"
