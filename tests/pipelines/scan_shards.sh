#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# scan --shard, --merge and --resume: the shards of a job merge to it, byte for byte, for any number of them; a merge
# rejects parts of different jobs; a kill or a full disk loses no complete reading.
. "$(dirname "$0")/common.sh"

room=$data/room.env
mkdir noisy
layout=$PWD/noisy/room.3dm
sed 's/^laser .*/& sigma=0.01/' "$data/room.3dm" >"$layout"
awk 'BEGIN { for (i = 0; i < 13; ++i)
    printf "%.2f %.4f %.4f 0.15 0 0 %.6f %.6f\n", i / 10, cos(i) / 2, sin(i) / 2, sin(i / 7), cos(i / 7) }' >way.txt

# in_shards N COMMAND…: ./whole, by N shards that are merged in the order that a shell lists them.
in_shards() {
    local n=$1 i
    shift
    rm -f s*.part
    for ((i = 1; i <= n; ++i)); do "$@" --shard "$i/$n" -o "s$i.part"; done
    scan --merge s*.part -o whole
}
# joins MESSAGE COUNTS COMMAND…: for each number of shards.
joins() {
    local what=$1 counts=$2 n
    shift 2
    "$@" -o single
    for n in $counts; do
        in_shards "$n" "$@"
        expect_same whole single "$what: $n shards are not the whole"
    done
}
noisy=(scan "$room" "$layout" --noise --seed 5)
still=("${noisy[@]}" --frames 7)
joins jsonl "1 2 3 7 14 19" "${still[@]}"  # of 14 readings
for format in jsonl csv raw; do joins "$format" 3 "${still[@]}" --to "$format"; done
joins carmen 3 "${still[@]}" --to carmen --select l1
joins pcd "1 2 14 19" scan "$room" "$layout" --frames 7 --to pcd
joins "pcd in text" 2 scan "$room" "$layout" --frames 7 --to pcd --encoding ascii
joins "ply of two lasers" "2 5" scan "$room" "$layout" --frames 7 --to ply
joins "ply of one laser" 3 scan "$room" "$layout" --frames 14 --select l1 --to ply
joins poses "1 2 3 7 13 18" scan "$room" --poses way.txt --model urg-04lx --noise
joins "poses as a cloud" 3 scan "$room" --poses way.txt --model urg-04lx --to ply --encoding ascii
joins motion "2 5" scan "$room" --poses way.txt --model urg-04lx --motion --noise --to csv

# Poses through a pipe; parts through any thread count; a merge to stdout.
scan "$room" --poses - --model urg-04lx --to csv <way.txt >single
for i in 1 2 3; do
    scan "$room" --poses - --model urg-04lx --to csv --shard $i/3 -j $i -o p$i.part <way.txt
done
scan --merge p3.part p1.part p2.part >whole
expect_same whole single "poses of a pipe"

# Formats of one file a reading need no merge: shards write these files.
scan "$room" "$layout" --frames 5 --to png -o all/
mkdir shared
for i in 1 2 3; do scan "$room" "$layout" --frames 5 --to png --shard $i/3 -o shared; done
diff -r all shared || fail "files of shards are others"
# Each shard may resume, from its own file.
mkdir resumed
files=(scan "$room" "$layout" --frames 5 --to png --resume -o resumed/)
"${files[@]}" --shard 1/3 & job=$!
"${files[@]}" --shard 2/3
wait $job
"${files[@]}" --shard 3/3
diff -r all resumed || fail "files of shards that may go on are others"
[ "$(ls all | wc -l)" -eq 10 ] || fail "ten readings, and $(ls all | wc -l) files"

# Parts of different jobs.
for i in 1 2 3; do "${still[@]}" --shard $i/3 -o s$i.part; done
expect_error 1 scan --merge s1.part s3.part
grep -q 'missing shard 2 of 3' err || fail "$(cat err)"
expect_error 1 scan --merge s1.part s2.part s3.part s2.part
grep -q 'shard 2/3 is given twice' err || fail "$(cat err)"
# A part with readings beyond those of its job: the record of another one, before the end of the first.
"${noisy[@]}" --frames 8 --shard 2/2 -o other.part
"${noisy[@]}" --frames 4 --shard 1/1 -o more.part
expect_status 0 scan --merge more.part -o whole
python3 - <<'PY'
with open("more.part", "rb") as more, open("other.part", "rb") as other:
    part, rest = more.read(), other.read()
at, begin = part.rindex(b"=end "), rest.index(b"\n=0") + 1
with open("forged.part", "wb") as forged:
    # Without its header, which the first has.
    head = rest.index(b"\n=header ") + 1
    after = rest.find(b"\n=", head) + 1
    records = rest[begin:head] + rest[after:] if head > begin else rest[begin:]
    forged.write(part[:at] + records)
PY
expect_error 1 scan --merge forged.part -o none
grep -q 'record `000000000008+8` does not continue the first 8 of 8 readings' err || fail "$(cat err)"
cp s2.part doubled.part
expect_error 1 scan --merge s1.part s2.part s3.part doubled.part
refused() {
    local wanted=$1
    shift
    "$@" --shard 2/3 -o other.part
    expect_error 1 scan --merge s1.part other.part s3.part -o joined.jsonl
    grep -q "$wanted" err || fail "wanted '$wanted': $(cat err)"
    [ ! -e joined.jsonl ] || fail "a product in spite of the error"
}
refused 'the seed (`6`, `5`) differs\|the command' scan "$room" "$layout" --frames 7 --noise --seed 6
refused 'the command' scan "$room" "$layout" --frames 8 --noise --seed 5
refused 'the room differs' scan "$data/square.env" "$layout" --any-environment --frames 7 --noise --seed 5
sed 's/heading=45/heading=46/' "$layout" >room.3dm
refused 'what is in the files' scan "$room" room.3dm --frames 7 --noise --seed 5
sed 's/^tool scan .*/tool scan 0.0.1/' s2.part >old.part
expect_error 1 scan --merge s1.part old.part s3.part
grep -q 'the version of ispace' err || fail "$(cat err)"
head -c 2000 s2.part >torn.part
expect_error 1 scan --merge s1.part torn.part s3.part
grep -q 'cut short' err || fail "$(cat err)"
python3 - <<'END'
data = bytearray(open("s2.part", "rb").read())
data[len(data) // 2] ^= 1
open("bad.part", "wb").write(data)
END
expect_error 1 scan --merge s1.part bad.part s3.part
expect_error 1 scan --merge "$room"
grep -q 'not a part of a job' err || fail "$(cat err)"
expect_error 1 arrange --merge s1.part
grep -q 'a part of a job of scan: merge it with scan --merge' err || fail "$(cat err)"

# Contradictory options.
for words in "--shard 0/3" "--shard 4/3" "--shard 1" "--shard 1/2 -o s.jsonl" "--shard 1/2 --to png" \
    "--shard 1/2 --view bird -o v.png" "--resume" "--resume -o /dev/stdout" \
    "--shard 1/2 --to pcd --coordinates sensor"; do
    # shellcheck disable=SC2086
    expect_error 2 scan "$room" "$layout" $words
done
for words in "" "s1.part --frames 2" "s1.part --shard 1/2" "s1.part --resume" "s1.part -o some/"; do
    # shellcheck disable=SC2086
    expect_error 2 scan --merge $words
done
expect_error 2 scan --merge s1.part s2.part s3.part -o whole.csv
grep -q 'the parts hold jsonl' err || fail "$(cat err)"

# A run that goes on: from any byte that a kill or a full disk left there.
"${still[@]}" -o single
"${noisy[@]}" --frames 100000000 --resume -o big.jsonl 2>/dev/null & job=$!
for _ in $(seq 2000); do [ -s big.jsonl.resume ] && break; sleep 0.02; done
kill -9 $job
wait $job 2>/dev/null || true
[ -s big.jsonl.resume ] && [ ! -e big.jsonl ] || fail "nothing is left to go on from"
many=("${noisy[@]}" --frames 700)
"${many[@]}" -o single
"${many[@]}" --resume -o whole.jsonl
expect_same whole.jsonl single "--resume changes the result"
[ ! -e whole.jsonl.resume ] || fail "a checkpoint is left behind"
# Another command's checkpoint is left alone.
expect_error 1 "${many[@]}" --resume -o big.jsonl
grep -q 'what a job left, and not this one: the command' err || fail "$(cat err)"
# scan skips a complete shard, and writes a damaged one again.
scan "$room" "$layout" --frames 7 --shard 1/2 --resume -o r.part
before=$(stat -c %i r.part)
scan "$room" "$layout" --frames 7 --shard 1/2 --resume -v -o r.part 2>err
[ "$(stat -c %i r.part)" = "$before" ] || fail "a finished part was written again"
grep -q 'done already' err || fail "$(cat err)"
scan "$room" "$layout" --frames 8 --shard 1/2 --resume -o r.part
[ "$(stat -c %i r.part)" != "$before" ] || fail "the part of another job was kept"

# More parts than files may be open at first; and than may be at all.
mkdir parts
for i in $(seq 90); do scan "$room" "$layout" --frames 90 --shard "$i/90" -o "parts/$i.part"; done
scan "$room" "$layout" --frames 90 -o single
(ulimit -S -n 40 && scan --merge parts/*.part -o whole)
expect_same whole single "90 parts with 40 files"
status=0
(ulimit -n 40 && scan --merge parts/*.part -o none) 2>err || status=$?
[ "$status" -eq 1 ] && grep -q 'part: error: Too many open files' err || fail "status $status: $(cat err)"

small_disk
"${noisy[@]}" --frames 2000 -o single
expect_status 1 "${noisy[@]}" --frames 2000 --resume -o disk/scans.jsonl
grep -q 'No space left on device' err || fail "$(cat err)"
[ "$(ls -A disk)" = scans.jsonl.resume ] || fail "left behind: $(ls -A disk)"
mount -o remount,size=64m disk
"${noisy[@]}" --frames 2000 --resume -v -o disk/scans.jsonl 2>err
expect_same disk/scans.jsonl single "after a full disk"
[ "$(ls -A disk)" = scans.jsonl ] || fail "left behind: $(ls -A disk)"
