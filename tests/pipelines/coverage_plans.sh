#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sensors anywhere in real maps and plans, two thousand each, on walls and on their corners, too:
# each is measured, and cells and closed forms agree. ISPACE_TEST_DATA names the folder.
. "$(dirname "$0")/common.sh"

[ -n "${ISPACE_TEST_DATA:-}" ] || skip "ISPACE_TEST_DATA names no folder of real maps"
[ -d "$ISPACE_TEST_DATA/plans" ] || skip "no $ISPACE_TEST_DATA/plans"

# Visibility from points, whole and within ranges, beside CGAL's exact answer.
"$ISPACE_BINARY_DIR/tests/visibility_bench" --check "$ISPACE_TEST_DATA" >looks.txt
cat looks.txt
[ "$(grep -c '10000 looks' looks.txt)" -ge 7 ] || fail "less than seven plans were looked at"

# Batches of 1 000, so that one run has them all over each other.
cat >sensors.py <<'END'
import json, random, sys
plan, batch = json.load(open("slice.geojson")), int(sys.argv[1])
lines = []
for feature in plan["features"]:
    geometry = feature["geometry"]
    if geometry["type"] == "LineString":
        lines.append(geometry["coordinates"])
    elif geometry["type"] == "Polygon":
        lines.extend(geometry["coordinates"])
x0, y0, x1, y1 = json.load(open("info.json"))["limits"]
rng = random.Random(batch)
print("#3dm 1")
for i in range(1000):
    place = rng.uniform(x0, x1), rng.uniform(y0, y1)
    if i % 4 < 2:
        chain = rng.choice(lines)
        k = rng.randrange(len(chain) - 1)
        a, b, t = chain[k], chain[k + 1], rng.random() if i % 4 == 0 else 0
        place = a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])
    reach = 30 if i % 200 == 0 else rng.uniform(0.05, 1)
    print(f"laser at={place[0]!r},{place[1]!r} heading={rng.uniform(-180, 180)}"
          f" range={reach} fov={rng.choice([1, 90, 180, 240, 360])} step=1")
END
cat >judge.py <<'END'
import json, math
report = json.load(open("report.json"))
assert report["exact_missing"] is None
assert len(report["sensors"]) == 1000
x0, y0, x1, y1 = report["limits"]
cell = math.hypot((x1 - x0) / report["grid"][0], (y1 - y0) / report["grid"][1])
for s in report["sensors"]:
    exact, alone = s["area"]["exact"], s["marginal"]["exact"]
    assert 0 <= exact <= math.pi * 900 + 1e-6, s
    assert 0 <= alone <= exact + 1e-6, s
    # Cells are only there within the limits, so they may be fewer, but hardly more.
    assert s["area"]["grid"] <= exact + 60 * cell * math.sqrt(exact) + 10 * cell * cell, s
shares = report["redundancy_exact"]
assert abs(sum(shares) - 1) < 1e-6, sum(shares)
assert abs(report["coverage"]["exact"] - report["coverage"]["grid"]) < 0.02, report["coverage"]
assert abs(report["coverage"]["exact"] - (1 - shares[0])) < 1e-9
END
for plan in turtlebot3.yaml willow-full.yaml \
    plans/{he_0a1b29db_raw,syn_03,syn_10,syn_15,syn_20}.json; do
    envc "$ISPACE_TEST_DATA/$plan" -o room.glb
    envc room.glb --info --json >info.json
    envc room.glb --slice 0.15 -o slice.geojson
    for batch in 1 2; do
        python3 sensors.py $batch >layout.3dm
        coverage -q room.glb layout.3dm --grid 200 --json >report.json || fail "$plan, batch $batch"
        python3 judge.py || fail "$plan, batch $batch"
    done
    echo "$plan: coverage of 2000 sensors measured"
done
