#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A signal in the middle ends with 128+n and leaves the folder as it was.
. "$(dirname "$0")/common.sh"

mkdir work
echo old >work/best.3dm
for signal in TERM INT HUP; do
    # More work than any machine does in the time given. A background job ignores INT unless it has
    # job control, hence -m.
    set -m
    arrange "$scenes/facilities.env" --sensor utm-30lx:10000 --strategy grid -X 40 -Y 40 --deg 16 \
        --no-progress -o work/best.3dm 2>err &
    job=$!
    set +m
    sleep 0.5
    kill -0 "$job" || fail "the job is over too soon to be interrupted: $(cat err)"
    kill -"$signal" "$job"
    status=0
    wait "$job" || status=$?
    wanted=$((128 + $(kill -l "$signal")))
    [ "$status" -eq "$wanted" ] || fail "status $status after SIG$signal, expected $wanted"
    [ "$(ls -A work)" = best.3dm ] || fail "left behind after SIG$signal: $(ls -A work)"
    [ "$(cat work/best.3dm)" = old ] || fail "the old file is gone after SIG$signal"
done
