#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Each relative link of a Markdown page leads to a file, and each picture in docs/ is shown by a page.
. "$(dirname "$0")/../pipelines/common.sh"

# Prints PAGE: TARGET for each broken link in the tree $1.
broken() {
    (cd "$1" && find . \( -name 'build*' -o -name .git \) -prune -o -name '*.md' -print | LC_ALL=C sort |
        while read -r page; do
            grep -oE '\]\([^)#]+' "$page" | cut -c 3- | grep -v '^[a-z]*:' | while read -r target; do
                [ -e "$(dirname "$page")/$target" ] || echo "$page: $target"
            done || true
        done)
}
found=$(broken "$source_dir")
[ -z "$found" ] || fail "broken links: $found"
for picture in "$source_dir"/docs/*.png; do
    grep -qF "${picture##*/})" "$source_dir"/README.md "$source_dir"/docs/*.md || fail "no page shows $picture"
done

# The test can fail.
mkdir small
printf '[a](b.md) [b](a.md#top) [c](https://example.org)\n' >small/a.md
[ "$(broken small)" = "./a.md: b.md" ] || fail "self-test: the broken link is not reported: $(broken small)"
