#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Node-RED, as npm has it, sees a running world through a broker: the discovery for Home Assistant, the state of each
# entity at the topic of its description, and a flow by which the lamp follows a motion sensor.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

PATH=$PATH:/usr/sbin
for program in mosquitto node; do
    command -v "$program" >/dev/null || skip "no $program here"
done
red=$binary_dir/npm/node_modules/node-red/red.js
[ -e "$red" ] || skip "npm could not fetch Node-RED"

jobs_left=()
cleanup() {
    for job in "${jobs_left[@]}"; do kill "$job" 2>/dev/null || true; done
    wait
    rm -rf "$scratch"
}
# eventually WHAT COMMAND…: it succeeds within a minute.
eventually() {
    for _ in $(seq 600); do
        if "${@:2}"; then return; fi
        sleep 0.1
    done
    fail "$1: $(tail -n 20 red.log heard err 2>/dev/null)"
}
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
printf 'listener %s 127.0.0.1\nuser %s\nallow_anonymous true\n' "$port" "$(id -un)" >broker.conf
mosquitto -c broker.conf 2>broker.log &
jobs_left+=("$!")
listens() { (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; }
eventually "the broker does not listen" listens

cat >flat.env <<'END_OF_ROOM'
#env 1
fence id=f path=0,0;6,0;6,4;0,4 closed=yes height=2.5
fence id=inner path=3,0;3,4 height=2.5
door id=d1 wall=inner offset=2
window id=w1 wall=f offset=2
lamp id=l1 at=1.5,2
switch id=b1 at=0.1,1
heater id=h1 at=0.1,3
zone id=west at=1.5,2 size=3,4
END_OF_ROOM
cat >flat.3dm <<'END_OF_LAYOUT'
#3dm 1
pir id=s1 at=0.1,0.1,2 heading=45 tilt=-30 hold=0.5
contact id=k1 at=3,2,2 door=d1
thermometer id=t1 at=1.5,2,1.5
camera id=c1 at=0.2,0.2,2 heading=45 tilt=-30 pixels=32,24
robot id=bot at=5,1
human id=ann at=1,3
END_OF_LAYOUT

touch heard found red.log
# Node-RED is there first, as in a home; simrun comes later.
node "$source_dir/tests/npm/node_red_flows.js" "$port" .
NODE_PATH=$binary_dir/npm/node_modules node "$red" -u . --settings settings.js >red.log 2>&1 &
jobs_left+=("$!")
eventually "Node-RED does not start" grep -q 'Connected to broker' red.log
simrun flat.env flat.3dm -q --mqtt "127.0.0.1:$port" --port-file address >begin.json 2>err &
server=$!
jobs_left+=("$server")

heard() { grep -qF -- "$1" heard; }
for state in '["ispace/l1/on","OFF"]' '["ispace/d1/open","OFF"]' '["ispace/t1/celsius","20"]' '["ispace/status","online"]'; do
    eventually "no $state" heard "$state"
done
for component in light/ispace_l1 switch/ispace_b1 switch/ispace_h1 cover/ispace_d1 cover/ispace_w1 binary_sensor/ispace_s1 \
    binary_sensor/ispace_k1 sensor/ispace_t1 vacuum/ispace_bot device_tracker/ispace_ann camera/ispace_c1; do
    eventually "no discovery of $component" heard "homeassistant/$component"
done

# Each entity with a state is found where its description says, also the picture.
cat >entities.py <<'END_OF_CHECK'
import json
heard = [json.loads(line) for line in open("heard", encoding="utf-8")]
found = {topic: size for topic, size in map(json.loads, open("found", encoding="utf-8"))}
wanted = {entity[key] for topic, payload in heard if topic.startswith("homeassistant/") for entity in [json.loads(payload)]
          for key in ("state_topic", "topic") if key in entity}
raise SystemExit(0 if len(wanted) > 10 and all(found.get(topic) for topic in wanted) else 1)
END_OF_CHECK
eventually "not each entity has a state: $(sort -u found)" python3 entities.py

# The flow: motion switches the lamp, and its end switches it off.
: >heard
printf 'PERSON ann\nPATH 2,3\n' >ask
{ cat ask; sleep 3; } | nc -q 1 127.0.0.1 "$(sed 's/.*"listen":"127.0.0.1:\([0-9]*\)".*/\1/' begin.json)" >said || true
for state in '["ispace/s1/motion","ON"]' '["ispace/l1/on","ON"]' '["ispace/s1/motion","OFF"]' '["ispace/l1/on","OFF"]'; do
    eventually "no $state" heard "$state"
done

kill "$server"
wait "$server" || fail "simrun ends with $?"
eventually "not offline" heard '["ispace/status","offline"]'
[ ! -s err ] || fail "simrun: $(cat err)"
if grep -F '[error]' red.log; then fail "Node-RED complains"; fi
