#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every source says its licence itself, and every other file has one by .reuse/dep5 (https://reuse.software).
. "$(dirname "$0")/../pipelines/common.sh"

git -C "$source_dir" rev-parse --git-dir >/dev/null 2>&1 || skip "no git, or no repository"

# Sources without a licence in the repository $1.
silent() {
    (cd "$1" && git ls-files -z --cached --others --exclude-standard -- '*.cc' '*.h' '*.cpp' '*.py' '*.sh' '*.js' \
        '*.awk' '*.cmake' '*CMakeLists.txt' Makefile Dockerfile '.ci/*' 'share/man/*.[157]' ':!.ci/debian/[!r]*' |
        xargs -0 -r grep -L 'SPDX-License-Identifie[r]: ' || true)
}
found=$(silent "$source_dir")
[ -z "$found" ] || fail "no licence is named in: $found"
git init -q small
echo 'int x;' >small/a.cc
[ "$(silent small)" = a.cc ] || fail "self-test: a.cc is not noticed"

command -v reuse >/dev/null || { echo "no reuse here: only sources are checked"; exit 0; }
reuse --root "$source_dir" lint >lint 2>&1 || fail "$(grep -v '^$' lint)"
printf '// %s MIT\n' SPDX-License-Identifier: >small/a.cc
cp -r "$source_dir/.reuse" "$source_dir/LICENSE" "$source_dir/LICENSES" small
! reuse --root small lint >lint 2>&1 || fail "self-test: a licence that is not in LICENSES is not noticed"
