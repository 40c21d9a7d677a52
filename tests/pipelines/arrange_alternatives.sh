#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# arrange --alternatives: layouts beside the best one that differ by a metre or 30 degrees in some sensor.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

job=("$scenes/ispace.env" --sensor laser,range=4,fov=180:2 --candidates 1,1,8 --optimize exact)
arrange "${job[@]}" -o plain.3dm 2>/dev/null
arrange "${job[@]}" --alternatives 3 -o best.3dm --report best.html 2>err
expect_same plain.3dm best.3dm "alternatives change the layout"
[ "$(grep -c '^arrange: best-[234].3dm: value .*, gap .*, coverage ' err)" -eq 3 ] || fail "no three lines: $(cat err)"
has 'best-4.3dm' <best.html || fail "no alternatives in the report"

# Each differs from all before it; the values fall, and coverage(1) reports those of the results.
python3 - <<'END' || fail "alternatives are not as promised"
import math, re, subprocess, json

def layout(file):
    text = open(file).read()
    sensors = []
    for line in text.splitlines():
        if line.startswith("laser "):
            at = [float(x) for x in re.search(r" at=(\S+)", line)[1].split(",")]
            heading = re.search(r" heading=(\S+)", line)
            sensors.append((at, float(heading[1]) if heading else 0.0))
    return sensors, float(re.search(r" coverage=([\d.]+)%", text)[1]) / 100

def near(a, b):
    turned = abs((a[1] - b[1] + 180) % 360 - 180)
    return math.dist(a[0], b[0]) < 1 and turned < 30

layouts = [layout("best.3dm")] + [layout(f"best-{k}.3dm") for k in (2, 3, 4)]
for k, (sensors, share) in enumerate(layouts):
    assert len(sensors) == 2
    for other, _ in layouts[:k]:
        assert any(not any(near(a, b) for b in sensors) for a in other), k
    assert share <= layouts[0][1] + 1e-9
    name = "best.3dm" if k == 0 else f"best-{k + 1}.3dm"
    told = json.loads(subprocess.check_output(["coverage", name, "-q", "--json"]))
    assert abs(told["coverage"]["grid"] - share) < 1e-9, name
END

# A map of gains for each sensor.
arrange "${job[@]}" --heat heat.svg -q -o best.3dm
has 'gain of laser., after 0 placed' <heat.svg || fail "no map of the first sensor"
has 'gain of laser., after 1 placed' <heat-2.svg || fail "no map of the second sensor"
[ ! -e heat-3.svg ] || fail "a third map"
expect_error 2 arrange "${job[@]}" --heat heat.jpg -o x.3dm

# The same bytes on any number of threads.
mkdir one five
arrange "${job[@]}" --alternatives 2 -j 1 -q -o one/best.3dm
arrange "${job[@]}" --alternatives 2 -j 5 -q -o five/best.3dm
for file in best.3dm best-2.3dm best-3.3dm; do
    expect_same one/$file five/$file "alternatives depend on the threads"
done

expect_error 2 arrange "${job[@]}" --alternatives 2
expect_error 2 arrange "${job[@]}" --alternatives 2 --target 50% -o x.3dm
expect_error 2 arrange "${job[@]}" --alternatives 0 -o x.3dm
expect_error 2 arrange "${job[@]}" --alternatives 2 --shard 1/2 -o x.part
