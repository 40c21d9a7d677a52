#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# People follow their days through the flat of share/examples: activities in order, with ways round walls and shut doors,
# states of sensors beside them; the same for any number of threads, and read by the example's Python.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

home=$source_dir/share/examples/home
run() { simrun "$home/flat.env" "$home/flat.3dm" -q --clock fast --dt 1 "$@" >/dev/null 2>err; }
run --script "$home/week.txt" --until 31h --record one --threads 1 || fail "no run: $(cat err)"
[ ! -s err ] || fail "simrun: $(cat err)"
run --script "$home/week.txt" --until 31h --record two --threads 2 || fail "no run: $(cat err)"
for file in states activities events people; do cmp "one/$file.csv" "two/$file.csv" || fail "$file differs"; done

python3 - "$home/flat.env" <<'END_OF_CHECK' || fail "activities"
import csv, sys
rows = list(csv.DictReader(open("one/activities.csv", newline="")))
states = list(csv.DictReader(open("one/states.csv", newline="")))
by_person = {}
for row in rows:
    begin, end = float(row["begin"]), float(row["end"])
    assert begin <= end, row
    last = by_person.setdefault(row["id"], [])
    assert not last or last[-1] <= begin, row  # one after another
    last.append(end)
assert set(by_person) == {"ann", "ben", "cai", "dee"}, by_person
took = {(row["id"], row["action"]): float(row["end"]) - float(row["begin"]) for row in rows if float(row["begin"]) < 86400}
assert 240 <= took["ann", "uses toilet 4min"] < 270, took   # the way and four minutes
assert 23400 <= float(rows[0]["begin"]) < 23403, rows[0]     # 06:30
assert took["ben", "goes porch"] > 3
def changes(id, state):
    return [(float(row["t"]), row["value"]) for row in states if (row["id"], row["state"]) == (id, state)]
# Ben opens the front door, goes, and shuts it; the contact tells both.
doors = changes("front", "open")
assert [value for _, value in doors] == ["1", "0"] * 2, doors
assert [value for _, value in changes("d-front", "open")] == ["1", "0"] * 2
assert [value for _, value in changes("kitchen-lamp", "on")][:2] == ["1", "0"]
leaves, shuts = doors[0][0], doors[1][0]
assert leaves < shuts < leaves + 60
seen = [t for t, value in changes("m-hall-south", "motion") if value == "1"]
assert any(leaves - 30 < t < shuts + 5 for t in seen), seen
assert not [t for t, value in changes("m-kitchen-door", "motion") if t < 23400], "nobody moves at night"
# Whoever uses a thing is beside it all the time, on its side of the walls.
import bisect, math
boxes = {}
for line in open(sys.argv[1]):
    words = line.split()
    keys = dict(word.split("=", 1) for word in words if "=" in word)
    if words and words[0] in ("cube", "desk", "table") and "at" in keys:
        size = [float(part) for part in keys.get("size", "1.2,1.2").split(",")]
        boxes[keys["id"]] = [*map(float, keys["at"].split(",")), size[0] / 2, size[1] / 2]
def room_of(x, y):
    if x < 4: return "living" if y < 4.5 else "bedroom"
    if x < 6: return "hall"
    return "kitchen" if y < 3 else "bath" if y < 5.5 else "child"
walks = {}
for row in csv.DictReader(open("one/people.csv", newline="")):
    walks.setdefault(row["id"], []).append((float(row["t"]), float(row["x"]), float(row["y"])))
used = 0
for row in rows:
    verb, *rest = row["action"].split()
    if verb != "uses" or row["done"] != "1": continue
    used += 1
    x, y, length, width = boxes[rest[0]]
    lasts = float(rest[1].rstrip("minh")) * (3600 if rest[1].endswith("h") else 60)
    walk = walks[row["id"]]
    first = bisect.bisect_right(walk, (float(row["end"]) - lasts + 1.5,)) - 1
    last = bisect.bisect_right(walk, (float(row["end"]),)) - 1
    for t, px, py in walk[max(first, 0):last + 1]:
        away = math.hypot(max(0, abs(px - x) - length), max(0, abs(py - y) - width))
        assert away <= 0.6 and room_of(px, py) == room_of(x, y), (row, t, px, py, away)
assert used >= 25, used
END_OF_CHECK
# The recogniser of the example, over two days: nine of forty-five actions are mistaken.
run --script "$home/week.txt" --until 48h --record two_days --no-record-readings || fail "no run: $(cat err)"
"$home/read_week.py" two_days >said || fail "the example: $(cat said)"
share=$(sed -n 's/.* \([0-9]*\) % of 45 actions recognised$/\1/p' said)
((${share:-0} >= 75)) || fail "the example prints $(cat said)"
if "$home/read_week.py" 2>err; then fail "a recogniser without a record"; fi
grep -q '^usage: read_week.py' err || fail "no usage: $(cat err)"

# Mistakes in a plan.
bad() {
    printf '%s\n' "$1" >bad.txt
    expect_error 1 simrun "$home/flat.env" "$home/flat.3dm" --script bad.txt --until 1
    grep -qF -- "$2" err || fail "$1: $(cat err)"
}
bad 'at 7:30 ann goes bath' 'bad.txt:1:4: error: `7:30` is no time of a day'
bad 'at 0 07:30 ann goes bath' 'is no time, wanted HH:MM'
bad 'daily 07:30 anne goes bath' 'no person has the id `anne`, did you mean `ann`?'
bad 'daily 07:30 ann goes bat' 'did you mean `bath`?'
bad 'daily 07:30 ann uses kettle' 'wanted one like uses kettle 3min'
bad 'daily 07:30 ann uses kettle soon' 'is no duration'
bad 'daily 07:30 ann opens kettle' 'kettle is a cube, which has no state'
bad 'daily 07:30 ann sleeps bed 8h' '`sleeps` is no action'
bad 'daily 07:30 ann cook,"eat: goes bath' 'bad.txt:1:17: error: `cook,"eat` is no name of an activity'
bad 'daily 07:30 ann tea:' 'an action is missing'
bad 'daily' 'is no time of a day'
