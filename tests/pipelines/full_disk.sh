#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A full disk is an error for each output; on a real file system no file remains.
. "$(dirname "$0")/common.sh"

placing=(--sensor laser --strategy grid -X 2 -Y 2 --deg 4)
room=$data/room.env
layout=$data/room.3dm
[ -c /dev/full ] || skip "no /dev/full here"

# Every product and every report, on stdout and by -o.
full() {
    local status=0
    "$@" >/dev/full 2>err || status=$?
    [ "$status" -eq 1 ] || fail "status $status, expected 1, with a full disk behind: $*"
    grep -q "^$1: .*error: No space left on device" err || fail "$*: $(cat err)"
}
full envc "$room" --to glb
full envc "$room" --to env
full envc "$room" --info
full envc "$room" --info --json
full arrange "$room" "${placing[@]}"
full scan "$room" "$layout"
for format in mcap npz las; do
    full scan "$room" "$layout" --to $format
done
full coverage "$room" "$layout"
full coverage "$room" "$layout" --json
for tool in $tools; do
    full "$tool" --help
    full "$tool" --version
done
for command in "envc $room --to glb" "arrange $room ${placing[*]}" "scan $room $layout" \
    "coverage $room $layout --to png"; do
    # shellcheck disable=SC2086
    expect_status 1 $command -o /dev/full
    grep -q "/dev/full: error: No space left on device" err || fail "$command: $(cat err)"
done

small_disk
# Readings that wait for the end of a scan wait in TMPDIR, which may be full, too.
for format in npz las ply; do
    expect_status 1 env TMPDIR=disk scan "$room" "$layout" --frames 20000 --to $format -o whole
    grep -q "^scan: temporary file in disk: error: No space left on device" err || fail "scan: $(cat err)"
    [ ! -e whole ] && [ -z "$(ls -A disk)" ] || fail "left behind: $(ls -A disk)"
done
echo old >disk/target.png
head -c 60000 /dev/zero >disk/ballast 2>/dev/null || true
expect_status 1 coverage "$room" "$layout" -o disk/target.png
grep -q "No space left on device" err || fail "coverage: $(cat err)"
[ "$(cat disk/target.png)" = old ] || fail "the old file is gone"
[ "$(ls -A disk)" = "$(printf 'ballast\ntarget.png')" ] || fail "left behind: $(ls -A disk)"

# A record ends with the last step that is whole in both of its files, and says which that is.
# Each file takes a page of this disk at its first byte.
rm disk/ballast
mount -o remount,size=96k disk
for ballast in 0 4000 9000 16000 40000 44000 48000; do
    head -c $ballast /dev/zero >disk/ballast
    expect_status 1 timeout 60 simrun "$data/square.env" "$data/session.3dm" --clock fast \
        --until 1000000 --record disk/run
    grep -q '^simrun: disk/run/[a-z]*\.[a-z]*: error: No space left on device' err ||
        fail "simrun: $(cat err)"
    rows=$(($(wc -l <disk/run/robots.csv) - 1))
    [ $((rows % 2)) -eq 0 ] || fail "half a step of two robots: $rows rows"
    steps=$(tail -n 1 disk/run/info.csv | cut -d, -f3)
    [ "$steps" -eq $((rows / 2 - 1)) ] || fail "info.csv tells $steps steps of $((rows / 2 - 1))"
    [ "$(tail -c 1 disk/run/scans.jsonl | od -An -c | tr -d ' ')" = '\n' ] || fail "half a scan"
    rm -r disk/run
done
