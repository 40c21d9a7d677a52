#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# coverage --suggest: each command that it prints changes the scene, and coverage then reports the figures told.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

cp "$scenes"/* . 2>/dev/null || true

# suggestions_of ENV LAYOUT OPTION…
suggestions_of() {
    coverage -q --cell 0.2 "$@" --json >told.json 2>err || [ $? -eq 3 ]
    python3 - <<'END'
import json
for one in json.load(open("told.json"))["suggestions"]:
    print(one["kind"], one["gained"], one["coverage"], one["command"], sep="\t")
END
}

# applied: runs the commands on stdin; prints the number that gain as told.
applied() {
    local count=0 kind share command
    while IFS=$'\t' read -r kind _ share command; do
        (eval "$command -q") || fail "no such change: $command"
        coverage -q --cell 0.2 changed.env --json >changed.json
        python3 - "$share" <<'END' || fail "$kind gains other floor than told: $command"
import json, sys
figure = json.load(open("changed.json"))["coverage"]
share = figure["grid"] if figure["exact"] is None else figure["exact"]
sys.exit(abs(share - float(sys.argv[1])) > 1e-9)
END
        count=$((count + 1))
    done
    echo "$count"
}

total=0
for scene in "near-far.env near-far.3dm" "barriers.env barriers.3dm" "ispace.env ispace.3dm" \
    "crowded.env walkers.3dm"; do
    # shellcheck disable=SC2086
    suggestions_of $scene --suggest 7 >told
    count=$(applied <told)
    [ "$count" -ge 4 ] || fail "only $count suggestions for $scene"
    total=$((total + count))
done
[ "$total" -ge 17 ] || fail "$total suggestions in all"

# Six more scenes: arranged scanners in rooms with corners, furniture and drawings, cameras, a road.
for room in l-room.env facilities.env open-office.env office.yaml; do
    arrange "$room" --sensor urg-04lx:2 --candidates 1,1,8 -q -o "${room%.*}.3dm"
done
for scene in "l-room.env l-room.3dm" "facilities.env facilities.3dm" "open-office.env open-office.3dm" \
    "office.yaml office.3dm" "road.env road.3dm" "ispace.env distributed.3dm"; do
    # shellcheck disable=SC2086
    suggestions_of $scene --suggest 5 >told
    count=$(applied <told)
    [ "$count" -ge 1 ] || fail "no suggestion for $scene"
done

# The same bytes on any number of threads; text and JSON tell the same commands.
coverage barriers.env barriers.3dm --suggest 3 -j 1 >one
coverage barriers.env barriers.3dm --suggest 3 -j 5 >five
expect_same one five "suggestions depend on the threads"
[ "$(grep -c '^    envc barriers.env barriers.3dm --' one)" -eq 3 ] || fail "not three commands"

# Without a number there are five at most; operands stay operands.
coverage --suggest barriers.env barriers.3dm >out
has '^suggestions:' <out || fail "no suggestions"

# A requirement: the first suggestion meets it.
expect_status 3 coverage barriers.env barriers.3dm --require 60%
suggestions_of barriers.env barriers.3dm --suggest 1 --require 60% >told
grep -q '^together' told || fail "no changes that meet the requirement: $(cat told)"
(eval "$(cut -f 4 told) -q")
expect_status 0 coverage changed.env --require 60%

# A storey of a building, and an operand that looks like an option.
cp -r "$scenes/house" house
suggestions_of house/house.env "$data/house.3dm" --storey ground --suggest 3 >told
[ "$(applied <told)" -ge 1 ] || fail "no suggestion for a storey"
# A building: gains are of all its floor, also where a camera sees another storey; a storey without
# sensors gets one like those of the others.
for scene in "house/house.env $data/house.3dm" "$data/atrium.yaml"; do
    # shellcheck disable=SC2086
    suggestions_of $scene --suggest 7 >told
    count=$(applied <told)
    [ "$count" -ge 5 ] || fail "only $count suggestions for the building $scene"
done
grep -v ' id=upper/' "$data/house.3dm" >below.3dm
suggestions_of house/house.env below.3dm --suggest 1 >told
grep -q "^add.*laser id=upper/laser1 " told || fail "no sensor for the empty storey: $(cat told)"
[ "$(applied <told)" -eq 1 ] || fail "the sensor of the empty storey is not as told"
# Storeys of one room: the change is of one of them.
printf -- "- storey: {id: a, records: &r {ispace: {size: 8 x 6}, laser: {at: [3, 2], range: 3}}}\n- storey: {id: b, z: 3, records: *r}\n" >twins.yaml
suggestions_of twins.yaml --suggest 7 >told
[ "$(applied <told)" -ge 3 ] || fail "no three suggestions for storeys of one room: $(cat told)"
cp barriers.env ./-barriers.env
coverage ./-barriers.env barriers.3dm --suggest 1 >told
has ' \./-barriers\.env ' <told || fail "a name becomes an option"

# Prices are those of the records: the cheaper scanner sees as much of a small room.
printf '#env 1\nispace size=3,3,2.5\n' >small.env
cat >small.3dm <<'END'
#3dm 1
laser id=dear model=utm-30lx at=-1.4,-1.4 heading=45 cost=5000
laser id=cheap model=urg-04lx at=1.4,1.4 heading=-135 cost=1000
END
suggestions_of small.env small.3dm --suggest >told
grep -q "^replace.*--set dear.model=urg-04lx --set dear.cost=1000" told || fail "no cheaper device: $(cat told)"
grep -q '"saved":4000' told.json || fail "the saving is not told"
[ "$(applied <told)" -ge 2 ] || fail "no two suggestions"

expect_error 2 coverage barriers.env barriers.3dm --suggest=0
expect_error 2 coverage --batch list --suggest

# A limit ends the search, and the report says so.
coverage -q barriers.env barriers.3dm --suggest --time-limit 0s >told
has 'cut short: other changes' <told || fail "a cut is not told: $(cat told)"
! has 'no change' <told || fail "changes that were not tried do not help"
coverage -q barriers.env barriers.3dm --suggest --time-limit 0s --json | has '"suggestions_complete":false' ||
    fail "a cut is not told in JSON"
coverage -q barriers.env barriers.3dm --suggest --time-limit 1h >told
! has 'cut short' <told || fail "a whole search counts as cut"
expect_error 2 coverage barriers.env barriers.3dm --time-limit 1s

# Progress has shares and the time left; a signal ends the search, and the report has the suggestions so far.
arrange -q "$scenes/open-office.env" --sensor dome-2.8-1080p:6 --candidates 1,1,8 --optimize greedy -o domes.3dm
status=0
set -m  # a background job ignores INT unless it has job control
coverage "$scenes/open-office.env" domes.3dm --privacy meeting,recognise --suggest --report cut.html --progress \
    >told 2>said &
job=$!
set +m
until grep -q 'poses of sensors .* %' said; do
    kill -0 "$job" || fail "the search is over too soon: $(cat said)"
    sleep 0.02
done
kill -INT "$job"
wait "$job" || status=$?
[ "$status" -eq 130 ] || fail "status $status after SIGINT: $(cat said)"
has 'cut short: other changes' <told || fail "a signal is not told: $(cat told)"
grep -qi 'cut short: other changes' cut.html || fail "a signal is not told on the page"
