#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A long search that time or a signal ends has its best layout written, marked complete=no.
. "$(dirname "$0")/common.sh"

envc "$scenes/crowded.env" -o room.glb
# No machine proves the best of this in the time given.
long=(room.glb --sensor laser,range=4,fov=180:9 --candidates 0.15,0.15,32 --optimize exact --no-progress)

# is_whole FILE: nine lasers, a result that agrees with coverage and does not exceed its bound.
is_whole() {
    [ "$(grep -c '^laser ' "$1")" -eq 9 ] || fail "$1 has not nine lasers: $(cat "$1")"
    grep -q '^result .*complete=no' "$1" || fail "$1 is not marked: $(tail -n 1 "$1")"
    coverage room.glb "$1" --json >report.json
    python3 - "$1" <<'END' || fail "its result is not what coverage measures"
import json, re, sys
result = dict(re.findall(r"(\w+)=(\S+)", open(sys.argv[1]).read().splitlines()[-1]))
share = lambda key: float(result[key].rstrip("%")) / 100
assert abs(share("coverage") - json.load(open("report.json"))["coverage"]["grid"]) < 1e-12, result
assert share("coverage") <= share("bound") <= 1, result
END
}

expect_status 0 arrange "${long[@]}" --time-limit 2 -o limited.3dm
is_whole limited.3dm
grep -q 'cut short' err || fail "nobody says that time ended it: $(cat err)"

# A proof that ended before the limit stays one: the step that was cut short has a line to itself.
for limit in 0.3 0.6 1.2 2.4; do
    expect_status 0 arrange room.glb --sensor laser,range=4,fov=180:3 --candidates 0.5,0.5,8 --optimize exact \
        --refine --no-progress --time-limit "$limit" -o refined.3dm
    ! grep 'proven best.*cut short' err || fail "after $limit s both proven and cut short"
    ! grep -q 'complete=no' refined.3dm || grep -q 'cut short' err || fail "nobody says that time ended it: $(cat err)"
done

for signal in INT TERM; do
    echo old >best.3dm
    interrupt "$signal" 3 arrange "${long[@]}" -o best.3dm
    is_whole best.3dm
done

# The curve is written, too: without bounds for the numbers that were not searched.
interrupt INT 3 arrange "${long[@]}" --curve curve.csv -o best.3dm
is_whole best.3dm
[ "$(wc -l <curve.csv)" -eq 10 ] || fail "the curve has not nine points: $(cat curve.csv)"

# At once: writes the layout so far, or no file.
for delay in 0.02 0.1 0.2; do
    echo old >best.3dm
    interrupt TERM "$delay" arrange "${long[@]}" -o best.3dm
    [ "$(cat best.3dm)" = old ] || is_whole best.3dm
    ls best.3dm* | grep -v '^best.3dm$' && fail "left behind"
done
exit 0
