#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# suggest_everywhere.sh scenes|K/N: five suggestions of coverage in each scene of share/scenes, or in each K-th of N
# maps in the folder ISPACE_TEST_DATA, run as they are printed; coverage then reports the gain told.
# Bounds, for the time: two scanners with a range of an eighth of the map, candidates a sixteenth of it apart, and at
# most 80 cells along a side; gains are exact none the less. Of the 32 random polygons in agp/, the first of each size.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
part=${1:?scenes or K/N}

# suggestions: prints kind, covered share and command of each suggestion in told.json.
suggestions() {
    python3 - <<'END2'
import json
report = json.load(open("told.json"))
before = report["coverage"]["exact"]
if before is None:  # of lasers that turn: by cells
    before = report["coverage"]["grid"]
for one in report["suggestions"]:
    gain = (one["coverage"] - before) * report["indoor_area"]
    assert abs(gain - one["gained"]) <= 1e-9 * report["indoor_area"] + 1e-9, one
    print(one["kind"], one["coverage"], one["command"], sep="\t")
END2
}

# expect_share SHARE MESSAGE: the coverage of changed.env.
expect_share() {
    coverage -q --grid 80 changed.env --json >changed.json || fail "no coverage after: $2"
    python3 - "$1" <<'END2' || fail "other coverage than told: $2"
import json, sys
now = json.load(open("changed.json"))["coverage"]
share = now["grid"] if now["exact"] is None else now["exact"]
sys.exit(abs(share - float(sys.argv[1])) > 1e-9)
END2
}

# five NAME ENV [LAYOUT]: applies all suggestions, then suggests anew in the scene after the first of them, until five
# are applied.
five() {
    local name=$1 count=0 round kind share command
    local scene=("${@:2}")
    for round in 1 2 3 4 5; do
        coverage -q --grid 80 "${scene[@]}" --suggest 5 --json >told.json || fail "$name: no suggestions"
        suggestions >told || fail "$name: a gain is not the difference of two coverages"
        rm -f next.env
        while IFS=$'\t' read -r kind share command; do
            (eval "$command -q") || fail "$name: no such change: $command"
            expect_share "$share" "$name, $kind: $command"
            count=$((count + 1))
            [ -e next.env ] || mv changed.env next.env
        done <told
        [ "$count" -lt 5 ] || break
        [ -e next.env ] || fail "$name: only $count suggestions, none in round $round"
        mv next.env "scene$round.env"
        scene=("scene$round.env")
    done
    [ "$count" -ge 5 ] || fail "$name: only $count suggestions"
    echo "$name: $count suggestions"
}

# arranged ENV: writes layout.3dm.
arranged() {
    local range step
    envc "$1" --info --json >info.json || fail "$1 is no room"
    read -r range step < <(python3 -c 'import json
a, b, c, d = json.load(open("info.json"))["limits"]
size = max(c - a, d - b)
print(size / 8, size / 16)')
    arrange "$1" --sensor "laser,range=$range,fov=180:2" --candidates "$step,$step,4" -q -o layout.3dm
}

if [ "$part" = scenes ]; then
    cp -r "$scenes"/* .
    for room in *.env *.yaml; do
        case $room in
            barriers.env | near-far.env | ispace.env | hall.env | road.env) five "$room" "$room" "${room%.env}.3dm" ;;
            *) arranged "$room" && five "$room" "$room" layout.3dm ;;
        esac
    done
    five "walkers.3dm" crowded.env walkers.3dm
    five "distributed.3dm" ispace.env distributed.3dm
    arranged house/ground.env && five house/ground.env house/ground.env layout.3dm
    arranged house/upper.env && five house/upper.env house/upper.env layout.3dm
    exit 0
fi

root=${ISPACE_TEST_DATA:-}
[ -n "$root" ] || skip "ISPACE_TEST_DATA names no folder of real maps"
# Not rooms: a world without walls, and one whose models are in other packages.
find "$root" -type f \( -name '*.yaml' -o -name '*.map' -o -name '*.dxf' -o -name '*.svg' -o -name '*.ifc' \
    -o -name '*.obj' -o -name '*.world' -o -name '*.pol' -o -path '*/plans/*.json' \) |
    grep -v -e '/empty_world\.world$' -e '_autorace_2020\.world$' -e '-[2-8]\.pol$' | LC_ALL=C sort >maps
[ -s maps ] || skip "no maps in $root"
number=0
while IFS= read -r map; do
    number=$((number + 1))
    [ $((number % ${part#*/})) -eq $((${part%/*} % ${part#*/})) ] || continue
    options=()
    case $map in
        */oodavid.svg | */shone.svg) options=(--width-is 12m) ;;
        */units_lie.dxf) options=(--units m) ;;
        */ml3.dxf) options=(--wall-layer Walls) ;;
        */room-y-up.obj) options=(--slice-walls 1.2) ;;
        */turtlebot3_gazebo/*.world) [ -e "${map%/*}/../models" ] || options=(--models "${map%/*}/models") ;;
    esac
    name=${map#"$root"/}
    room=$map
    if [ "${#options[@]}" -gt 0 ]; then
        room=room.glb
        envc -q "$map" "${options[@]}" -o room.glb || fail "no room: $name ${options[*]}"
    fi
    arranged "$room" || fail "no layout for $name"
    five "$name" "$room" layout.3dm
    rm -f scene?.env next.env changed.env
done <maps
