#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# .ci/prose counts words in the comments of each kind of file, fails above a limit, and rejects ceilings that rise.
. "$(dirname "$0")/../pipelines/common.sh"

command -v git >/dev/null || skip "no git here"
prose=$source_dir/.ci/prose

# tree TEXT…: creates a repository with TEXT as its only comment.
tree() {
    rm -rf tree
    mkdir -p tree/.ci
    git -C tree init -q
    echo "// $*" >tree/a.h
}
commit() { git -C tree add -A && git -C tree -c user.name=a -c user.email=a@b commit -qm c; }
passes() { "$prose" tree >out 2>err || fail "$1: $(cat out err)"; }
fails() { if "$prose" tree >out 2>err; then fail "passes: $1: $(cat out)"; fi; }

tree "Computes the area, returns the pose"
passes "two verbs in six words"
for text in "Computes what is returned" "Returns who reads" "Returns its place" "Returns nothing" "The area of a polygon"; do
    tree "$text"
    fails "$text"
done
# Each kind of file counts, code does not.
for case in 'b.cc|int x; // what' 'b.sh|x # what' 'b.py|# what' 'b.1|.TP\nwhat' 'b.md|what' 'CMakeLists.txt|# what' \
        'site/b.h|// what'; do
    tree "Computes the area, returns the pose"
    mkdir -p tree/site
    printf "${case#*|}\n" >"tree/${case%%|*}"
    fails "$case"
done
for case in 'b.cc|int what;' 'b.sh|what' 'b.md|    what' 'b.txt|what' 'build/b.h|// what' 'build-lint/b.h|// what'; do
    tree "Computes the area, returns the pose"
    mkdir -p tree/build tree/build-lint
    printf "${case#*|}\n" >"tree/${case%%|*}"
    passes "$case"
done

# A ceiling permits the rate of today, and no higher one; it may fall, and not rise again.
tree "Computes what it returns"
"$prose" --lower tree >out 2>err || fail "--lower: $(cat err)"
[ "$(grep -v "^#" tree/.ci/prose-ceilings)" = "what 250" ] || fail "ceilings: $(cat tree/.ci/prose-ceilings)"
commit
passes "at the ceiling"
echo "// Computes what" >tree/a.h
fails "above the ceiling"
echo "// Computes what it returns" >tree/a.h
echo "what 300" >tree/.ci/prose-ceilings
fails "a ceiling that rises"
grep -q 'moves from 250 to 300' err || fail "$(cat err)"
echo "// Computes what it returns and stores today" >tree/a.h
"$prose" --lower tree >out 2>err || fail "--lower: $(cat err)"
[ "$(grep -v "^#" tree/.ci/prose-ceilings)" = "what 142.9" ] || fail "ceilings: $(cat tree/.ci/prose-ceilings)"
