#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/ci.sh passes, writes its files, and fails with a failing run.
. "$(dirname "$0")/common.sh"

example=$source_dir/share/examples/ci.sh
sh "$example" "$scratch/ci" >out || fail "status $?: $(cat out)"
grep -q '^robot r1 ' out || fail "no second valuation: $(cat out)"
for file in junit.xml ways.png seen.png seen.json run/robots.csv; do
    [ -s "$scratch/ci/$file" ] || fail "no $file"
done
grep -q 'tests="4" failures="0"' "$scratch/ci/junit.xml" || fail "$(cat "$scratch/ci/junit.xml")"
python3 "$source_dir/tests/schemas/junit.py" "$scratch/ci/junit.xml" || fail "not the XML that servers read"

# The test can fail: a robot that should have been elsewhere.
mkdir -p share/examples
cp "$example" "$source_dir/share/examples/drive.txt" share/examples
cp -r "$scenes" share/scenes
sed -i 's/of 0.5,-1.9/of 2,2/' share/examples/ci.sh
status=0
sh share/examples/ci.sh "$scratch/bad" >out 2>err || status=$?
[ "$status" = 3 ] || fail "status $status instead of 3"
grep -q 'came no nearer than' err || fail "$(cat err)"
grep -q 'failures="1"' "$scratch/bad/junit.xml" || fail "$(cat "$scratch/bad/junit.xml")"
[ -s "$scratch/bad/ways.png" ] || fail "no picture of what went wrong"
