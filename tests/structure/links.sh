#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Each relative link of a Markdown page leads to a file, each picture in docs/ is shown by a page, and another page links
# each page there.
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
# Prints each page below docs/ of the tree $1 that no other page links.
lonely() {
    (cd "$1" && find docs -name '*.md' | LC_ALL=C sort | while read -r page; do
        grep -lF "${page#docs/})" README.md CHANGELOG.md docs/*.md | grep -qvx "$page" || echo "$page"
    done)
}
found=$(lonely "$source_dir")
[ -z "$found" ] || fail "no page links: $found"

# The test can fail.
mkdir small
printf '[a](b.md) [b](a.md#top) [c](https://example.org)\n' >small/a.md
[ "$(broken small)" = "./a.md: b.md" ] || fail "self-test: the broken link is not reported: $(broken small)"
mkdir small/docs
printf '[itself](c.md)\n' >small/docs/c.md
printf '[c](docs/d.md)\n' | tee small/README.md >small/CHANGELOG.md
echo d >small/docs/d.md
[ "$(lonely small)" = docs/c.md ] || fail "self-test: the page without links is not reported: $(lonely small)"
