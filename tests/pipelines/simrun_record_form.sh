#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# --record-every, --record-columns and --record-compression: the rows are those of the whole record, and all readers of
# records take them.
. "$(dirname "$0")/common.sh"

command -v zstdcat >/dev/null || skip "no zstd"
cp "$data/square.env" .
cat >all.3dm <<'END'
#3dm 1
robot id=r1 model=pioneer-3dx at=-1.5,0
laser id=l1 on=r1 rate=5 range=4
robot id=r2 at=1,-1 heading=90
human id=h1 at=1,1 path=1,1;-1,1.2
laser id=l2 at=0,-1.9 heading=90 fov=180
END
printf '0 r1 FORWARD 2\n0.3 r2 ROTSPEED 40\n4 r1 ROTSPEED 60\n' >script
# run FOLDER OPTION…
run() {
    simrun square.env all.3dm -q --clock fast --dt 0.02 --until 7.05 --script script --noise --record "$@" >/dev/null
}
run whole
run thin --record-every 0.1s
run packed --record-compression zstd
run small --record-every 0.1s --record-compression zstd --record-columns x,y,heading_deg,stall
for file in robots people odometry; do
    # All times of the run are multiples of 0.02 s.
    awk -F, 'NR == 1 || sprintf("%.0f", $1 * 1000) % 100 == 0' whole/$file.csv >rows
    expect_same rows thin/$file.csv "other rows of $file"
    zstdcat packed/$file.csv.zst >rows
    expect_same whole/$file.csv rows "other compressed rows of $file"
done
cut -d , -f 1-5,10 thin/robots.csv >rows
zstdcat small/robots.csv.zst >few
expect_same rows few "other columns"
zstdcat packed/scans.jsonl.zst | tail -n +2 >readings
tail -n +2 whole/scans.jsonl >expected
expect_same expected readings "other readings"
[ ! -e packed/robots.csv ] || fail "$(ls packed)"
size() { cat "$1"/robots.csv* "$1"/people.csv* | wc -c; }
[ $((3 * $(size packed))) -lt $((2 * $(size whole))) ] || fail "$(size packed) bytes of $(size whole)"
[ $((12 * $(size small))) -lt "$(size whole)" ] || fail "$(size small) bytes of $(size whole)"

# Readers: measures, readings, views, pictures, replays.
measure() { coverage --run "$1" --json -q | sed 's/"record":"[^"]*"//'; }
measure whole >expected
measure packed >found
expect_same expected found "other measures of the compressed record"
for record in thin small; do
    measure $record | has '"run"' || fail "$record cannot be measured"
done
scan --run whole --to csv -q >expected
scan --run small --to csv -q >found
expect_same expected found "other readings of the compressed record"
scan --run whole --to carmen -q | grep -v '^#' >expected
scan --run packed --to carmen -q | grep -v '^#' >found
expect_same expected found "other odometry of the compressed record"
run sparse --record-every 0.3
expect_status 1 scan --run sparse --to carmen
grep -q 'robots.csv: error: holds no moment at t=0.2 of a scan, as it was recorded with --record-every 0.3' err ||
    fail "$(cat err)"
for record in packed small; do
    scan square.env all.3dm --view bird --run $record -q -o view.png
    simrun --replay $record -q -o ways.png
    rm view.png ways.png
done
replay() { simrun --replay "$@" -q --clock fast --record again >/dev/null; }
replay packed
expect_same whole/robots.csv again/robots.csv "another replay of the compressed record"
expect_same whole/odometry.csv again/odometry.csv "another replay of the compressed odometry"
replay small --record-columns x,y,heading_deg,stall
zstdcat small/robots.csv.zst >expected
expect_same expected again/robots.csv "another replay of the thinned record"
[ "$(cut -d , -f 1,3,4 again/info.csv | tail -n 1)" = "0.1,70,7" ] || fail "$(cat again/info.csv)"

# A building: each of its rooms, also replayed.
tower() {
    simrun "$data/tower.yaml" "$data/tower.3dm" -q --clock fast --dt 0.02 --until 12 --record tower "$@" >/dev/null
}
tower
mkdir rooms
for room in ground upper; do
    awk -F, 'NR == 1 || sprintf("%.0f", $1 * 1000) % 100 == 0' tower/$room/robots.csv >rooms/$room
done
rm -r tower
tower --record-every 0.1s --record-compression zstd
simrun --replay tower -q --clock fast --record again_tower >/dev/null
for room in ground upper; do
    zstdcat tower/$room/robots.csv.zst >rows
    expect_same rooms/$room rows "other rows of $room"
    expect_same rows again_tower/$room/robots.csv "another replay of $room"
done
coverage --run tower -q >/dev/null

# A killed run.
simrun square.env all.3dm -q --clock real:20 --dt 0.02 --record killed --record-compression zstd >/dev/null &
sleep 1.5
kill -9 $!
wait $! || true
replay killed 2>err
[ "$(wc -l <again/robots.csv)" -gt 100 ] || fail "$(wc -l <again/robots.csv) lines of a killed run"

# What is refused.
expect_error 2 simrun square.env all.3dm --clock fast --dt 0.02 --until 1 --record bad --record-every 0.03
grep -q 'wanted a whole number of steps of 0.02 s' err || fail "$(cat err)"
[ ! -e bad ] || fail "a folder in spite of the error"
expect_error 2 simrun square.env all.3dm --record bad --record-columns stalls
grep -q 'stalls. is no column of robots.csv or people.csv, did you mean .stall' err || fail "$(cat err)"
expect_error 2 simrun square.env all.3dm --record bad --record-compression gzip
printf 't,id,x,y,heading_deg\n' >small/robots.csv.zst
expect_error 1 coverage --run small
grep -q 'robots.csv.zst: error: cannot be unpacked' err || fail "$(cat err)"
