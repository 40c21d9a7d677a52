#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Cameras are placed by the people of a record; one that sees none keeps its pose with a warning, and pictures that are
# missing or of another size are errors that name them.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

printf '%s\n' '#env 1' 'ispace at=4,3 size=8,6,2.5' 'cube at=7.4,0.5 size=0.8,0.6,0.7' >room.env
lasers='laser id=l1 model=utm-30lx at=0.1,0.1,Z heading=45\nlaser id=l2 model=utm-30lx at=7.9,5.9,Z heading=-135\n'
camera='camera id=c1 at=0.3,5.7,2.3 heading=-45 tilt=-30 pixels=200,150 fov=80'
wall='camera id=c2 at=0.3,5.7,2.3 heading=135 tilt=30 pixels=32,24 fov=80'
printf "%b" "#3dm 1\n${lasers//Z/0.3}$camera\n$wall\nhuman id=h1 at=4,3 walk=wander\n" >real.3dm
simrun room.env real.3dm -q --noise --clock fast --until 30 --record run --record-frames 2 >/dev/null

off=${camera/at=0.3,5.7,2.3 heading=-45/at=0.8,5.4,2.1 heading=-57}
printf "%b" "#3dm 1\n${lasers//Z/0.3}$off\n$wall\n" >guess.3dm
expect_status 0 envc room.env guess.3dm --calibrate run -o corrected.3dm
has 'warning: the pictures of c2 show .*; its pose stays' err || fail "no warning of c2: $(cat err)"
has -F "$wall" corrected.3dm || has 'id=c2 at=0.3,5.7,2.3 heading=135 tilt=30' corrected.3dm || fail "c2 moved"
sed -n 's/^camera id=c1 at=\([^,]*\),\([^,]*\),\([^ ]*\) heading=\([^ ]*\).*/\1 \2 \3 \4/p' corrected.3dm |
    awk '{ found = 1; exit !(($1 - 0.3) ^ 2 + ($2 - 5.7) ^ 2 + ($3 - 2.3) ^ 2 < 0.05 ^ 2 && ($4 + 45) ^ 2 < 0.3 ^ 2) }
         END { if (!found) exit 1 }' || fail "c1 is not within 5 cm and 0.3 degrees: $(grep id=c1 corrected.3dm)"

# The pictures of one camera for a layout without cameras, and a camera without pictures.
printf "%b" "#3dm 1\n${lasers//Z/0.3}camera id=c9 at=4,3,2\n" >other.3dm
expect_status 0 envc room.env other.3dm --calibrate run -o out.3dm
has 'the log has no pictures of c9: its pose stays' err || fail "no warning of c9: $(cat err)"
has 'pictures of c1 are of no fixed camera' err || fail "no warning of the pictures: $(cat err)"

# Lasers that see no legs.
sed 's/,0\.3 heading/,1.2 heading/' guess.3dm >high.3dm
expect_status 0 envc room.env high.3dm --calibrate run --json
has '"cameras":\[\],"unplaced":\[{"id":"c1","reason":"no level laser below 0.65 m' out || fail "no reason: $(cat out)"

sed 's/pixels=200,150/pixels=400,300/' guess.3dm >larger.3dm
expect_status 1 envc room.env larger.3dm --calibrate run -o out.3dm
has 'run/pictures/c1-.*png: error: the picture has 200 x 150 pixels, and c1 has 400 x 300' err || fail "size: $(cat err)"

# Pictures alone tell no pose.
mkdir alone
cp -r run/. alone
{ head -n 1 run/scans.jsonl; grep '"file"' run/scans.jsonl; } >alone/scans.jsonl
expect_status 1 envc room.env guess.3dm --calibrate alone -o out.3dm
has 'alone: error: the log holds pictures alone' err || fail "pictures alone: $(cat err)"

picture=$(find run/pictures -name 'c1-*' | sort | sed -n 9p)
rm "$picture"
expect_status 1 envc room.env guess.3dm --calibrate run -o out.3dm
has -F "$picture: error: No such file" err || fail "a missing picture: $(cat err)"
