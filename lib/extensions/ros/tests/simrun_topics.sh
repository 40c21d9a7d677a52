#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Foxglove's client library and roslib read each topic of a running world, drive its robot and call its services; their
# scans are those of the record, float by float.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

command -v node >/dev/null || skip "no node here"
for package in @foxglove/ws-protocol roslib; do
    [ -d "$binary_dir/npm/node_modules/$package" ] || skip "npm could not fetch the clients"
done
export NODE_PATH=$binary_dir/npm/node_modules

cat >topics.3dm <<'END_OF_LAYOUT'
#3dm 1
robot id=r1 model=pioneer-2dx at=-1.2,-0.5
laser id=l1 on=r1 at=0.1,0,0.3 fov=180 step=1 range=8 rate=20
laser id=nods at=0,1,1 step=15 sweep=tilt sweep_span=60 sweep_step=30
camera id=c1 at=0,1,1 heading=-90 pixels=32,24 rate=5
ranger id=d1 at=1,1,0.5 heading=-90 pixels=16,12 rate=5
human id=h1 at=1.2,1
END_OF_LAYOUT
simrun "$data/square.env" topics.3dm -q --foxglove 0 --rosbridge 0 --record run >begin.json 2>err &
server=$!
cleanup() {
    kill "$server" 2>/dev/null || true
    rm -rf "$scratch"
}
for _ in $(seq 1000); do [ -s begin.json ] || sleep 0.02; done
address() { sed "s/.*\"$1\":\"\\([^\"]*\\)\".*/\\1/" begin.json; }

node "$source_dir/tests/npm/foxglove_client.js" "$(address foxglove)" scans.jsonl >said || fail "Foxglove's client"
[ "$(grep -c ' topics, scans' said)" -eq 2 ] || fail "Foxglove's client: $(cat said)"
node "$source_dir/tests/npm/rosbridge_client.mjs" "$(address rosbridge)" scans.jsonl >said || fail "roslib"
grep -q ' topics, scans' said || fail "roslib: $(cat said)"
kill "$server"
wait "$server" || fail "simrun ends with $?"
[ ! -s err ] || fail "simrun: $(cat err)"

node "$source_dir/tests/npm/compare_scans.js" scans.jsonl run/scans.jsonl l1 >said || fail "other scans"
[ "$(sed 's/compared //' said)" -gt 50 ] || fail "few scans: $(cat said)"
# The check can fail: one range differs.
sed '1s/"ranges":\[[^,]*,/"ranges":[9.5,/' scans.jsonl >other.jsonl
if node "$source_dir/tests/npm/compare_scans.js" other.jsonl run/scans.jsonl l1 2>/dev/null; then
    fail "self-test: another range passes"
fi
cat said
