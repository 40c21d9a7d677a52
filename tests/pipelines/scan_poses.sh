#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# scan as a filter of poses: an answer to each at once, memory that does not grow, bad lines named,
# and a reader that goes away.
. "$(dirname "$0")/common.sh"

room=$data/square.env
# poses N: a trajectory of N lines about the middle of the room.
poses() {
    awk -v n="$1" 'BEGIN { for (i = 0; i < n; ++i)
        printf "%.2f %.4f %.4f 0.15 0 0 %.6f %.6f\n", i / 10, cos(i) / 2, sin(i) / 2, sin(i / 7), cos(i / 7) }'
}

# A program that writes one pose and waits gets its scan, with any number of threads.
for threads in 1 2; do
    mkfifo to from
    scan "$room" --poses - --model laser,fov=2 -j "$threads" <to >from &
    job=$!
    exec 3>to 4<from
    read -r -t 20 header <&4 || fail "no header before the first pose"
    [[ $header == *ispace-scan/1* ]] || fail "header: $header"
    for heading in "0 0 0 1" "0 0 1 0" "0 0 1 1"; do
        echo "1.5 0 0 0.15 $heading" >&3
        read -r -t 20 line <&4 || fail "no scan of $heading with -j $threads"
        [[ $line == *'"t":1.5,'*'"ranges":[2.000304'?',2,2.000304'?']}' ]] || fail "scan: $line"
    done
    exec 3>&- 4<&-
    wait "$job" || fail "status $? at the end of poses"
    rm to from
done

# The same bytes for any number of threads and whichever way poses come, with noise.
poses 3000 >way.txt
for format in jsonl raw csv carmen; do
    scan "$room" --poses way.txt --model urg-04lx --noise --to "$format" -j 1 >one
    scan "$room" --poses way.txt --model urg-04lx --noise --to "$format" -j 5 >five
    expect_same one five "$format: -j changes the result"
    # History names the file, or the stream.
    scan "$room" --poses - --model urg-04lx --noise --to "$format" <way.txt >stream
    [ "$format" = jsonl ] || expect_same one stream "$format: a stream changes the result"
done
[ "$(head -n 1 five)" != "" ] || fail "nothing written"
scan "$room" --poses way.txt --model urg-04lx --noise --seed 1 --to raw >other
scan "$room" --poses way.txt --model urg-04lx --noise --to raw >one
if cmp -s one other; then fail "the seed does not matter"; fi
[ "$(wc -c <one)" -eq $((3000 * 682 * 4)) ] || fail "raw: $(wc -c <one) bytes"

# Motion: at the device's rate, 10 Hz, over 299.9 s of poses.
scan "$room" --poses way.txt --model urg-04lx --motion --to carmen | grep -c ^ROBOTLASER1 >count
[ "$(cat count)" -eq 2999 ] || fail "$(cat count) scans of 299.9 s at 10 Hz"

# A hundred times the poses take no more memory (in pages, with some slack for threads).
peak() {
    /usr/bin/env bash -c 'scan "$@" >/dev/null & pid=$!; most=0
        while kill -0 $pid 2>/dev/null; do
            now=$(awk "{print \$2}" /proc/$pid/statm 2>/dev/null || echo 0)
            [ "${now:-0}" -le "$most" ] || most=$now
            sleep 0.01
        done
        wait $pid; echo "$most"' peak "$@"
}
poses 1000 >few.txt
poses 100000 >many.txt
few=$(peak "$room" --poses few.txt --model laser,step=0.1 --to raw -j 2)
many=$(peak "$room" --poses many.txt --model laser,step=0.1 --to raw -j 2)
[ "$many" -le $((few + 10000)) ] || fail "memory grows from $few to $many pages"
# As many heights as poses, too.
awk '{ $4 = 0.1 + NR / 1e6; print }' way.txt >heights.txt
scan "$room" --poses heights.txt --model laser,fov=2 --to raw -j 1 >one
scan "$room" --poses heights.txt --model laser,fov=2 --to raw -j 3 >three
expect_same one three "-j changes the result for many heights"

# Bad lines: status 1, the position, and the format of a pose; earlier readings stay valid.
bad() {
    printf '%b' "$1" >bad.txt
    expect_status 1 scan "$room" --poses bad.txt --model laser,fov=2
    grep -qxF "scan: $2" err || fail "$1: $(cat err)"
    [ "$(wc -l <err)" -eq 1 ] || fail "not one line: $(cat err)"
}
bad '0 0 0 0.15 0 0 0 1\n1 2 3\n' 'bad.txt:2: error: 3 columns; a pose is `t x y z qx qy qz qw`'
bad '# t\n0 0 nan 0.15 0 0 0 1' 'bad.txt:2:5: error: y `nan` is not a number'
bad '0 0 1e999 0.15 0 0 0 1\n' 'bad.txt:1:5: error: y `1e999` is not a number'
bad '0 0 0 0.15 0 0 0 0\n' 'bad.txt:1:12: error: the quaternion is 0, which is no rotation'
bad '0 0 0 1e9 0 0 0 1\n' 'bad.txt:1:3: error: the place is more than 1000 km away'
head -c 100000 /dev/urandom | tr -d '\n#' >random.txt
expect_status 1 scan "$room" --poses random.txt --model laser
expect_status 0 scan "$room" --poses /dev/null --model laser
[ "$(wc -l <out)" -eq 1 ] || fail "no poses are no header alone: $(cat out)"
expect_error 1 scan "$room" --poses missing.txt --model laser
expect_error 1 scan "$room" --poses . --model laser
expect_error 2 scan - --poses - --model laser
expect_error 2 scan "$room" --model laser
expect_error 2 scan "$room" --poses way.txt --model laser:2
for wrong in step=0 range=5,3 range=0 beams=1000001 step=1e-9 sweep=heading,sweep_step=1e-9 incidence=60,30; do
    expect_error 2 scan "$room" --poses way.txt --model "laser,$wrong"
    grep -q "^scan: error: --model: " err || fail "$wrong: $(cat err)"
done
bad '1e17 0 0 0.15 0 0 0 1\n' 'bad.txt:1:1: error: t is more than 285 years away'
expect_error 2 scan "$room" --poses way.txt --model zps-3d
expect_error 2 scan "$room" --poses way.txt --frames 2 --model laser
printf '#3dm 1\nlaser\nlaser\n' >two.3dm
expect_error 2 scan "$room" two.3dm --poses way.txt
expect_error 2 scan "$room" --motion

# Without --model the one sensor there is, placed or not.
printf '#3dm 1\nlaser id=mine fov=2 range=9\n' >one.3dm
scan "$room" one.3dm --poses few.txt | sed -n 2p | has '"sensor":"mine".*"range_max":9,' ||
    fail "the sensor of the layout does not take the poses"

# It does not see the robot that carries it, rejects a second pose, and -MD names the poses.
printf '#3dm 1\nrobot id=r at=0,0 size=0.5,0.5,0.5\nlaser on=r fov=2 range=9\n' >on.3dm
echo '0 0 0 0.15 0 0 0 1' >one.txt
scan "$room" on.3dm --poses one.txt -o on.jsonl -MD
grep -q '"ranges":\[2.0003047,2,2.0003047\]' on.jsonl || fail "its own robot: $(cat on.jsonl)"
grep -q 'one.txt' on.jsonl.d || fail "rule: $(cat on.jsonl.d)"
expect_error 2 scan "$room" --poses one.txt --model laser,tilt=40
expect_error 2 scan "$room" --poses one.txt --model laser,at=1,1
# scan always writes the readings before a bad pose; a pose inside a desk gets a warning.
{ cat few.txt; echo bad; } >broken.txt
for threads in 1 2 3; do
    expect_status 1 scan "$room" --poses broken.txt --model laser --to raw -j "$threads"
    [ "$(wc -c <out)" -eq $((1000 * 181 * 4)) ] || fail "$(wc -c <out) bytes before a bad pose"
done
{ cat "$room"; echo 'cube at=0,0 size=0.5,0.5,0.5'; } >solid.env
expect_status 0 scan solid.env --poses one.txt --model laser
grep -q 'warning: 1 reading was taken inside something solid, the first at t=0, 0,0,0.15' err ||
    fail "no warning: $(cat err)"

# A reader that goes away, and a signal.
yes '0 0 0 0.15 0 0 0 1' | scan "$room" --poses - --model laser 2>err | head -n 3 >out ||
    [ "${PIPESTATUS[1]}" -eq 141 ] || fail "status ${PIPESTATUS[1]}, expected 141"
[ ! -s err ] || fail "not silent: $(cat err)"
mkdir work
echo old >work/scans.raw
scan "$room" --poses - --model laser --to raw -o work/scans.raw < <(yes '0 0 0 0.15 0 0 0 1') &
job=$!
sleep 0.5
kill -TERM "$job" || fail "nothing to interrupt"
status=0
wait "$job" || status=$?
[ "$status" -eq 143 ] || fail "status $status after TERM, expected 143"
[ "$(ls -A work)" = scans.raw ] || fail "left behind: $(ls -A work)"
[ "$(cat work/scans.raw)" = old ] || fail "the old file is gone"
