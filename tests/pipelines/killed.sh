#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A signal in the middle ends with 128+n and leaves the folder as it was. (arrange, which has a
# layout worth keeping, is in arrange_stopped.sh.) At any other moment too: files are whole old or
# whole new ones, those that belong together of one run, and no stand-in is left.
. "$(dirname "$0")/common.sh"

mkdir work
echo old >work/scans.jsonl
for signal in TERM INT HUP; do
    # More work than any machine does in the time given.
    interrupt "$signal" 0.5 scan "$scenes/barriers.env" "$scenes/barriers.3dm" --noise \
        --frames 100000000 --no-progress -o work/scans.jsonl
    [ "$(ls -A work)" = scans.jsonl ] || fail "left behind after SIG$signal: $(ls -A work)"
    [ "$(cat work/scans.jsonl)" = old ] || fail "the old file is gone after SIG$signal"
done

# A map is two files. Rooms A and B are written in turn, and each run is killed some time.
mkdir maps sets runs
printf '#env 1\nfence path=0,0;4,0;4,3;0,3 closed=yes\n' >A.env
printf '#env 1\nfence path=1,0;9,0;9,8;1,8 closed=yes\n' >B.env
cp "$data/session.3dm" robots.3dm
for room in A B; do
    envc $room.env --to ros -o whole.yaml
    sums=$(cat whole.yaml whole.pgm | sed 's/whole/map/' | cksum)
    [ $room = A ] && sums_a=$sums || sums_b=$sums
    arrange $room.env --sensor laser,range=1 --candidates 1,1,4 -q >$room.3dm
    scan $room.env $room.3dm --to csv >scan$room.csv
    coverage $room.env $room.3dm --to csv -o coverage$room.csv >/dev/null
done
envc A.env --to ros -o maps/map.yaml
[ "$(cat maps/map.yaml maps/map.pgm | cksum)" = "$sums_a" ] || fail "other bytes"
cp A.3dm sets/layout.3dm
cp scanA.csv sets/scan.csv
cp coverageA.csv sets/coverage.csv
# A job that is killed before it is the tool would clean up for all.
trap - EXIT
one_of() { cmp -s "$1" "$2" || cmp -s "$1" "$3" || fail "$1 is neither old nor new $4"; }
for ((i = 0; i < ${ISPACE_KILLS:-40}; ++i)); do
    signals=(TERM INT HUP)
    signal=${signals[$((i % 3))]}
    [ $((i / 3 % 2)) -eq 0 ] && room=B || room=A
    set -m
    envc $room.env --to ros -o maps/map.yaml 2>/dev/null & jobs_=($!)
    arrange $room.env --sensor laser,range=1 --candidates 1,1,4 -q -o sets/layout.3dm 2>/dev/null & jobs_+=($!)
    scan $room.env $room.3dm -o sets/scan.csv 2>/dev/null & jobs_+=($!)
    coverage $room.env $room.3dm -o sets/coverage.csv >/dev/null 2>&1 & jobs_+=($!)
    simrun $room.env --until 1000 --port-file runs/port --record runs/record >/dev/null 2>&1 & jobs_+=($!)
    set +m
    sleep "0.0$((RANDOM % 10))$((RANDOM % 10))"
    kill -"$signal" "${jobs_[@]}" 2>/dev/null || true
    # Some layouts are worth keeping and simrun ends well: any status will do.
    for job in "${jobs_[@]}"; do wait "$job" 2>/dev/null || true; done
    sums=$(cat maps/map.yaml maps/map.pgm | cksum)
    [ "$sums" = "$sums_a" ] || [ "$sums" = "$sums_b" ] || fail "a torn map after SIG$signal"
    grep -q '^result ' sets/layout.3dm && tail -c 1 sets/layout.3dm | has '^$' ||
        fail "half a layout after SIG$signal"
    one_of sets/scan.csv scanA.csv scanB.csv "after SIG$signal"
    one_of sets/coverage.csv coverageA.csv coverageB.csv "after SIG$signal"
    [ ! -s runs/port ] || grep -qx '[0-9]*' runs/port || fail "no port after SIG$signal"
    left=$(find . -name '.ispace.tmp*')
    [ -z "$left" ] || fail "left behind after SIG$signal: $left"
done
trap cleanup EXIT
