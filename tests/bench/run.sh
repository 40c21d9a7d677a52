#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD: runs every benchmark; the figures also go to BUILD/bench/*.json, and their tables to BUILD/bench/*.csv.
set -euo pipefail
build=$1
mkdir -p "$build/bench"
# For the scenes and poses that benchmarks make, and remove.
TMPDIR=$(cd "$build/bench" && pwd)
export TMPDIR
rm -f "$build"/bench/*.json "$build"/bench/*.csv
failed=
for program in start planner days kernel plan load ray_rate sight_scan depth_rate render_rate scan_rate server_rate sim_rate vector visibility \
    union coverage set_cover gallery poses arrange; do
    [ -x "$build/tests/${program}_bench" ] || continue  # of an extension that is not built
    "$build/tests/${program}_bench" --benchmark_out="$build/bench/$program.json" \
        --benchmark_out_format=json || failed+=" $program"
done
python3 "$(dirname "$0")/tables.py" "$build/bench"

/usr/bin/python3 "$(dirname "$0")/latency.py" "$build" --csv "$build/bench/latency.csv"

# Clipper 2 is in npm alone.
if [ -d "$build/npm/node_modules/clipper2-wasm" ] && command -v node >/dev/null; then
    outlines=$(mktemp -d)
    trap 'rm -rf "$outlines"' EXIT
    "$build/tests/union_bench" --write "$outlines"
    NODE_PATH="$build/npm/node_modules" node "$(dirname "$0")/clipper2_union.js" "$outlines"
else
    echo "bench: no unions by Clipper 2 here, it takes node and npm" >&2
fi

[ -z "$failed" ] || { echo "bench: these miss a goal or a check:$failed" >&2; exit 1; }
