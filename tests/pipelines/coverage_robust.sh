#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# coverage --perturb, --failures and --crowd: figures under errors of mounting, without sensors, and among people.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

cp "$scenes"/* . 2>/dev/null || true

# told FIGURE MEMBER: prints a member of a figure's entry in told.json, under the member $part.
told() {
    python3 - "$part" "$1" "$2" <<'END'
import json, sys
part, name, member = sys.argv[1:]
figures = json.load(open("told.json"))[part]["figures"]
print(next(one for one in figures if one["figure"] == name)[member])
END
}

# same A B: compares numbers.
same() { python3 -c "import sys; sys.exit(abs($1 - ($2)) > 1e-9)" || fail "$1 is not $2"; }

# The worst failure is the coverage of the layout without that sensor, and the least of all.
coverage barriers.env barriers.3dm --failures 1 --json >told.json
part=failures
worst=$(told coverage worst)
least=1
for id in left right; do
    envc barriers.3dm --delete "$id" --to 3dm -q -o less.3dm
    share=$(coverage barriers.env less.3dm -q --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["coverage"]["exact"])')
    least=$(python3 -c "print(min($least, $share))")
done
same "$worst" "$least"

# People of the scene are cylinders of 0.3 times their height as width.
coverage crowded.env walkers.3dm --crowd scene --json >told.json
part=crowd
envc crowded.env walkers.3dm -q -o whole.env
python3 - <<'END'
import re
lines = [line for line in open("whole.env").read().splitlines() if line.startswith("human ")]
with open("people.3dm", "w") as out:
    out.write("#3dm 1\n")
    for line in lines:
        at = re.search(r" at=(\S+)", line)[1]
        height = re.search(r" height=(\S+)", line)
        height = float(height[1]) if height else 1.7
        out.write(f"cylinder at={at} size={0.3 * height},{0.3 * height},{height}\n")
assert lines
END
grep -v '^#3dm' walkers.3dm >>people.3dm
share=$(coverage crowded.env people.3dm -q --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["coverage"]["exact"])')
same "$(told coverage mean)" "$share"

# A free way: as planned, without error.
coverage barriers.env barriers.3dm --crowd 0 --json >told.json
same "$(told coverage mean)" "$(told coverage planned)"
same "$(told coverage error)" 0

# The same bytes on any number of threads; another seed draws others; each form of report has the tables.
all=(barriers.env barriers.3dm --perturb 5cm,3deg --failures 2 --crowd 3 --cell 0.5)
coverage "${all[@]}" -j 1 >one
coverage "${all[@]}" -j 5 >five
expect_same one five "robustness depends on the threads"
coverage "${all[@]}" --seed 1 >other
cmp -s one other && fail "another seed changes no figure"
has '^mounted within 0.05 m and 3 degrees, 100 times:' <one || fail "no mountings"
has '^if any 2 sensors fail:' <one || fail "no failures"
has '^with 3 people at random, 100 times:' <one || fail "no crowd"
expect_status 3 coverage "${all[@]}" --require 90% --report told.html
has 'Required 90% is met by 0 of 100 mountings' <told.html || fail "no requirement in the report"

# People of a recorded run.
simrun crowded.env walkers.3dm --clock fast --until 1 --record run -q
coverage --run run --crowd run --json >told.json
[ "$(told coverage exact)" = True ] || fail "figures of a run are not exact"

expect_error 2 coverage barriers.env barriers.3dm --crowd run
expect_error 2 coverage barriers.env barriers.3dm --crowd some
expect_error 2 coverage barriers.env barriers.3dm --perturb 5cm
expect_error 2 coverage barriers.env barriers.3dm --failures 0
expect_error 2 coverage --batch list --failures 1
