#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD: runs every benchmark; the figures also go to BUILD/bench, as *.json, and as a *.csv for each table, in place
# of those of earlier runs. Exit status 1: a benchmark failed, as they do where a result is wrong; the others still run.
set -euo pipefail
build=$1
here=$(dirname "$0")
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
python3 "$here/tables.py" "$build/bench" || failed+=" tables.py"
/usr/bin/python3 "$here/latency.py" "$build" --csv "$build/bench/latency.csv" || failed+=" latency.py"

# Clipper 2 is in npm alone.
if [ -d "$build/npm/node_modules/clipper2-wasm" ] && command -v node >/dev/null; then
    outlines=$(mktemp -d)
    trap 'rm -rf "$outlines"' EXIT
    "$build/tests/union_bench" --write "$outlines" &&
        NODE_PATH="$build/npm/node_modules" node "$here/clipper2_union.js" "$outlines" || failed+=" clipper2_union.js"
else
    echo "bench: no unions by Clipper 2 here, it takes node and npm" >&2
fi

[ -z "$failed" ] || { echo "bench: these failed:$failed" >&2; exit 1; }
