#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# AriaCoda's own examples, where a folder of them is found: those that ispace-wire(7) lists compile with no edit, and those
# that drive a robot with sonars end as over the packets of a Pioneer, to 5 cm and 2 degrees. Of its tests 30 compile.
. "$(dirname "$0")/../pipelines/common.sh"

folder=
for candidate in "${ISPACE_ARIACODA:-}" "${ISPACE_ARIACODA:-}/examples" "${ISPACE_TEST_DATA:-}/AriaCoda/examples" \
    /usr/local/Aria/examples /usr/local/share/Aria/examples /usr/share/doc/libaria-dev/examples; do
    [ -n "$folder" ] || [ ! -f "$candidate/simpleConnect.cpp" ] || folder=$candidate
done
[ -n "$folder" ] || skip "ISPACE_ARIACODA names no folder of AriaCoda's examples"

# The table of the page: names and states.
sed -n '/^example  *state  *remark/,/^\.EE/p' "$source_dir/lib/extensions/wire/ispace-wire.7" | awk 'NR > 1 && NF > 1 { print $1 }' >listed
[ "$(wc -l <listed)" -eq 45 ] || fail "the page lists $(wc -l <listed) examples"
includes="-I $source_dir/lib/client/aria -I $source_dir/lib/client"

# compiles NAME
compiles() {
    # shellcheck disable=SC2086
    "${CXX:-c++}" -std=c++20 -w -pthread $includes -fsyntax-only "$folder/$1.cpp" 2>"$1.err"
}
export -f compiles
export folder includes
export CXX="${CXX:-c++}"
for name in $(cat listed); do [ -f "$folder/$name.cpp" ] && echo "$name" || echo "$name" >>missing; done >present
xargs -P "$(nproc)" -I{} bash -c 'compiles {} || echo {}' <present >broken
echo "$(wc -l <present) of 45 examples are there, $(wc -l <broken) of them do not compile"
[ ! -s broken ] || fail "$(while read -r name; do head -n 3 "$name.err"; done <broken)"
for file in "$folder"/*.cpp; do
    grep -qx "$(basename "$file" .cpp)" listed || echo "not on the page: $(basename "$file")"
done

# Upstream's tests by the second table: those that compile, at least 30.
sed -n '/^test  *state  *remark/,/^\.EE/p' "$source_dir/lib/extensions/wire/ispace-wire.7" |
    awk 'NR > 1 && NF > 1 && $2 != "missing" { print $1 }' >listed_tests
[ "$(wc -l <listed_tests)" -eq 39 ] || fail "the page lists $(wc -l <listed_tests) tests"
if [ -d "$folder/../tests" ]; then
    export folder="$folder/../tests"
    while read -r name; do [ ! -f "$folder/$name.cpp" ] || echo "$name"; done <listed_tests >present_tests
    xargs -P "$(nproc)" -I{} bash -c 'compiles {} || echo {}' <present_tests >broken
    good=$(($(wc -l <present_tests) - $(wc -l <broken)))
    echo "$good of $(wc -l <present_tests) tests that are there compile"
    while read -r name; do head -n 3 "$name.err"; done <broken
    [ "$good" -ge 30 ] || fail "fewer than 30 tests compile"
    folder=${folder%/../tests}
fi

printf '#env 1\nfence path=-4,-4;4,-4;4,4;-4,4 closed=yes\n' >room.env

# build NAME native|p2os
build() {
    local over=
    [ "$2" = native ] || over="-I $source_dir/tests/client/p2os"
    # shellcheck disable=SC2086
    "$CXX" -std=c++20 -w -pthread $over $includes "$folder/$1.cpp" -o "$1.$2"
}

# pose NAME native|p2os SECONDS KEYS: where the robot is after these simulated seconds, or at the end of the program
pose() {
    rm -rf port run
    simrun room.env r1.3dm --clock step --until "$3" --p2os r1=0 --port-file port --record run >announced 2>warnings &
    server=$!
    trap 'kill "$server" "$program" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    printf '%b' "$4" >keys
    ISPACE_SIMRUN=127.0.0.1:$(cat port) ISPACE_P2OS=$(sed 's/.*"p2os":{"r1":"\([^"]*\)".*/\1/' announced) \
        timeout 200 "./$1.$2" <keys >"$1.$2.out" 2>&1 &
    program=$!
    wait -n "$server" "$program" || true
    # Some examples go on without their robot.
    kill "$server" "$program" 2>/dev/null || true
    wait "$server" "$program" 2>/dev/null || true
    tail -n 1 run/robots.csv | cut -d , -f 3-5
}

# same NAME SECONDS [KEYS]
same() {
    grep -qx "$1" present || return 0
    echo "#3dm 1
robot id=r1 model=pioneer-3dx at=-2,-2" >r1.3dm
    for protocol in native p2os; do
        build "$1" $protocol
        pose "$1" $protocol "$2" "${3:-}" >$protocol.pose
    done
    echo "$1: $(cat native.pose) | $(cat p2os.pose)"
    [ "$(cat native.pose)" != -2,-2,0 ] || fail "$1 does not drive: $(tail -n 3 "$1.native.out")"
    paste -d , native.pose p2os.pose | awk -F , '{
        turn = $3 - $6; turn -= 360 * int(turn / 360); if (turn < 0) turn = -turn; if (turn > 180) turn = 360 - turn
        exit !(sqrt(($1 - $4) ^ 2 + ($2 - $5) ^ 2) <= 0.05 && turn <= 2)
    }' || fail "$1 ends elsewhere"
}
up='\033[A' left='\033[D'
same simpleMotionCommands 60
same gotoActionExample 60
same singleThreadLoopExample 20
same actionExample 60
same actionGroupExample 60 w
same wander 60
same wanderAndLogData 60
same teleopActionsExample 20 "$up$up$up$up$left"
same gyroExample 20 3
