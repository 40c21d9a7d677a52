#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# With --clock step and with --script the same requests give the same bytes, for any number of
# threads; a signal or kill -9 leaves whole records.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"
scene=("$data/square.env" "$data/session.3dm")

# A whole dialogue by two clients, one drives, one steps.
dialogue() {
    start "${scene[@]}" --clock step --record "$1" -j "$2"
    dial "driver$1"
    dial "world$1"
    ask "driver$1" "ROBOT r1"
    ask "driver$1" "FORWARD 0.5"
    expect "world$1" WORLD 'OK WORLD t=0\.000 dt=0\.005 clock=step'
    expect "world$1" RESUME 'ERR 405 .*STEP.*'
    expect "world$1" "STEP 200" 'OK STEP n=200 t=1\.000'
    ask "driver$1" STATUS
    ask "driver$1" "SCAN l2"
    ask "driver$1" "SPEED 1"
    ask "driver$1" "ROTSPEED 20"
    expect "world$1" "STEP 1000" 'OK STEP n=1000 t=6\.000'
    ask "driver$1" STATUS
    expect "world$1" POSES 'OK POSES t=6\.000 n=2 poses=r1,[-0-9.,]*;r2,1\.000,1\.000,180\.000'
    expect "world$1" SHUTDOWN 'OK SHUTDOWN t=6\.000'
    ended 0
    hang_up "driver$1"
    hang_up "world$1"
    mv simrun.err "$1.err"
}
dialogue a 1
dialogue b 2
expect_same drivera.out driverb.out "another dialogue the second time"
expect_same worlda.out worldb.out "another dialogue the second time"
rm a/timing.csv b/timing.csv
diff -r a b || fail "other records the second time"
grep -q 'FAIL id=1 reason=replaced' drivera.out || fail "$(cat drivera.out)"
[ "$(wc -l <a/robots.csv)" -eq $((1 + 2 * 1201)) ] || fail "$(wc -l a/robots.csv)"

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
[ "$(cat script1/info.csv)" = "$(printf 'dt,control_interval,steps\n0.005,0.005,2000')" ] ||
    fail "$(cat script1/info.csv)"
head -n 1 script1/scans.jsonl |
    grep -q '"history":\["simrun square.env session.3dm --until 10 --script script.txt"\]' ||
    fail "$(head -n 1 script1/scans.jsonl)"
# Three lasers at 10 Hz, the first scans at time 0.
[ "$(wc -l <script1/scans.jsonl)" -eq $((1 + 3 * 101)) ] || fail "$(wc -l script1/scans.jsonl)"
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

# A full disk ends the run.
if [ -c /dev/full ]; then
    mkdir full
    ln -s /dev/full full/robots.csv
    expect_status 1 timeout 60 simrun "${scene[@]}" --clock fast --record full
    grep -q '^simrun: full/robots.csv: error: No space left on device' err || fail "$(cat err)"
fi
