#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Foxglove's readers find in an MCAP file the data of the same scan as JSON lines: every kind of sensor, bit by bit if
# both are float32, CRCs, index and statistics.
. "$(dirname "$0")/common.sh"

command -v node >/dev/null || skip "no node here"
[ -d "$binary_dir/npm/node_modules/@mcap/core" ] || skip "npm could not fetch the readers of MCAP"
export NODE_PATH=$binary_dir/npm/node_modules
read_mcap() { node "$source_dir/tests/npm/read_mcap.js" "$@"; }

cp "$data/square.env" .
cat >all.3dm <<'END'
#3dm 1
laser id=front.laser/2 at=0.5,0.25 heading=30 fov=240 step=0.5 range=1.5
laser id=turns at=0,0,1 spin=10 fov=270 tilt=10
laser id=clockwise model=rplidar-a1 at=-1,1
laser id=nods at=0,0,1 step=15 sweep=tilt sweep_span=60 sweep_step=30
ranger id=pin at=-1,0,0.5 tilt=-20 roll=5 pixels=40,30 fov=40,30 range=1.8
ranger id=ball at=0,0,1 projection=spherical fov=360,60 pixels=16,6
camera id=c1 at=0,1,1 heading=-90 pixels=32,24 coefficients=0.1
camera id=fish at=0,0,2.4 tilt=-90 projection=fisheye fov=180 pixels=32,32
ultrasound id=u1 at=-1.5,-1.5,2.4 tilt=-90
ultrasound id=u2 at=1.5,-1.5,2.4 tilt=-90
ultrasound id=u3 at=1.5,1.5,2.4 tilt=-90
ultrasound id=u4 at=-1.5,1.5,2.4 tilt=-90
tag id=t1 at=0.25,-0.25,0.5
END
scan square.env all.3dm --frames 3 -o all.jsonl
scan square.env all.3dm --frames 3 -o all.mcap
read_mcap all.mcap all.jsonl 3 >read
# A scan each of three lasers, three of one that nods, pictures with their camera_info.
grep -qx 'compared 45' read || fail "not everything was compared"
for topic in /front_laser_2/scan /clockwise/scan /nods/points /pin/points /pin/depth/image_rect \
    /ball/points /c1/image_raw/compressed /fish/camera_info /t1/position; do
    grep -qx "$topic 3" read || fail "$topic"
done
grep -qx '/nods/scan 9' read || fail "the scans of a sweep"

# The check can fail: one range differs.
sed '3s/\[\([0-9.]*\),/[9.5,/' all.jsonl >other.jsonl
if read_mcap all.mcap other.jsonl 3 2>/dev/null; then fail "self-test: another range passes"; fi

# Many chunks, in the same bytes for any number of threads; a pipe gets them, too.
scan square.env all.3dm --select front* --noise --frames 3000 -o one.mcap -j 1
scan square.env all.3dm --select front* --noise --frames 3000 --to mcap -j 2 | cmp - one.mcap
scan square.env all.3dm --select front* --noise --frames 3000 -o one.jsonl
read_mcap one.mcap one.jsonl >read
grep -qx '/front_laser_2/scan 3000' read || fail "$(cat read)"

# A sensor that moves has a pose at the end of each scan, too.
printf '0 -1 0 0.5 0 0 0 1\n1 1 0 0.5 0 0 0 1\n' >way.txt
scan square.env --poses way.txt --model laser,spin=10 --motion -o way.mcap
scan square.env --poses way.txt --model laser,spin=10 --motion -o way.jsonl
read_mcap way.mcap way.jsonl >read
grep -qx '/laser1/scan 10' read && grep -qx '/tf 20' read || fail "$(cat read)"

# Chunks packed by zstd hold the same in fewer bytes; `none` has no packed chunk, and other formats reject the option.
scan square.env all.3dm --frames 3 -o packed.mcap --compression zstd
read_mcap packed.mcap all.jsonl 3 | cmp - <(read_mcap all.mcap all.jsonl 3) || fail "packed chunks hold something else"
[ "$(stat -c %s packed.mcap)" -lt $(($(stat -c %s all.mcap) / 2)) ] || fail "nothing is packed: $(stat -c '%n %s' ./*.mcap)"
scan square.env all.3dm --select front* --noise --frames 3000 --to mcap --compression zstd -j 1 >packed1.mcap
scan square.env all.3dm --select front* --noise --frames 3000 --to mcap --compression zstd -j 2 | cmp - packed1.mcap
scan square.env all.3dm --frames 3 -o plain.mcap --compression none
cmp plain.mcap all.mcap
expect_error 2 scan square.env all.3dm --to jsonl --compression zstd
printf 'damaged' | dd of=packed.mcap bs=1 seek=20000 conv=notrunc 2>dd.err
if read_mcap packed.mcap all.jsonl 3 >/dev/null 2>&1; then fail "self-test: a damaged chunk passes"; fi

# A recorded run: its scans, and the poses of people and of robots, with their odometry.
cp "$scenes"/ispace.env .
printf '#3dm 1\nrobot id=r1 model=pioneer-2dx at=0,-1 heading=90 path=0,1 odometry_noise=0.05,0.1,0.1,0.05
robot id=r2 model=pioneer-2dx at=1.5,-1\nlaser id=l1 on=r1 range=8\nhuman id=h1 at=1,1 walk=wander\n' >run.3dm
simrun ispace.env run.3dm --clock fast --noise --until 2 --record run >/dev/null
scan --run run -o run.mcap
scan --run run -o run.jsonl
read_mcap run.mcap run.jsonl 1 run >read
scans=$(grep -c '"ranges"' run.jsonl)
[ "$scans" -gt 10 ] || fail "too few scans: $scans"
grep -qx "/l1/scan $scans" read || fail "$(cat read)"
# Every 0.02 s from 0 on.
grep -qx "robots, odometry, people 202 202 101" read || fail "$(cat read)"
grep -qx "/r1/odom 101" read || fail "$(cat read)"
sed 's/^\(1.5,r1,\)[^,]*/\13/' run/robots.csv >other.csv
mkdir other
mv other.csv other/robots.csv
cp run/odometry.csv run/people.csv other
if read_mcap run.mcap run.jsonl 1 other >/dev/null 2>&1; then fail "self-test: a robot elsewhere passes"; fi
# Without odometry the robots' poses are all there is.
rm run/odometry.csv
scan --run run -o bare.mcap
read_mcap bare.mcap run.jsonl 1 run | has -x "robots, odometry, people 202 0 101" || fail "poses without odometry"

# No reading, one beam, and a folder of files.
scan square.env --poses /dev/null --model laser -o none.mcap
echo '{}' >none.jsonl
read_mcap none.mcap none.jsonl | cmp - <(echo 'compared 0')
printf '#3dm 1\nlaser id=9 at=0,0 fov=0 beams=1\n' >beam.3dm
scan square.env beam.3dm -o beam/ --to mcap
scan square.env beam.3dm | sed 's/"sensor":"9"/"sensor":"s9"/' >beam.jsonl
read_mcap beam/9-0000.mcap beam.jsonl | has -x 'compared 1' || fail "one beam"

# Ids that ROS cannot tell apart, times it does not have.
printf '#3dm 1\nlaser id=a-b at=0,0\nlaser id=a_b at=1,1\n' >twins.3dm
expect_error 2 scan square.env twins.3dm --to mcap
grep -q 'ROS would call a_b a_b, as it does a-b' err || fail "$(cat err)"
printf -- '-1 0 0 0.5 0 0 0 1\n' >early.txt
expect_status 1 scan square.env --poses early.txt --model laser -o early.mcap
grep -q 'times of ROS go from 0' err || fail "$(cat err)"
[ ! -e early.mcap ] || fail "a file in spite of the error"
