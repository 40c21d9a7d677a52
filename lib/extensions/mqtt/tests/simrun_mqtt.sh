#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A broker of MQTT gets the states of a running world, and commands from there switch its lamps: also after the broker
# was away, and by the automation of share/examples. Last will, login and refusals.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

PATH=$PATH:/usr/sbin
for program in mosquitto mosquitto_sub mosquitto_pub; do
    command -v "$program" >/dev/null || skip "no $program here (Debian: mosquitto, mosquitto-clients)"
done

jobs_left=()
cleanup() {
    for job in "${jobs_left[@]}"; do kill -- "$job" 2>/dev/null || true; done
    wait
    rm -rf "$scratch"
}
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')

# broker [LINE]…: starts it with these further lines of configuration, and waits until it listens.
broker() {
    { printf 'listener %s 127.0.0.1\nuser %s\n' "$port" "$(id -un)"; printf '%s\n' "$@"; } >broker.conf
    mosquitto -c broker.conf 2>>broker.log &
    broker_job=$!
    jobs_left+=("$broker_job")
    for _ in $(seq 500); do
        if (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then return; fi
        sleep 0.02
    done
    fail "the broker does not listen: $(cat broker.log)"
}
end() {
    kill "$@"
    wait "$@" 2>/dev/null || true
}
# eventually WHAT COMMAND…: it succeeds within 20 s.
eventually() {
    for _ in $(seq 1000); do
        if "${@:2}"; then return; fi
        sleep 0.02
    done
    fail "$1: $(tail -n 20 heard err)"
}
listen() {
    mosquitto_sub -h 127.0.0.1 -p "$port" "$@" -v -t 'ispace/#' -t 'homeassistant/#' >>heard &
    listener=$!
    jobs_left+=("$listener")
}
heard() { grep -qxF -- "$1" heard; }
tell() { mosquitto_pub -h 127.0.0.1 -p "$port" -q 1 -t "$1" -m "$2"; }
last() { grep -F -- "ispace/$1 " heard | tail -n 1 | cut -d ' ' -f 2; }
is_last() { [ "$(last "$1")" = "$2" ]; }

cat >flat.env <<'END_OF_ROOM'
#env 1
fence id=f path=0,0;6,0;6,4;0,4 closed=yes height=2.5
fence id=inner path=3,0;3,4 height=2.5
door id=d1 wall=inner offset=2
lamp id=l1 at=1.5,2
switch id=b1 at=0.1,1
projector id=p1 at=1.5,3 height=2.2
zone id=west at=1.5,2 size=3,4
END_OF_ROOM
cat >flat.3dm <<'END_OF_LAYOUT'
#3dm 1
pir id=s1 at=0.1,0.1,2 heading=45 tilt=-30 hold=0.5
contact id=k1 at=3,2,2 door=d1
thermometer id=t1 at=1.5,2,1.5
human id=h1 at=1,3
END_OF_LAYOUT

expect_error 1 simrun flat.env flat.3dm --mqtt "127.0.0.1:$port"
grep -q "cannot connect to the broker 127.0.0.1:$port" err || fail "$(cat err)"

broker 'allow_anonymous true'
listen
simrun flat.env flat.3dm -q --mqtt "127.0.0.1:$port" --record run --dt 0.02 >begin.json 2>err &
server=$!
jobs_left+=("$server")
for state in 'l1/on OFF' 'l1/level 100' 'b1/on OFF' 'd1/open OFF' 's1/motion OFF' 'k1/open OFF' 't1/celsius 20' 'p1/pan 0' 'status online'; do
    eventually "no state $state" heard "ispace/$state"
done
for component in light/ispace_l1 switch/ispace_b1 cover/ispace_d1 binary_sensor/ispace_s1 binary_sensor/ispace_k1; do
    grep -q "^homeassistant/$component/config {" heard || fail "no discovery of $component"
done
grep '^homeassistant/' heard | cut -d ' ' -f 2- | python3 -c '
import json, sys
things = {thing["name"]: thing for thing in map(json.loads, sys.stdin)}
assert things["s1"]["device_class"] == "motion" and things["s1"]["state_topic"] == "ispace/s1/motion"
assert things["l1"]["brightness_command_topic"] == "ispace/l1/level/set" and things["l1"]["brightness_scale"] == 100
assert all(thing["availability_topic"] == "ispace/status" for thing in things.values())
assert "command_topic" not in things["k1"]
assert things["t1"]["device_class"] == "temperature" and things["t1"]["unit_of_measurement"] == "°C"
assert things["p1 pan"]["command_topic"] == "ispace/p1/pan/set" and things["p1 pan"]["max"] == 180' || fail "discovery"

# Commands, in order; a door moves the room.
tell ispace/l1/on/set ON
tell ispace/l1/level/set 40
eventually "no lamp" is_last l1/level 40
is_last l1/on ON || fail "the lamp is $(last l1/on)"
tell ispace/d1/open/set ON
eventually "no door" is_last k1/open ON
tell ispace/p1/pan/set 45
eventually "the projector does not turn" is_last p1/pan 45
tell ispace/l1/level/set bright
eventually "no refusal" grep -q '^ispace/error ERR 400' heard
tell ispace/s1/motion/set ON    # sensors take no commands
tell ispace/l1/on/set OFF
eventually "no lamp off" is_last l1/on OFF

# The broker dies and comes back with no memory: all is told again, and what happened meanwhile in its order.
end "$broker_job" "$listener"
broker 'allow_anonymous true'
: >heard
listen
eventually "no reconnection" heard 'ispace/status online'
eventually "no state after it" is_last l1/level 40
for level in 10 20 30 50 60; do tell ispace/l1/level/set "$level"; done
eventually "no levels" is_last l1/level 60
# Those of one step are one event.
grep -F 'ispace/l1/level ' heard | cut -d ' ' -f 2 | sed 1,/40/d | sort -c -n || fail "another order: $(grep level heard)"

# The automation: h1 walks, the sensor sees it, the script of share/examples switches the lamp.
set -m  # a group of its own: it has a pipe
"$source_dir/share/examples/motion_light.sh" s1 l1 -h 127.0.0.1 -p "$port" >/dev/null 2>&1 &
automation=$!
set +m
jobs_left+=("-$automation")
sleep 1  # the subscription
: >heard
address=$(sed 's/.*"listen":"127.0.0.1:\([0-9]*\)".*/\1/' begin.json)
printf 'PERSON h1\nPATH 2,3\n' >ask
{ cat ask; sleep 3; } | nc -q 1 127.0.0.1 "$address" >said || true
eventually "no motion" heard 'ispace/s1/motion ON'
eventually "no lamp by motion" heard 'ispace/l1/on ON'
eventually "no rest" is_last s1/motion OFF
eventually "no lamp off at rest" is_last l1/on OFF

# The will of a run that is killed, and the last word of one that ends.
kill "$server"
wait "$server" || fail "simrun ends with $?"
eventually "not offline" is_last status offline
[ ! -s err ] || fail "simrun: $(cat err)"
grep -q ',state,s1,motion,,,,1$' run/events.csv || fail "no motion in the record"
grep -q ',state,l1,on,,,,1$' run/events.csv || fail "no lamp in the record"
: >heard
simrun flat.env flat.3dm -q --mqtt "127.0.0.1:$port" >begin.json 2>err &
server=$!
eventually "online again" is_last status online
kill -KILL "$server"
wait "$server" 2>/dev/null || true
eventually "no last will" is_last status offline

# A building: the states of all rooms, and of lifts.
: >heard
simrun "$source_dir/tests/data/hotel.building.yaml" -q --mqtt "127.0.0.1:$port" >begin.json 2>err &
server=$!
jobs_left+=("$server")
for state in 'l1/door1/open ON' 'l2/door1/open ON' 'l3/door1/open ON' 'a/storey l1' 'a/open OFF'; do
    eventually "no state $state" heard "ispace/$state"
done
address=$(sed 's/.*"listen":"127.0.0.1:\([0-9]*\)".*/\1/' begin.json)
printf 'WORLD\nCALL a l1\n' | nc -q 1 127.0.0.1 "$address" >said || true
eventually "the door of the lift does not open" heard 'ispace/a/open ON'
tell ispace/l2/door1/open/set OFF
eventually "a door of a storey does not close" heard 'ispace/l2/door1/open OFF'
end "$server"
end "$broker_job" "$listener"

# A broker that wants a password.
printf 'ispace:secret\n' >login
printf 'ispace:wrong\n' >wrong
mosquitto_passwd -c -b users ispace secret 2>/dev/null || fail "mosquitto_passwd"
broker 'allow_anonymous false' "password_file $scratch/users"
expect_error 1 simrun flat.env flat.3dm --mqtt "127.0.0.1:$port" --mqtt-login wrong
grep -q 'accepts no connection: Connection Refused: not authorised' err || fail "$(cat err)"
: >heard
listen -u ispace -P secret
simrun flat.env flat.3dm -q --mqtt "127.0.0.1:$port" --mqtt-login login --clock fast --until 1 >begin.json ||
    fail "no run with a password"
eventually "no state with a password" heard 'ispace/l1/level 100'
end "$broker_job" "$listener"
