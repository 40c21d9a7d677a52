#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The kerbs of the thesis' road (table 5.3), found in Python by a tilted laser: standing, and on a robot that drives
# aslant along them; the truth is in road.env: 1 m to each side, 0.15 m high.
. "$(dirname "$0")/../pipelines/common.sh"
export PYTHONPATH=$source_dir/lib/client/python PYTHONDONTWRITEBYTECODE=1

cat >drive.3dm <<'END'
#3dm 1
robot id=r1 model=pioneer-2dx at=-5,0.1 heading=-3 motion_noise=0,0,0,0 odometry_noise=0,0,0,0
laser id=front on=r1 at=0,0,0.5 tilt=-30 range=3 fov=180 step=0.25 sigma=0.01
END

# find LAYOUT OPTION…
find_kerbs() {
    rm -f port
    simrun "$scenes/road.env" "$1" --clock step --noise --seed 1 --port-file port >announced 2>warnings &
    server=$!
    trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    timeout 60 python3 "$source_dir/share/examples/road_side.py" "$(cat port)" front --height 0.5 --tilt -30 \
        "${@:2}" >out 2>err || fail "status $?: $(cat out err)"
    kill "$server"
    wait "$server" || fail "simrun ended with $?: $(cat warnings)"
}

# expect SIDE METRES DEGREES: to 1 cm, 0.3 degrees and 1 cm of height.
expect() {
    sed -nE "s/^$1: ([0-9.]+) m .* direction (-?[0-9.]+) degrees, ([0-9.]+) m high.*/\1 \2 \3/p" out |
        awk -v m="$2" -v d="$3" 'function off(a, b) { return a > b ? a - b : b - a }
            { ok = off($1, m) < 0.01 && off($2, d) < 0.3 && off($3, 0.15) < 0.01 } END { exit !ok }' ||
        fail "$1 is not at $2 m, $3 degrees: $(cat out)"
}
find_kerbs "$scenes/road.3dm" -o kerbs.csv
expect left 1 0
expect right 1 0
[ "$(wc -l <kerbs.csv)" -eq 3 ] || fail "$(cat kerbs.csv)"

find_kerbs drive.3dm --drive r1,6
expect left 0.9012 3
expect right 1.1015 3
cp out first
find_kerbs drive.3dm --drive r1,6
expect_same first out "other kerbs the second time"

status=0
python3 "$source_dir/share/examples/road_side.py" 1 front --height 0.5 --tilt -30 >out 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status without a server: $(cat err)"
for bad in "--drive r1" "--scans 0"; do
    # shellcheck disable=SC2086
    expect_status 2 python3 "$source_dir/share/examples/road_side.py" 1 front --height 0.5 --tilt -30 $bad
    grep -q "error: ${bad% *}" err || fail "$bad: $(cat err)"
done
