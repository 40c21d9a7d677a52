#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A newcomer in a checkout with a build: the lines of README.md that lead to the tools and to a copy of the scenes, and
# there the commands of "The pipeline" as they are written. tests/recipes runs the others.
. "$(dirname "$0")/../pipelines/common.sh"

mkdir checkout
for name in README.md lib share; do ln -s "$source_dir/$name" checkout; done
ln -s "$binary_dir" checkout/build
# lines AFTER: the first block of commands after this line of the page.
lines() {
    awk -v after="$1" 'index($0, after) == 1 { found = 1 } found && /^    / { inside = 1; print substr($0, 5) }
        inside && !/^    / { exit }' "$source_dir/README.md"
}
lines 'Without an installation' >first
lines '## The pipeline' >pipeline
[ "$(wc -l <first)" -eq 2 ] && [ "$(wc -l <pipeline)" -eq 5 ] || fail "other lines: $(cat first pipeline)"
# Bash 5.2 runs the last command of a file that a subshell reads in place of the subshell.
echo : >>first
PATH=/usr/bin:/bin
unset PYTHONPATH
(
    cd checkout
    . ../first
    [ "$(basename "$PWD")" = try ]
    . ../../pipeline
    python3 -B -c 'import ispace; assert ispace.info("room.glb").indoor_area > 1'
) >out 2>err || fail "$(cat out err)"
grep -q 'coverage 47.46%, bound 47.46% (proven best)' err || fail "another layout than the page shows: $(cat err)"
