#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Clients that never read, that send a byte a second or a megabyte without a newline, and 200 that
# connect and vanish: others miss no scan, and memory does not grow.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/../simrun/server.sh"

cat >many.3dm <<'END'
#3dm 1
robot id=r1 at=-1,0
robot id=r2 at=1,0
laser id=l1 at=0,-1.9 heading=90 rate=20
laser id=l2 model=utm-30lx at=1.9,0 heading=180 rate=1000
END
# With many clients a scan gives way to the next one if simrun itself is late by a period: at 40 a second
# no machine that does something else besides is. Instrumented, simrun is several times slower.
speed=2
grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" || speed=1
start "$data/square.env" many.3dm --clock real:$speed --max-clients 230
memory() { awk '$1 == "VmRSS:" { print $2 }' "/proc/$server/status"; }

dial reader
expect reader "LASER l1" 'OK LASER l1 .*'
expect reader STREAM 'OK STREAM every=1'
dial driver
expect driver "ROBOT r1" 'OK ROBOT r1 .*'
expect driver "ROTSPEED 20" 'OK ROTSPEED rotspeed=20'
sleep 0.5
before=$(memory)

# Never reads: 1000 scans a second of 8 kB each, and as many requests as the kernel takes.
mkfifo deaf.out
sleep 1000 <deaf.out &
clients+=($!)
{
    printf 'LASER l2\nSTREAM\n'
    while :; do printf 'SCAN\nSCAN\nHELP\n'; done
} 2>/dev/null | nc 127.0.0.1 "$port" >deaf.out &
clients+=($!)
# A byte a second, in the middle of a request for ever.
(
    exec 3<>"/dev/tcp/127.0.0.1/$port"
    for byte in R O B O T; do
        printf %s "$byte" >&3
        sleep 1
    done
    printf ' r2\n' >&3
    timeout 20 head -n 2 <&3 >drop.out
) &
drop=$!
clients+=("$drop")
# A megabyte without a newline.
head -c 1048576 /dev/zero | tr '\0' x | nc -N 127.0.0.1 "$port" >flood.out &
clients+=($!)
has_413() { grep -q '^ERR 413 ' flood.out; }
# Many that come and go, some in the middle of a request or of a stream.
for i in $(seq 200); do
    case $((i % 4)) in
        0) exec 3<>"/dev/tcp/127.0.0.1/$port" ;;
        1) exec 3<>"/dev/tcp/127.0.0.1/$port" && printf 'LASER l2\nSTREAM\n' >&3 ;;
        2) exec 3<>"/dev/tcp/127.0.0.1/$port" && printf 'ROBOT r2\nFORW' >&3 ;;
        3) exec 3<>"/dev/tcp/127.0.0.1/$port" && printf 'WORLD\nPOSES\n' >&3 ;;
    esac
    exec 3>&-
done
eventually "ERR 413" has_413
kill -0 "$server" || fail "simrun died: $(cat simrun.err)"

# More than are allowed.
for i in $(seq 4 240); do
    # only a lasting connection
    exec {fd}<>"/dev/tcp/127.0.0.1/$port" && open+=("$fd")
done
refused=0
for fd in "${open[@]}"; do
    read -r -t 5 line <&"$fd" || true
    [[ $line == 'ERR 429 '* ]] && refused=$((refused + 1))
done
for fd in "${open[@]}"; do exec {fd}>&-; done
[ "$refused" -gt 0 ] || fail "240 clients at once, though 230 are allowed"

wait "$drop" || fail "no answer to a request that came a byte a second: $(cat drop.out)"
grep -q '^OK ROBOT r2 ' drop.out || fail "r2 was not freed by those who vanished: $(cat drop.out)"
sleep 2
after=$(memory)
[ $((after - before)) -lt 8192 ] || fail "memory grew from $before to $after kB"

expect driver STATUS 'OK STATUS .* rotspeed=20\.000 .*'
expect reader STOP 'OK STOP'
grep -a '^SCAN' reader.out | sed 's/.* seq=\([0-9]*\) .*/\1/' |
    awk 'NR > 1 && $1 != before + 1 { print "after " before " came " $1; bad = 1 } { before = $1 }
        END { exit bad || NR < 20 * '$speed' }' || fail "the reader missed a scan"
stop INT

# Few descriptors: fewer clients, each told so.
set +e
(ulimit -n 40 && exec simrun "$data/square.env" many.3dm --clock step --port-file few >announced 2>simrun.err) &
server=$!
set -e
eventually "the port file" test -s few
open=()
refused=0
for _ in $(seq 12); do
    exec {fd}<>"/dev/tcp/127.0.0.1/$(cat few)" && open+=("$fd")
done
for fd in "${open[@]}"; do
    read -r -t 10 line <&"$fd" || fail "neither a greeting nor a refusal"
    [[ $line == 'ERR 429 '* ]] && refused=$((refused + 1))
done
[ "$refused" -eq 4 ] || fail "$refused of 12 clients refused with 40 descriptors, expected 4"
for fd in "${open[@]}"; do exec {fd}>&-; done
stop TERM
