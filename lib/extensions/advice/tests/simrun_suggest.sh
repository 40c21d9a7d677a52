#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# simrun --suggest: each command that it prints changes the scene, and coverage --run then reports the share told.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

printf '#env 1\nispace size=10,6,2.5\nwall id=w from=1,-3 to=1,1\n' >room.env
cat >layout.3dm <<'END'
#3dm 1
laser id=l1 at=-4.5,1 heading=150 fov=120 range=6
human id=h at=-4,2 path=-4,2;4,2;4,-2 speed=1
END
expect_status 0 simrun room.env layout.3dm --listen 127.0.0.1:0 --clock fast --until 12 --record run --suggest
[ "$(grep -c '^    envc room.env layout.3dm --' out)" -ge 2 ] || fail "no two suggestions: $(cat out)"
while IFS= read -r told && IFS= read -r command; do
    (eval "$command -q") || fail "no such change: $command"
    coverage -q changed.env --run run --json >changed.json
    python3 - "$told" <<'END' || fail "the run is seen differently: $told"
import json, re, sys
told = float(re.search(r"seen for ([0-9.]*)% of", sys.argv[1]).group(1)) / 100
seen = 1 - json.load(open("changed.json"))["run"]["all"]["time_shares"][0]
sys.exit(abs(told - seen) > 6e-5)
END
    rm changed.env
done < <(grep '^  ' out)

# A building: changes of any storey, for the run over all of them; and its report.
printf -- "- storey: {id: a, records: &r {ispace: {size: [10, 6, 2.5]}, wall: {id: w, from: [1, -3], to: [1, 1]}}}
- storey: {id: b, z: 3, records: *r}
- lift: {id: l, storeys: 'a,b', at: [-4, 0], size: [1.2, 1.2], door: 0.9}\n" >house.yaml
cat >house.3dm <<'END'
#3dm 1
laser id=a/l1 at=-4.5,1 heading=150 fov=120 range=6
laser id=b/l1 at=4.5,-2 heading=0 fov=120 range=6
human id=a/h at=-4,2 path=-4,2;4,2;4,-2 speed=1
human id=b/h at=-4,2 path=-4,2;0,2;0,-2 speed=1
END
expect_status 0 simrun house.yaml house.3dm --listen 127.0.0.1:0 --clock fast --until 12 --record whole --suggest \
    --report whole.json --expect 'a/h within 2 of a/4,-2'
cp out told
[ "$(grep -c '^    envc house.yaml house.3dm --' told)" -ge 2 ] || fail "no two suggestions: $(cat told)"
coverage -q house.yaml house.3dm --run whole --json | cmp - whole.json || fail "the report is not that of coverage --run"
while IFS= read -r told && IFS= read -r command; do
    (eval "$command -q") || fail "no such change: $command"
    coverage -q changed.env --run whole --json >changed.json
    python3 - "$told" <<'END' || fail "the building's run is seen differently: $told"
import json, re, sys
told = float(re.search(r"seen for ([0-9.]*)% of", sys.argv[1]).group(1)) / 100
seen = 1 - json.load(open("changed.json"))["run"]["all"]["time_shares"][0]
sys.exit(abs(told - seen) > 6e-5)
END
done < <(grep '^  ' told)
expect_status 0 simrun house.yaml house.3dm --listen 127.0.0.1:0 --clock fast --until 1 --record page --report whole.html \
    --expect 'no collision'
grep -q 'no collision' whole.html || fail "the page has no expectations"
[ "$(grep -o 'id="storey[12]"' whole.html | sort -u | wc -l)" -eq 2 ] || fail "the page has not both storeys"

# All is seen already, or the room is without movers.
printf '#env 1\nispace size=10,6,2.5\n' >hall.env
printf '#3dm 1\nlaser id=l1 at=-4.5,0 range=20 fov=360\nhuman id=h at=-2,1 path=-2,1;2,1\n' >seen.3dm
expect_status 0 simrun hall.env seen.3dm --listen 127.0.0.1:0 --clock fast --until 1 --record seen --suggest 1
grep -qx 'no change of one sensor sees more of the run' out || fail "suggestions for a run that is seen: $(cat out)"
printf '#3dm 1\nlaser id=l1 at=-4.5,0 range=4\n' >alone.3dm
expect_status 0 simrun hall.env alone.3dm --listen 127.0.0.1:0 --clock fast --until 1 --record alone --suggest 1
grep -qx 'the run has no robots or people to see' out || fail "suggestions for a run without movers: $(cat out)"
expect_error 2 simrun room.env layout.3dm --suggest
expect_error 2 simrun room.env layout.3dm --record run2 --suggest=9
