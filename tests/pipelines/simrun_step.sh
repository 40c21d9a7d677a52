#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# With --clock step and with --script the same requests give the same bytes, for any number of
# threads; a signal or kill -9 leaves whole records.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"
scene=("$data/square.env" "$data/session.3dm")

# The session of simrun_nc.sh by steps: one client drives, one steps, three read a laser.
write_hall 'laser id=l2 on=r1'
# steps RUN N: all readers have the scans of these steps before the next request.
steps() {
    local reader
    expect "world$1" "STEP $2" "OK STEP n=$2 t=[0-9.]*"
    ask "world$1" TIME
    # l1 is read every 20 steps.
    last=$(($(value steps) / 20))
    for reader in one two three; do
        eventually "scan $last" grep -aq "^SCAN l1 .* seq=$last " "$reader$1.out"
    done
}
session() {
    start hall.env hall.3dm --clock step --record "$1" -j "$2"
    local reader request
    for reader in one two three; do
        dial "$reader$1"
        ask "$reader$1" "LASER l1"
        ask "$reader$1" STREAM
    done
    dial "driver$1"
    dial "other$1"
    dial "world$1"
    expect "world$1" WORLD 'OK WORLD t=0\.000 dt=0\.005 clock=step'
    expect "world$1" RESUME 'ERR 405 .*STEP.*'
    ask "driver$1" "ROBOT r1"
    expect "other$1" "ROBOT r1" 'ERR 409 .*'
    for request in "SPEED 0.3" STATUS; do ask "driver$1" "$request"; done
    steps "$1" 400
    for request in STATUS STOP; do ask "driver$1" "$request"; done
    steps "$1" 100
    expect "driver$1" STATUS '.* speed=0\.150 .* accel=-0\.3 .*'
    steps "$1" 300
    expect "driver$1" "FORWARD 1.5" 'OK FORWARD id=1 distance=1\.5'
    steps "$1" 400
    ask "driver$1" "SCAN l2"
    steps "$1" 600
    for request in STATUS "GO WEST" "FORWARD much" "LEFT 90"; do ask "driver$1" "$request"; done
    steps "$1" 400
    expect "driver$1" STATUS '.* heading=90\.000 speed=0\.000 .* stall=0'
    ask "driver$1" "FORWARD 5"
    steps "$1" 500
    steps "$1" 500
    expect "driver$1" STATUS '.* speed=0\.000 .* stall=1'
    for request in "BACKWARD 1" "SPEED -1" "ROTSPEED 20"; do ask "driver$1" "$request"; done
    steps "$1" 40
    ask "driver$1" STATUS
    ask "driver$1" QUIT
    expect "other$1" "ROBOT r1" 'OK ROBOT r1 .*'
    expect "world$1" POSES 'OK POSES t=16\.200 n=1 poses=r1,[-0-9.,]*'
    expect "world$1" SHUTDOWN 'OK SHUTDOWN t=16\.200'
    ended 0
    for reader in one two three driver other world; do hang_up "$reader$1"; done
    mv simrun.err "err$1"
}
session a 1
session b 2
for client in one two three driver other world; do
    expect_same "${client}a.out" "${client}b.out" "another dialogue of $client the second time"
done
expect_same onea.out twoa.out "other scans for another reader"
[ "$(grep -ac '^SCAN' onea.out)" -eq 162 ] || fail "$(grep -ac '^SCAN' onea.out) scans, expected 162"
for end in 'DONE id=1 t=8\.670' 'DONE id=2 .*' 'FAIL id=3 reason=stall .*' 'FAIL id=4 reason=replaced .*'; do
    grep -qx "$end" drivera.out || fail "no $end: $(cat drivera.out)"
done
expect_same erra errb "other warnings the second time"
rm a/timing.csv b/timing.csv
diff -r a b || fail "other records the second time"
[ "$(wc -l <a/robots.csv)" -eq $((1 + 3241)) ] || fail "$(wc -l a/robots.csv)"

# A script, as fast as it goes.
cat >script.txt <<'END'
# where to go
0.0  r1 SPEED 0.4
0.0  r2 FORWARD 1
1.2  r1 ROTSPEED 30
4    r2 LEFT 120
6    r1 STOP
END
for run in 1 2 again; do
    simrun "${scene[@]}" --clock fast --until 10 --script script.txt --record "script$run" \
        -j "${run/again/2}" >/dev/null 2>err || fail "$(cat err)"
    rm "script$run/timing.csv"
done
diff -r script1 script2 || fail "-j changes the records"
diff -r script2 scriptagain || fail "other records the second time"
[ "$(cat script1/info.csv)" = "$(printf 'dt,control_interval,steps,elapsed,seed,noise\n0.005,3.333333333,2000,10,0,0')" ] ||
    fail "$(cat script1/info.csv)"
head -n 1 script1/scans.jsonl |
    grep -q '"history":\["simrun square.env session.3dm --until 10 --script script.txt"\]' ||
    fail "$(head -n 1 script1/scans.jsonl)"
# Three lasers at 10 Hz, the first scans at time 0. One spins: the run ends in the midst of its last scan.
[ "$(wc -l <script1/scans.jsonl)" -eq $((1 + 3 * 101 - 1)) ] || fail "$(wc -l script1/scans.jsonl)"
# The first scans of lasers are those of scan(1) with the robots where they start.
scan "${scene[@]}" | tail -n +2 >first
sed -n 2,4p script1/scans.jsonl | cmp - first || fail "scan and simrun read differently"

# Whole lines after a signal, and after kill -9 (many, as few of them hit a write).
begun() { [ "$(wc -l <"$1/robots.csv")" -gt 10 ]; }
whole() {
    local file
    for file in "$1"/robots.csv "$1"/scans.jsonl; do
        [ "$(tail -c 1 "$file" | od -An -c | tr -d ' ')" = '\n' ] || return 1
    done
}
for signal in TERM INT KILL KILL KILL KILL KILL KILL KILL KILL KILL KILL; do
    rm -rf "$signal"
    simrun "${scene[@]}" --clock fast --record "$signal" >/dev/null 2>err &
    server=$!
    eventually "records" begun "$signal"
    kill -"$signal" "$server"
    ended "$([ "$signal" = KILL ] && echo 137 || echo 0)"
    if [ "$signal" = KILL ]; then
        eventually "whole lines after kill -9" whole KILL
    else
        whole "$signal" || fail "half a line after $signal"
    fi
    awk -F, 'NF != 10 { exit 1 }' "$signal/robots.csv" || fail "not ten columns after $signal"
    [ "$(wc -l <"$signal/info.csv")" -eq 2 ] || fail "no info after $signal"
done

# A folder takes one run at a time, and keeps its records from a run that cannot begin.
start "${scene[@]}" --clock step --record one
cp one/robots.csv before.csv
for second in "" "--listen 127.0.0.1:$port" "--port-file missing/port"; do
    # shellcheck disable=SC2086
    expect_status 1 simrun "${scene[@]}" --record one --until 1 $second
done
grep -q '^simrun: missing/port: error: ' err || fail "$(cat err)"
expect_status 1 simrun "${scene[@]}" --record one --until 1
grep -q '^simrun: one: error: another run is being recorded here$' err || fail "$(cat err)"
expect_same before.csv one/robots.csv "the second run wrote into the records of the first"
stop TERM
expect_status 1 simrun "${scene[@]}" --record one --until 1 --port-file missing/port
expect_same before.csv one/robots.csv "a run that could not begin replaced the records"
simrun "${scene[@]}" --record one --clock fast --until 1 >/dev/null || fail "the folder is still taken"

# A full pipe of warnings: the server still answers clients.
: >status
{
    printf '0 r1 SPEED 1\n' | simrun "${scene[@]}" --clock fast --until 8 --script - 2>&1 >first || true
    echo "${PIPESTATUS[1]}" >status
} | true
eventually "the end of the run" test -s status
[ "$(cat status)" = 0 ] || fail "status $(cat status) where nobody reads the warnings"

# A full disk ends the run.
if [ -c /dev/full ]; then
    mkdir full
    ln -s /dev/full full/robots.csv
    expect_status 1 timeout 60 simrun "${scene[@]}" --clock fast --record full
    grep -q '^simrun: full/robots.csv: error: No space left on device' err || fail "$(cat err)"
fi
