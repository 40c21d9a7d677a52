#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# However little memory there is, a tool does its work as always or ends with status 1 and one line;
# it does not crash, and does not do half of it.
. "$(dirname "$0")/common.sh"

! ldd "$(command -v envc)" | has 'lib[at]san' || skip "sanitizers want all the memory there is"
ulimit -c 0

one_job_of_each_tool

# TBB 2022 crashes or waits for ever if its first allocation fails, some before main begins: its exceptions ask for a
# setting, whose initialisation is under way. It is killed then.
tbb=$(sed -n 's/.*define TBB_VERSION_MAJOR //p' /usr/include/oneapi/tbb/version.h 2>/dev/null || true)
tbb=${tbb:-0} patience=100
[ "$tbb" -lt 2022 ] || patience=10

# check_limit KILOBYTES JOB EXPECTED
check_limit() {
    local status=0 command=$2
    rm -f map.png
    # shellcheck disable=SC2086
    (ulimit -v "$1" && exec timeout --signal=KILL "$patience" $command) >out 2>err || status=$?
    case $status in
        0)
            [ "$(product)" = "$3" ] || fail "another product in $1 kB: $command"
            [ ! -s err ] || fail "done, but in $1 kB: $command: $(cat err)"
            ;;
        1)
            one_error "${command%% *}" "$command in $1 kB"
            ;;
        127)  # the system could not start it
            grep -qE "error while loading shared libraries|Fatal glibc error: cannot allocate" err ||
                fail "$command: $(cat err)"
            ;;
        137 | 139)
            [ "$tbb" -ge 2022 ] || fail "status $status in $1 kB: $command: $(cat err)"
            ;;
        *) fail "status $status in $1 kB: $command: $(cat err)" ;;
    esac
}

size=$(($(stat -L -c %s "$(command -v envc)") / 1000))
for job in "${jobs[@]}"; do
    rm -f map.png
    $job >out
    expected=$(product)
    threads=1
    # With less than its own size the kernel ends a program before it begins.
    for limit in "$size" 30000 $(seq 40000 2500 110000) $(seq 120000 68000 800000); do
        check_limit "$limit" "$job -j $threads" "$expected"
        threads=$((5 - threads))
    done
done
