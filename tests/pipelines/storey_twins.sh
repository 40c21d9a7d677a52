#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A room alone, as the only storey of a building, and as one of two: figures, readings and messages are the same but
# for ids.
. "$(dirname "$0")/common.sh"

cat >room.env <<'END'
#env 1
ispace id=room at=4,3 size=8,6,2.5 ceiling=yes
desk id=d at=6,4.5
pillar id=p at=3,3 size=0.4,0.4 height=2.5
wall id=w from=5,0 to=5,1.8 height=2.5
zone id=z at=2,2 size=2,2
END
cat >one.env <<'END'
#env 1
storey id=ground file=room.env
END
cat >two.env <<'END'
#env 1
storey id=ground file=room.env
storey id=upper file=room.env z=3
END
cat >layout.3dm <<'END'
#3dm 1
laser id=l at=1,1,0.3 heading=30 range=0,6 fov=240 step=5
laser id=t at=7,1,1.5 heading=120 tilt=-10 range=0,9 fov=60 step=10
ranger id=r at=1,5,2.2 heading=-45 tilt=-40 fov=90,60 pixels=12,8 range=0,9
camera id=c at=7.5,5.5,2.4 heading=-135 tilt=-30 fov=80 pixels=64,48 range=0,9
uwb id=u1 at=0.2,0.2,2
uwb id=u2 at=7.8,0.2,2
uwb id=u3 at=4,5.8,2
microphone id=m at=4,3.5,1
pir id=p1 at=0.1,3,2.2
thermometer id=th at=2,2,1.2
robot id=rob at=2,4.5 heading=-60 path=2,4.5;2,1.5;4.2,1
human id=hum at=6,2 path=6,2;7,3
END
cat >wrong.3dm <<'END'
#3dm 1
laser id=out at=9,3
laser id=in at=3,3
laser id=low at=4,4,-0.1
laser id=pending
robot id=rob at=2,4.5 path=2,4.5;9,4.5
ultrasound id=rec at=4,2,2
END
for layout in layout wrong; do
    sed -E 's/ (id|on)=/ \1=ground\//' $layout.3dm >$layout-storey.3dm
done

# plain FILE: as of the room alone, without lines about the storey above and those that sum up.
plain() {
    sed -E 's/ground: |ground\///g; s/ --storey .\*.//g; s/-storey\.3dm/.3dm/g; s/(one|two)\.env/room.env/g; /^[a-z]*: (warning: )?upper: /d' "$1"
}

# twins NAME STATUS COMMAND…: runs the command with ENV and LAYOUT for each of the three; its messages are those of
# the room alone. Output goes to NAME-room, NAME-one and NAME-two.
twins() {
    local name=$1 status=$2 building
    shift 2
    for building in room one two; do
        local layout="" command=()
        [ $building = room ] || layout=-storey
        for word in "$@"; do
            word=${word//ENV/$building.env} word=${word//LAYOUT/layout$layout.3dm}
            command+=("${word//WRONG/wrong$layout.3dm}")
        done
        [ $building != one ] || command+=(--storey '*')  # as a building: its only storey is a room
        expect_status "$status" "${command[@]//DIR/$name-$building-run}"
        mv out "$name-$building"
        plain err >"$name-$building.err"
        cmp "$name-room.err" "$name-$building.err" || fail "$name: messages of $building: $(diff "$name-room.err" "$name-$building.err")"
    done
}

readings() { plain "$1" | grep '^{"sensor"'; }
twins scan 0 scan ENV LAYOUT
for building in one two; do
    diff <(readings scan-room) <(readings scan-$building) || fail "readings of $building"
done
[ "$(readings scan-room | wc -l)" -ge 8 ] || fail "few readings: $(cat scan-room)"

# Coverage: the report of the storey is that of the room.
cat >compare.py <<'END'
import json, sys
room = json.load(open(sys.argv[1]))
text = open(sys.argv[2]).read().replace("ground/", "")
storey = json.loads(text)
if "storeys" in storey:
    row = next(r for r in storey["rooms"] if r["id"] == "ground")
    storey = next(s["report"] for s in storey["storeys"] if s["id"] == "ground") | {"rooms": [row | {"id": ""}]}
for spot in storey["unseen"]:
    spot.pop("room", None)
def differences(a, b, at=""):
    if isinstance(a, dict) and isinstance(b, dict):
        for key in sorted(a.keys() | b.keys()):
            yield from differences(a.get(key), b.get(key), at + "/" + key)
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for i, (c, d) in enumerate(zip(a, b)):
            yield from differences(c, d, f"{at}/{i}")
    elif a != b:
        yield f"{at}: {a} {b}"
found = list(differences(room, storey))
sys.exit("\n".join(found) if found else 0)
END
for case in layout wrong; do
    operand=${case^^}
    for options in "" "--plane 1" "--cell 0.2"; do
        # shellcheck disable=SC2086
        twins "coverage" 0 coverage ENV "$operand" --json $options
        for building in one two; do
            python3 compare.py coverage-room coverage-$building || fail "coverage of $case as $building: $options"
        done
    done
done
twins check 1 envc ENV WRONG --check
twins wrong 0 scan ENV WRONG

# Layouts: the same poses, value and bound. One sensor goes to the ground of two equal storeys, which are twice the floor.
placed() { plain "$1" | grep -E '^(laser|camera)'; }
value() { sed -n "s/^result .*$2=\([0-9.]*\)%.*/\1/p" "$1"; }
for sensor in laser,range=4,fov=180 camera,fov=70,range=6; do
    for options in "--seed 3" "--z 2.2" "--z 9"; do
        # shellcheck disable=SC2086
        twins arrange 0 arrange ENV --sensor $sensor -q --candidates 6,5,8 --cell 0.25 $options
        for building in one two; do
            diff <(placed arrange-room) <(placed arrange-$building) || fail "arrange $sensor $options: poses of $building"
        done
        [ -n "$(placed arrange-room)" ] || fail "no sensor"
        for key in coverage bound; do
            [ "$(value arrange-room $key)" = "$(value arrange-one $key)" ] || fail "arrange $sensor $options: $key"
            python3 -c "import sys; a, b = map(float, sys.argv[1:]); sys.exit(abs(a - 2 * b) > 1e-4)" \
                "$(value arrange-room $key)" "$(value arrange-two $key)" || fail "arrange $sensor $options: $key of two"
        done
    done
done

# Runs: records and readings are the same.
twins run 0 simrun ENV LAYOUT --clock fast --until 6 --dt 0.05 --record DIR
for building in one two; do
    for file in run-room-run/*; do
        name=${file##*/}
        case $name in *.env | *.3dm | *.yaml | timing.csv | pictures | depths) continue ;; esac
        diff <(plain "$file" | grep -v '^#') <(plain run-$building-run/ground/"$name" | grep -v '^#') >difference ||
            fail "run as $building: $name: $(head -5 difference)"
    done
done
twins limit 2 simrun ENV LAYOUT --clock fast --until 6 --record DIR --record-limit 1k
twins wrong-run 0 simrun ENV WRONG --clock fast --until 1

# Large rooms have larger cells, with a message.
printf '#env 1\nfence id=f path=0,0;300,0;300,300;0,300 closed=yes height=2.5\ninside at=1,1\n' >room.env
cat >layout.3dm <<'END'
#3dm 1
laser id=l at=5,5,1 range=0,4
END
sed 's/id=/id=ground\//' layout.3dm >layout-storey.3dm
twins large 0 coverage ENV LAYOUT --json
for building in one two; do python3 compare.py large-room large-$building || fail "coverage of a large room as $building"; done

# Noise without an effect is told alike.
printf '#3dm 1\nrobot id=rob at=2,4.5\n' >layout.3dm
printf '#3dm 1\nrobot id=ground/rob at=2,4.5\n' >layout-storey.3dm
twins noise 0 simrun ENV LAYOUT --clock fast --until 1 --noise
