#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# scan writing many files: folders, patterns, files beside a picture, and full disks.
. "$(dirname "$0")/common.sh"

room=$data/square.env
cat >two.3dm <<'END'
#3dm 1
laser id=a/b at=0,0
laser id=l2 at=0.5,0 heading=90
ranger id=k at=-1,0,0.5 pixels=32,24
END

# A folder is made, and holds a file a reading; any format.
expect_status 0 scan "$room" two.3dm --frames 2 --to jsonl -o sets/jsonl/
[ "$(ls sets/jsonl | tr '\n' ' ')" = "a_b-0000.jsonl a_b-0001.jsonl k-0000.jsonl k-0001.jsonl l2-0000.jsonl l2-0001.jsonl " ] ||
    fail "files: $(ls sets/jsonl)"
[ "$(wc -l <sets/jsonl/k-0001.jsonl)" -eq 2 ] || fail "not a header and a reading"
[ ! -s out ] || fail "something on stdout"
# Pictures: depth, colours and camera_info of the ranger, obstacle maps of lasers.
expect_status 0 scan "$room" two.3dm --to png -o sets
[ "$(ls sets | tr '\n' ' ')" = "a_b-0000.png jsonl k-0000-color.png k-0000.png k-0000.yaml l2-0000.png " ] ||
    fail "files: $(ls sets)"
expect_status 0 scan "$room" two.3dm --to png --no-color --select k -o one.png
[ "$(echo one*)" = "one.png one.yaml" ] || fail "files: $(echo one*)"
expect_same one.png sets/k-0000.png "another picture in a file of its own"
scan "$room" two.3dm --to png --select k >stream.png
expect_same one.png stream.png "another picture on stdout"

# Patterns.
expect_status 0 scan "$room" two.3dm --frames 2 --select '[ak]*' -o 'p-%s-%03d-100%%.pcd'
[ "$(echo p-*)" = "p-a_b-000-100%.pcd p-a_b-001-100%.pcd p-k-000-100%.pcd p-k-001-100%.pcd" ] || fail "$(echo p-*)"
expect_error 2 scan "$room" two.3dm --to pcd -o 'x-%d.pcd'
expect_error 2 scan "$room" two.3dm --frames 2 --to pcd -o 'x-%s.pcd'
for pattern in 'x-%n.pcd' 'x-%x.pcd' 'x-%5d.pcd' 'x-%05s.pcd' 'x-%' 'x-%0000000000012d.pcd'; do
    expect_error 2 scan "$room" two.3dm --select l2 -o "$pattern"
done
[ -z "$(find . -name 'x-*')" ] || fail "files of refused patterns: $(find . -name 'x-*')"
# The suffix that was written stays; a number hidden in one, or names that run together, are refused.
expect_status 0 scan "$room" two.3dm --frames 2 --select l2 --to raw -o 'r%d.f32'
[ "$(echo r?.*)" = "r0.f32 r1.f32" ] || fail "$(echo r?.*)"
expect_error 2 scan "$room" two.3dm --frames 3 --select l2 --to csv -o 'q.%d'
expect_error 2 scan "$room" two.3dm --frames 12 --to raw -o 'q%s%d.raw'
expect_error 2 scan "$room" two.3dm --select k --to png -o k.yaml
# A stream has no files beside it.
mkdir links
ln -s /dev/null links/nothing
expect_status 0 scan "$room" two.3dm --select k --to png -o links/nothing
[ "$(ls -A links)" = nothing ] || fail "beside a device: $(ls -A links)"
# Where one file cannot hold them all.
expect_error 2 scan "$room" two.3dm --to png -o all.png
expect_error 2 scan "$room" two.3dm --to png
expect_error 2 scan "$room" two.3dm --to pcd --coordinates sensor -o all.pcd
expect_error 2 scan "$room" two.3dm --to csv
expect_error 2 scan "$room" two.3dm --to carmen
expect_error 2 scan "$room" two.3dm --select x
expect_error 2 scan --list-models "$room"
printf '#3dm 1\nlaser at=0,0\nlaser at=0,1\nlaser at=1,0\n' >three.3dm
expect_error 2 scan "$room" three.3dm --to carmen
expect_status 0 scan "$room" three.3dm --to carmen -o logs/
[ "$(grep -hc ^ROBOTLASER1 logs/* | tr '\n' ' ')" = "1 1 1 " ] || fail "logs: $(cat logs/*)"
printf '#3dm 1\nlaser at=0,0 tilt=-5\n' >tilted.3dm
expect_error 2 scan "$room" tilted.3dm --to carmen
expect_error 2 scan "$room" three.3dm --to png -o one.png
expect_status 0 scan "$room" two.3dm --to pcd --encoding ascii -o all.pcd
[ "$(grep -cv '^[#A-Z]' all.pcd)" -gt 700 ] || fail "not all points in one cloud"

# A file where a folder is wanted, and no right to write.
echo old >file
expect_error 1 scan "$room" two.3dm -o file/
[ "$(cat file)" = old ] || fail "the file is gone"
# make knows no rule for a set; a folder that cannot be, and depths that 16 bits do not hold.
expect_error 2 scan "$room" two.3dm --to png -o rule/ -MD
expect_error 1 scan "$room" two.3dm -o file/
grep -q '^scan: file/: error: ' err || fail "file/: $(cat err)"
printf '#3dm 1\nranger range=100 at=0,0 pixels=4,3\n' >far.3dm
expect_status 0 scan "$room" far.3dm --to png -o far.png
grep -q 'warning: ranger1 sees as far as 100 m, and 16 bits end at 65.535 m' err || fail "$(cat err)"
expect_status 0 scan "$room" far.3dm --to png --depth-scale 500 -o far.png
[ ! -s err ] || fail "a warning for nothing: $(cat err)"
# Separate tables may hold readings of any kind.
expect_status 0 scan "$room" two.3dm --to csv -o tables/
head -qn 1 tables/k-0000.csv | has '^sensor,frame,t,column,row,' || fail "$(head -n 1 tables/*)"
head -qn 1 tables/l2-0000.csv | has '^sensor,frame,scan,t,beam,' || fail "$(head -n 1 tables/*)"

# A full disk: an error, and no half of a file.
small_disk
for format in raw pcd png jsonl; do
    rm -rf disk/*
    expect_status 1 scan "$room" two.3dm --frames 500 --select '[k]' --to "$format" -o disk/
    grep -q "disk/.*No space left on device" err || fail "$format: $(cat err)"
    one_error scan "$format"
    expect_status 1 scan "$room" two.3dm --frames 500 --select l2 --to "${format/png/csv}" -o disk/all
    [ ! -e disk/all ] || fail "$format: half a file"
    [ -z "$(find disk -name '.ispace*')" ] || fail "left behind: $(ls -A disk)"
done
# After a failure no thread writes a half-computed reading.
for _ in 1 2 3 4 5; do
    rm -rf disk/*
    expect_status 1 scan "$room" two.3dm --frames 500 --select '[k]' --to png -j 4 -o disk/
    one_error scan "png, four threads"
done
