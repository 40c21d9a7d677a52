#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The topics of a run in an MCAP file: those of the table at their rates, equal to the record of the run, the same bytes
# twice and from a replay.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

cp "$scenes"/ispace.env .
cat >run.3dm <<'END'
#3dm 1
robot id=r1 model=pioneer-2dx at=0,-1 heading=90 path=0,1
laser id=l1 on=r1 range=8
laser id=l2 at=2,2 heading=-135
camera id=c1 at=-2,-2,2.4 heading=45 tilt=-30 pixels=32,24 rate=2
human id=h1 at=1,1 walk=wander
END
simrun ispace.env run.3dm --clock fast --until 4 --record run --mcap run.mcap >/dev/null
simrun ispace.env run.3dm --clock fast --until 4 --mcap again.mcap >/dev/null
cmp run.mcap again.mcap || fail "other bytes the second time"
[ "$(head -c 5 run.mcap | tail -c 4)" = MCAP ] || fail "no MCAP file"

# The file stays whole if a signal ends the run, and one over the limit ends it.
simrun ispace.env run.3dm --port-file port --mcap cut.mcap >/dev/null &
pid=$!
until [ -s port ]; do sleep 0.05; done
sleep 0.3
kill -TERM $pid
wait $pid
[ "$(tail -c 7 cut.mcap | head -c 4)" = MCAP ] || fail "the file has no end after TERM"
expect_status 1 simrun ispace.env run.3dm --clock fast --until 100 --record-limit 100K --mcap full.mcap
grep -q 'full.mcap: error: ended at t=.*wanted at most 102400 (--record-limit)' err || fail "$(cat err)"
[ "$(tail -c 7 full.mcap | head -c 4)" = MCAP ] || fail "a full file has no end"
expect_error 2 simrun ispace.env run.3dm --until 1 --mcap -

command -v node >/dev/null || skip "no node here"
[ -d "$binary_dir/npm/node_modules/@mcap/core" ] || skip "npm could not fetch the readers of MCAP"
export NODE_PATH=$binary_dir/npm/node_modules
node "$source_dir/tests/npm/read_topics.js" run.mcap run >read
for line in '/clock rosgraph_msgs/msg/Clock 201' '/map nav_msgs/msg/OccupancyGrid 1' \
    '/tf_static tf2_msgs/msg/TFMessage 1' '/people visualization_msgs/msg/MarkerArray 41' \
    '/r1/odom nav_msgs/msg/Odometry 201' '/c1/image_raw/compressed sensor_msgs/msg/CompressedImage 9'; do
    grep -qx "$line" read || fail "not '$line': $(cat read)"
done
for sensor in l1 l2; do
    [ "$(awk -v topic=/$sensor/scan '$1 == topic { print $3 }' read)" -eq \
        "$(grep -c "\"sensor\":\"$sensor\".*\"ranges\"" run/scans.jsonl)" ] || fail "scans of $sensor: $(cat read)"
done

simrun --replay run --clock fast --mcap replay.mcap >/dev/null
cmp run.mcap replay.mcap || fail "a replay has other topics"

# All rooms of a building.
tower=$data/tower
simrun $tower.yaml $tower.3dm --clock fast --until 2 --mcap tower.mcap >/dev/null
node "$source_dir/tests/npm/read_topics.js" tower.mcap >read
grep -q '^/ground/map nav_msgs/msg/OccupancyGrid 1$' read && grep -q '^/upper/map ' read || fail "maps: $(cat read)"
[ "$(grep -c '/odom nav_msgs/msg/Odometry 101$' read)" -eq "$(grep -c '^robot' $tower.3dm)" ] || fail "odometry: $(cat read)"
