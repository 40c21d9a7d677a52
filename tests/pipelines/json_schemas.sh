#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# All JSON of the tools, over all scenes and in all golden cases, matches the schemas of the build: no undescribed key, and none
# missing.
. "$(dirname "$0")/common.sh"

python3 -c 'from jsonschema import Draft202012Validator' 2>/dev/null || skip "no python3-jsonschema"
/usr/bin/python3 -c 'import yaml' 2>/dev/null || skip "no python3-yaml"
validate="$source_dir/tests/schemas/validate.py"
schemas=$binary_dir/share/schemas
python3 "$validate" --self-test "$schemas" || fail "the schemas themselves"

# Everything that tools say aside is for the other tests.
exec 3>&2 2>talk
for scene in "$scenes"/*.env; do
    name=$(basename "$scene" .env)
    envc "$scene" -q --info --json >"$name.info.json"
    envc "$scene" -q -o "$name.geojson"
    envc "$scene" -q --slice 0.15 -o "$name.slice.geojson"
    layout=$scenes/$name.3dm
    [ -f "$layout" ] || continue
    coverage "$scene" "$layout" -q --json -o "$name.seen.geojson" >"$name.coverage.json"
    scan "$scene" "$layout" -q --frames 2 --noise -o "$name.jsonl"
done
envc "$data/map.yaml" -q --rooms list --json >map.rooms.json
envc "$data/drawings/flat.svg" -q --rooms list -o flat.rooms.json
coverage "$scenes/house/house.env" "$data/house.3dm" -q --failures 1 --perturb 5cm,3deg --crowd 4 --localise 0.5 \
    --presence wander:2,20 --compare "$data/house.3dm" --json >house.json
envc --calibrate "$data/turns.tuple" --json >drive.json
scan "$scenes/ispace.env" "$scenes/ispace.3dm" -q --select l1 -o real.jsonl
envc "$scenes/ispace.env" "$scenes/ispace.3dm" -q --calibrate real.jsonl --json >poses.json
printf 'camera id=c1 at=1,1,2 pixels=32,24\n' | cat "$scenes/ispace.3dm" - >eye.3dm
simrun "$scenes/ispace.env" eye.3dm -q --clock fast --until 1 --record seen >/dev/null
envc "$scenes/ispace.env" eye.3dm -q --calibrate seen --json >unplaced.json
scan "$scenes/ispace.env" "$scenes/ispace.3dm" -q --against real.jsonl --json >reality.json
for layout in ultrasound ranger uwb; do
    scan "$data/square.env" "$data/$layout.3dm" --any-environment -q -o "$layout.jsonl"
    coverage "$data/square.env" "$data/$layout.3dm" --any-environment -q --report "$layout.json" >/dev/null
done
coverage "$data/zones.env" "$data/domes.3dm" --density 500 --parallax 45 --json >cameras.json
coverage "$data/zones.env" "$data/domes.3dm" --facing '*,45deg,0=0%' --facing '*,90deg,90' --privacy '*,1500' --json \
    >faces.json || [ $? -eq 3 ]
coverage "$data/square.env" "$data/half.3dm" --compare "$data/whole.3dm" --json >compared.json
coverage "$data/square.env" "$data/half.3dm" --perturb 1cm,1deg --failures 1 --crowd 1 --require 1% --cell 0.5 --json \
    >robust.json
arrange "$data/square.env" --sensor laser,range=2:2 --sensor ranger:1 --strategy grid -X 3 -Y 3 -q \
    --trace tried.jsonl -o best.3dm
printf '%s\n' "$data/square.env" missing.env | arrange --batch - --sensor laser --strategy grid -X 2 -Y 2 -o by/ \
    >arranged.jsonl && fail "a list with a missing room passes"
expect_status 3 coverage "$scenes/house/house.env" "$data/house.3dm" -q --require free:99% --suggest 3 --json
mv out advice.json
grep -q '"required":' advice.json || fail "no suggestion tells the floor that is required"
printf '%s\n' "$data/square.env $data/half.3dm" | scan --batch - -q -o by/ >scanned.jsonl
simrun "$data/square.env" "$data/session.3dm" -q --clock fast --until 0.5 --record run >simrun.json
simrun "$scenes/open-office.env" --vector 2 --shm "schemas-$$" --people 1 </dev/null >vector.json
for tool in envc arrange scan coverage simrun; do
    $tool --version --json >"$tool.version.json"
    $tool missing.env --errors json 2>"$tool.said.jsonl" >/dev/null && fail "$tool reads a missing file"
    $tool --no-such --errors=json 2>>"$tool.said.jsonl" >/dev/null && fail "$tool takes any option"
done
arrange "$data/square.env" --sensor laser,range=2:2 --strategy grid -X 3 -Y 3 --errors json -o few.3dm 2>report.said.jsonl
envc "$data/map.yaml" --errors json -o map.glb 2>notes.jsonl
printf '#env 1\nwall from=0,0 to=1\n' | envc - --errors json 2>wrong.jsonl && fail "half a point passes"
printf '%s\n' missing.env | coverage --batch - --errors json 2>jobs.said.jsonl >/dev/null && fail "a missing room passes"
# The JSON for a browser.
sed '$a mat id=under at=0,1\ngate id=way at=1,1\nhuman id=her at=1,-1' "$data/session.3dm" >web.3dm
# The domain is beyond those of other tests.
ros2=()
[ ! -e "$binary_dir/lib/ispace/dds.so" ] || ros2=(--ros2=101)
simrun "$data/square.env" web.3dm --any-environment -q --web 127.0.0.1:0 --foxglove 0 --rosbridge 0 "${ros2[@]}" \
    >web_begin.json &
server=$!
trap 'kill -9 "$server" 2>/dev/null || true; cleanup' EXIT
for _ in $(seq 1000); do [ -s web_begin.json ] || sleep 0.02; done
python3 "$source_dir/lib/extensions/web/tests/web_client.py" "$(sed 's/.*"web":"\([^"]*\)".*/\1/' web_begin.json)" >web.jsonl
kill "$server"
wait "$server"
printf '%s\n' 'run: [ "coverage {room} {layout} -q --report {out}.json", "scan {room} {layout} -q -o {out}.jsonl" ]' \
    'axes: {room: [hall.env], layout: [hall.3dm]}' >sweep.yaml
cp "$scenes"/hall.* .
ispace-sweep commands sweep.yaml --json >jobs.jsonl
ispace-sweep commands sweep.yaml | sh
ispace-sweep join sweep.yaml -o table.jsonl
ispace-sweep run sweep.yaml -o ran.jsonl
ispace-sweep status sweep.yaml ran.jsonl --json >ran.json
exec 2>&3

python3 "$validate" "$schemas" ./*.json ./*.jsonl ./*.geojson run/scans.jsonl \
    "$source_dir"/tests/*/*.out "$source_dir"/lib/extensions/*/golden/*.out >log || fail "$(head -n 40 log)"
# The schemas restrict the values.
[ "$(ls ./*.json ./*.jsonl ./*.geojson | wc -l)" -gt 30 ] || fail "few outputs: $(ls)"

# A part of an extension replaces no value of a schema.
printf '{"title":"ispace-scan/2"}' >part.json
PATH=$schemas:$PATH expect_error 1 join_schema "$source_dir/share/schemas/scan.json" part.json joined.json
grep -q 'part.json/title stands in the schema, too' err || fail "$(cat err)"

# The test can fail: a key more, and a report without its version.
sed 's/"height":/"hight":0,"height":/' catalogue.info.json >bad.json
! python3 "$validate" "$schemas" bad.json >log || fail "a key that is not described passes"
grep -q hight log || fail "$(cat log)"
