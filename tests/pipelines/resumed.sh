#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# kill -9 at random moments, again and again, then --resume: the bytes are those of an undisturbed run. ISPACE_KILLS=100
# for all of them; a tenth by default.
. "$(dirname "$0")/common.sh"

RANDOM=20261122
kills=${ISPACE_KILLS:-10}
trap - EXIT

# killed_often OUTPUT LONGEST COMMAND…: kills the command after up to LONGEST hundredths of a second,
# `kills` times or until it is done, again from the beginning where that is too early; at last lets it
# run. ./OUTPUT must then be ./single.
killed_often() {
    local output=$1 longest=$2 done_=0 job i
    shift 2
    rm -f "$output" "$output.resume"
    for ((i = 0; i < kills; ++i)); do
        "$@" --resume -o "$output" >/dev/null 2>err & job=$!
        sleep "$(printf '0.%02d' $((RANDOM % longest)))"
        kill -9 $job 2>/dev/null || true
        wait $job 2>/dev/null || true
        # Never half a product under the final name.
        if [ -e "$output" ]; then
            expect_same "$output" single "$output after kill $i"
            done_=$((done_ + 1))
            rm -f "$output"
        fi
    done
    expect_status 0 "$@" --resume -o "$output"
    expect_same "$output" single "$output after $kills kills"
    [ ! -e "$output.resume" ] || fail "a checkpoint is left behind: $*"
    # A kill between the two names of a product leaves the first, of a whole file.
    for left in $(find . -name '.ispace.tmp*'); do
        expect_same "$left" single "left behind after $i kills: $left"
        rm "$left"
    done
    echo "$output: $kills kills, done within $done_ of them"
}

envc "$scenes/crowded.env" -o room.glb
sed 's/^laser .*/& sigma=0.01/' "$data/room.3dm" >noisy.3dm
scanned=(scan "$data/room.env" noisy.3dm --noise --frames 20000)
"${scanned[@]}" -o single
killed_often scans.jsonl 60 "${scanned[@]}"
"${scanned[@]}" --to csv --shard 2/3 -o single
killed_often scans.part 40 "${scanned[@]}" --to csv --shard 2/3

# A proof with a tree stored every 0.05 s; starts and candidates, one by one.
proof=(arrange room.glb --sensor laser,range=4,fov=180:4 --candidates 0.3,0.3,16 --optimize exact -q --no-progress)
"${proof[@]}" -o single
killed_often best.3dm 90 "${proof[@]}" --checkpoint-interval 0.05
"${proof[@]}" --shard 2/4 -o single
killed_often best.part 90 "${proof[@]}" --shard 2/4 --checkpoint-interval 0.05
swap=(arrange room.glb --sensor laser,range=4,fov=180:5 --candidates 0.3,0.3,16 --starts 60 -q --no-progress)
"${swap[@]}" -o single
killed_often swap.3dm 70 "${swap[@]}"
cameras=(arrange "$scenes/open-office.env" --sensor camera:3 --candidates 1.5,1.5,8 --optimize greedy -q --no-progress)
"${cameras[@]}" -o single
killed_often cameras.3dm 50 "${cameras[@]}"

target=(arrange room.glb --sensor laser,range=4,fov=180:9 --candidates 0.25,0.25,16 --target 70% -q --no-progress)
"${target[@]}" -o single
killed_often target.3dm 90 "${target[@]}"
"${target[@]}" --shard 2/3 -o single
killed_often target.part 60 "${target[@]}" --shard 2/3

# TERM keeps all that is done, and says how to go on.
set -m
"${proof[@]}" --resume --checkpoint-interval 1000 -o best.3dm 2>err & job=$!
set +m
sleep 0.5
if kill -TERM $job 2>/dev/null; then
    status=0
    wait $job || status=$?
    [ $status -eq 143 ] || [ -e best.3dm ] || fail "status $status after TERM"
    [ -e best.3dm ] || [ -s best.3dm.resume ] || fail "nothing to go on from"
fi
"${proof[@]}" -o single
"${proof[@]}" --resume --checkpoint-interval 1000 -o best.3dm
expect_same best.3dm single "after TERM"
trap cleanup EXIT

# A search goes on without checkpoints where the disk is full, and says so.
small_disk
mkdir large
"${proof[@]}" -o large/best.3dm
status=0
loud=("${proof[@]/#-q/--no-progress}")
"${loud[@]}" --resume --checkpoint-interval 0 -o disk/best.3dm 2>err || status=$?
grep -q 'results could not be stored: .*No space left on device' err || fail "nobody says so: $(cat err)"
if [ $status -eq 0 ]; then expect_same disk/best.3dm large/best.3dm "with a full disk"; fi
