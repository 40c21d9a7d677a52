#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The top of the repository holds only the entries of README and of common tools, and no file that a test or an editor
# left behind, committed or not.
. "$(dirname "$0")/../pipelines/common.sh"

git -C "$source_dir" rev-parse --git-dir >/dev/null 2>&1 || skip "no git, or no repository"
printf '%s\n' .ci .clang-format .clang-tidy .gitignore .reuse CHANGELOG.md CITATION.cff CMakeLists.txt \
    CONTRIBUTING.md Dockerfile LICENSE LICENSES Makefile README.md SECURITY.md docs lib packages.txt \
    share tests tools >expected

# Prints the other entries of the repository $1; skips files that git ignores.
strangers() {
    git -C "$1" ls-files --cached --others --exclude-standard | cut -d/ -f1 | LC_ALL=C sort -u | grep -vxFf expected || true
}
found=$(strangers "$source_dir")
[ -z "$found" ] || fail "at the top of the repository: $found"

# A pipe into grep -q fails by SIGPIPE at times: `has` of pipelines/common.sh is for that.
piped=$(git -C "$source_dir" grep -nE '[^|]\| *grep -[a-zA-Z]*q' -- 'tests/*.sh' 'lib/extensions/*.sh' ':!tests/structure' || true)
[ -z "$piped" ] || fail "grep -q at the end of a pipe: $piped"

# The test can fail.
git init -q small
mkdir small/lib
touch small/lib/a.cc small/room.glb
[ "$(strangers small)" = room.glb ] || fail "self-test: room.glb is not noticed"
