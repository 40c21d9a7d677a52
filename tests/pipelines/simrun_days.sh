#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# People follow their days through the flat of share/examples: activities in order, with ways round walls and shut doors,
# states of sensors beside them; the same for any number of threads, and read by the example's Python.
. "$(dirname "$0")/common.sh"

home=$source_dir/share/examples/home
run() { simrun "$home/flat.env" "$home/flat.3dm" -q --clock fast --dt 1 "$@" >/dev/null 2>err; }
run --script "$home/week.txt" --until 31h --record one --threads 1 || fail "no run: $(cat err)"
[ ! -s err ] || fail "simrun: $(cat err)"
run --script "$home/week.txt" --until 31h --record two --threads 2 || fail "no run: $(cat err)"
for file in states activities events people; do cmp "one/$file.csv" "two/$file.csv" || fail "$file differs"; done

python3 - <<'END_OF_CHECK' || fail "activities"
import csv
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
END_OF_CHECK
"$home/read_week.py" one >said || fail "the example: $(cat said)"
grep -q 'actions recognised$' said || fail "the example prints $(cat said)"

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
