#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# arrange --batch and scan --batch: the files of many scenes are those of single runs, for any number of threads and
# shards, after kills, and even if single scenes fail. coverage_batch.sh has the rest of the rules.
. "$(dirname "$0")/common.sh"

cp "$scenes"/{near-far,l-room,hall,crowded}.env "$data/square.env" .
cp near-far.env "a room.env"
cat >list <<'LIST'
# Rooms.
near-far.env
l-room.env

"a room.env"   # quoted
hall.env
crowded.env
LIST
how=(--sensor laser,range=4,fov=180:2 --candidates 0.5,0.5,8 --no-progress)

mkdir single
while read -r number room; do
    arrange -q "${how[@]}" "$room" -o "single/${room%.env}-000$number.3dm"
done <<'ROOMS'
2 near-far.env
3 l-room.env
5 a room.env
6 hall.env
7 crowded.env
ROOMS
same_layouts() { diff -r single "$1" || fail "$2: other layouts than single runs"; }

for threads in 1 2 7; do
    arrange -q "${how[@]}" --batch list -o "layouts$threads/" -j $threads >lines
    same_layouts layouts$threads "$threads threads"
    [ "$threads" = 1 ] || diff <(sed 's/layouts1/layouts'$threads/ lines1) lines || fail "lines of $threads threads"
    cp lines lines$threads
done
[ "$(wc -l <lines1)" -eq 5 ] || fail "not a line for each: $(cat lines1)"
coverage near-far.env layouts1/near-far-0002.3dm --json >report.json
python3 - <<'PYTHON' || fail "not the figures of the layouts: $(head -n 1 lines1)"
import json
lines = [json.loads(line) for line in open("lines1")]
assert [line["line"] for line in lines] == [2, 3, 5, 6, 7]
assert lines[2]["operands"] == ["a room.env"] and lines[2]["product"] == "layouts1/a room-0005.3dm"
report = json.load(open("report.json"))
assert abs(lines[0]["coverage"] - report["coverage"]["grid"]) < 1e-9, (lines[0], report["coverage"])
assert all(line["sensors"] == 2 and line["complete"] and line["value"] <= line["bound"] for line in lines)
PYTHON
arrange -q "${how[@]}" --batch - -o 'by/%s-%04d.3dm' <list >/dev/null
same_layouts by "a pattern, and a list on stdin"

# Shares write the files of the whole, and cat joins their lines.
for index in 1 2 3; do arrange -q "${how[@]}" --batch list -o shares/ --shard $index/3 >lines.$index; done
same_layouts shares "shards"
cat lines.1 lines.2 lines.3 | diff <(sed s/layouts1/shares/ lines1) - || fail "lines of shards"

# Killed again and again, a run ends with the same files and lines.
stored() { if [ -e gone_on/.resume ]; then wc -c <gone_on/.resume; else echo 0; fi; }
kills=0
while :; do
    arrange -q "${how[@]}" --batch list -o gone_on/ --resume -j 1 >lines &
    job=$!
    if [ $kills -lt 5 ]; then
        before=$(stored)
        for _ in $(seq 400); do
            [ "$(stored)" -le "$before" ] || break
            kill -0 "$job" 2>/dev/null || break
            sleep 0.01
        done
        kill -9 "$job" 2>/dev/null && kills=$((kills + 1))
    fi
    status=0
    wait "$job" 2>/dev/null || status=$?
    [ "$status" -eq 137 ] || break
done
[ "$status" -eq 0 ] && [ "$kills" -ge 1 ] || fail "status $status after $kills kills"
[ ! -e gone_on/.resume ] || fail "the checkpoint is left"
same_layouts gone_on "after $kills kills"
diff <(sed s/layouts1/gone_on/ lines1) lines || fail "lines after kills"

# A scene that fails has a line with the error, and stops no other; unmet targets are status 3.
printf '%s\n' near-far.env missing.env '"open' l-room.env >bad
expect_status 1 arrange "${how[@]}" --batch bad -o bad_layouts/
[ "$(grep -c '"error":' out)" -eq 2 ] || fail "not two lines of errors: $(cat out)"
grep -q '^arrange: bad:2: missing.env: error: No such file' err || fail "$(cat err)"
grep -q '^arrange: bad:3: error: the quote that opens here is not closed' err || fail "$(cat err)"
grep -q '^arrange: bad: error: 2 of 4 jobs failed' err || fail "$(cat err)"
cmp single/near-far-0002.3dm bad_layouts/near-far-0001.3dm && cmp single/l-room-0003.3dm bad_layouts/l-room-0004.3dm ||
    fail "others than single runs beside failures"
expect_status 3 arrange "${how[@]}" --batch list -o few/ --target 99%
grep -q '"reached":false' out && grep -q '^arrange: list: error: . of 5 jobs missed a requirement\|^arrange: error: . of 5' err ||
    fail "$(cat out err)"

# scan: one file for each scene, or a folder of one file for each reading.
paste -d ' ' <(printf '%s\n' near-far.env l-room.env) <(printf '%s\n' single/near-far-0002.3dm single/l-room-0003.3dm) >placed
for format in jsonl csv pcd npz las; do
    scan -q --batch placed --to $format --frames 2 --noise --seed 3 -o scans/ >scan_lines
    n=1
    while read -r room layout; do
        scan -q "$room" "$layout" --to $format --frames 2 --noise --seed 3 -o one.$format
        cmp one.$format "scans/${room%.env}-000$n.$format" || fail "$format of $room"
        n=$((n + 1))
    done <placed
    [ "$(grep -c '"readings":4' scan_lines)" -eq 2 ] || fail "$format: $(cat scan_lines)"
done
scan -q --batch placed --to png -o maps/ >/dev/null
scan -q near-far.env single/near-far-0002.3dm --to png -o map/
diff -r map maps/near-far-0001 || fail "obstacle maps of a list"

# Usage.
expect_error 2 arrange --batch list "${how[@]}"
grep -q 'name a folder for them (-o DIR/)' err || fail "$(cat err)"
expect_error 2 arrange --batch list near-far.env -o x/ "${how[@]}"
for option in --trace=t --curve=c.csv --report=r.html --export-mps=m --share=starts --checkpoint-interval=1 -MD; do
    expect_error 2 arrange --batch list -o x/ "${how[@]}" "$option"
    grep -q -e "error: ${option%%=*} is about one scene" err || fail "$option: $(cat err)"
done
expect_error 2 arrange --batch list -o x/ "${how[@]}" --merge
expect_error 2 arrange --batch list -o x/ --places - "${how[@]}"
expect_error 2 scan --batch placed --to png -o 'x-%04d.png'
expect_error 2 scan --batch placed --view bird -o x/
printf 'hall.env\nhall.env\n' >twice
expect_error 2 arrange --batch twice -o '%s.3dm' "${how[@]}"
grep -q 'hall.3dm is an operand of LIST, or the file of two lines' err || fail "$(cat err)"
