#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A signal in the middle ends with 128+n and leaves the folder as it was. (arrange, which has a
# layout worth keeping, is in arrange_stopped.sh.)
. "$(dirname "$0")/common.sh"

mkdir work
echo old >work/scans.jsonl
for signal in TERM INT HUP; do
    # More work than any machine does in the time given. A background job ignores INT unless it has
    # job control, hence -m.
    set -m
    scan "$scenes/barriers.env" "$scenes/barriers.3dm" --noise --frames 100000000 --no-progress \
        -o work/scans.jsonl 2>err &
    job=$!
    set +m
    sleep 0.5
    kill -0 "$job" || fail "the job is over too soon to be interrupted: $(cat err)"
    kill -"$signal" "$job"
    status=0
    wait "$job" || status=$?
    wanted=$((128 + $(kill -l "$signal")))
    [ "$status" -eq "$wanted" ] || fail "status $status after SIG$signal, expected $wanted"
    [ "$(ls -A work)" = scans.jsonl ] || fail "left behind after SIG$signal: $(ls -A work)"
    [ "$(cat work/scans.jsonl)" = old ] || fail "the old file is gone after SIG$signal"
done
