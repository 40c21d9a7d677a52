#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Clients change the running world: the server tells clients that hold a changed robot, the record stays whole, and
# token and watchdog work.
. "$(dirname "$0")/common.sh"
. "$source_dir/tests/simrun/server.sh"

write_hall
printf 's3cret\n' >token
chmod 600 token
start hall.env hall.3dm --clock step --record run --token-file token --watchdog 1
dial world
dial driver
dial reader
expect world WORLD 'OK WORLD .*'
expect driver 'ROBOT r1' 'OK ROBOT .*'
expect reader 'LASER l1' 'OK LASER .*'
expect world 'ADD human id=h1 at=3,0' 'ERR 401 .*'
expect world SHUTDOWN 'ERR 401 .*'
expect world 'TOKEN guess' 'ERR 401 .*'
expect world 'TOKEN s3cret' 'OK TOKEN'
expect world 'ADD human id=h1 at=3,0' 'OK ADD id=h1 .*'
expect world 'ADD robot id=r2 at=-3,1.5' 'OK ADD id=r2 .*'
expect world 'STEP 100' 'OK STEP n=100 t=0.500'
expect world 'EVENTS collision,change,mark' 'OK EVENTS .*'
expect driver 'FORWARD 3' 'OK FORWARD id=1 .*'
# The watchdog stops a robot with a silent client: it has hardly moved.
expect world 'STEP 20' 'OK STEP .*'
eventually "the watchdog" grep -qx 'FAIL id=1 reason=stopped t=0.600' driver.out
expect driver 'FORWARD 0.1' 'OK FORWARD id=2 .*'
expect world 'MARK half time' 'OK MARK t=0.600'
expect world 'DELETE r1' 'OK DELETE .*'
eventually "the driver is told" grep -qx 'EVENT gone t=0.600 id=r1' driver.out
grep -qx 'FAIL id=2 reason=deleted t=0.600' driver.out || fail "no FAIL: $(cat driver.out)"
expect driver STATUS 'ERR 404 .*'
expect world 'STEP 100' 'OK STEP n=100 t=1.100'
expect world RESET 'OK RESET t=1.100'
expect world 'STEP 1' 'OK STEP n=1 t=1.105'
expect reader SCAN 'SCAN l1 t=.*'
grep -qx 'EVENT mark t=0.600 text=half time' world.out || fail "no mark: $(cat world.out)"
expect world SHUTDOWN 'OK SHUTDOWN .*'
ended 0

# Every step has its robots, in the order of time.
[ "$(grep -c ',r1,' run/robots.csv)" -eq 122 ] || fail "r1: $(grep -c ',r1,' run/robots.csv)"
[ "$(grep -c ',r2,' run/robots.csv)" -eq 220 ] || fail "r2: $(grep -c ',r2,' run/robots.csv)"
tail -n +2 run/robots.csv | cut -d, -f1 >times
sort -n times | cmp - times || fail "times are out of order"
[ "$(tail -n 1 run/robots.csv | cut -d, -f1-4)" = 1.105,r1,-5,0 ] || fail "no reset: $(tail -n 1 run/robots.csv)"

# Other machines need a token, and then for everything.
rm -f port
start_args=(hall.env hall.3dm --clock step --listen 0.0.0.0:0 --token-file token --port-file port)
simrun "${start_args[@]}" >announced 2>simrun.err &
server=$!
eventually "the port file" test -s port
port=$(cat port)
dial client
expect client 'ROBOT r1' 'ERR 401 .*'
expect client 'TOKEN s3cret' 'OK TOKEN'
expect client 'ROBOT r1' 'OK ROBOT .*'
stop
chmod 644 token
simrun hall.env hall.3dm --clock fast --until 0.1 --token-file token >/dev/null 2>warned
grep -q 'token can be read by other users' warned || fail "no warning: $(cat warned)"
