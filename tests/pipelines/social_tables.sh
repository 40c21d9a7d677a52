#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# docs/judging.md has the tables and the digest that share/benchmarks/social/run.py prints, and every baseline is judged in
# every scene with five seeds.
. "$(dirname "$0")/common.sh"

grep -q "ISPACE_SANITIZE:[A-Z]*=OFF" "$binary_dir/CMakeCache.txt" || skip "instrumented"
[ -x "$binary_dir/examples/social_planner" ] || skip "no social_planner"
/usr/bin/python3 "$source_dir/share/benchmarks/social/run.py" --build "$binary_dir" -o results >summary 2>err ||
    fail "$(cat err)"
[ "$(wc -l <results/results.jsonl)" -eq 300 ] || fail "not 300 runs"
page=$source_dir/docs/judging.md
while IFS= read -r line; do
    grep -qxF -- "$line" "$page" || fail "docs/judging.md lacks the line: $line"
done < <(grep '^|' summary)
digest=$(sed -n 's/^Digest of results.jsonl: //p' summary)
grep -qF -- "$digest" "$page" || fail "docs/judging.md lacks the digest $digest"
