#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The manual against the tools: the same options in both, the sections in order, and no complaint of
# groff; and docs/robots.md against the manual's table of programs. tests/recipes runs the examples.
. "$(dirname "$0")/../pipelines/common.sh"

pages=$binary_dir/share/man/man1
sections="NAME SYNOPSIS DESCRIPTION OPTIONS DIAGNOSTICS MEMORY USAGE EXAMPLES SEE ALSO"

# A page without the escapes and quotes of roff.
plain() { sed -e "s/[\\](aq/'/g" -e 's/\\-/-/g' -e 's/\\f[A-Z]//g' -e 's/\\e/\\/g' -e 's/"//g' "$1"; }

options_of_page() {
    plain "$1" | awk '/^\.SH / { inside = $2 == "OPTIONS" } inside && heading { print } { heading = /^\.T[PQ]/ }' |
        grep -oE -- '(^|[ ,])--?[A-Za-z][A-Za-z-]*' | tr -d ' ,' | LC_ALL=C sort
}

options_of_help() {
    grep -E '^  -' "$1" | sed -E 's/^(  -.{0,200}[^ ])   .*/\1/; s/^  //; s/  .*//' |
        grep -oE -- '(^|, )--?[A-Za-z][A-Za-z-]*' | tr -d ' ,' | LC_ALL=C sort
}

# Complaints of groff about a page go to groff.err. Lists of columns are lines without blanks, of which groff 1.23 tells
# that it cannot adjust them.
typeset_page() { groff -man -ww -z -Tutf8 "$1" 2>&1 | grep -vE 'warning.*: cannot adjust line$' >groff.err || true; }

programs="$tools golden-diff"
if /usr/bin/python3 -c 'import yaml' 2>/dev/null; then
    programs+=" ispace-sweep"
else
    echo "no python3-yaml: ispace-sweep does not run"
fi
for tool in $programs; do
    page=$pages/$tool.1
    "$tool" --help all >help
    options_of_help help >in_help
    options_of_page "$page" >in_page
    [ "$(wc -l <in_help)" -gt 6 ] || fail "no options found in $tool --help"
    diff in_help in_page || fail "$tool: options of --help (<) and of the man page (>) differ"
    # The test can fail: a page that lacks one option is noticed.
    sed 's/^\.B.*quiet.*/removed/' "$page" >without_quiet
    ! diff -q in_help <(options_of_page without_quiet) >/dev/null || fail "self-test: --quiet not missed"

    [ "$(plain "$page" | sed -n 's/^\.SH //p' | tr '\n' ' ')" = "$sections " ] ||
        fail "$tool: sections are not: $sections"
    ! grep -n '@[A-Z_]*@' "$page" || fail "$tool: text missing"
    if command -v groff >/dev/null; then
        typeset_page "$page"
        [ ! -s groff.err ] || fail "$tool: $(cat groff.err)"
    fi
done

# No name of an option breaks at the end of a line, and no word is hyphenated: names of topics and requests are words.
if command -v man >/dev/null; then
    # All three in UTF-8: elsewhere col drops the sign of hyphenation.
    broken() (
        export MANWIDTH=80 LC_ALL=C.UTF-8
        man -l "$1" 2>/dev/null | col -b | grep -nE -- '(^|[ [(])--?[a-z][a-z0-9-]*-$|‐$' || true
    )
    for page in "$binary_dir"/share/man/man*/*; do
        found=$(broken "$page")
        [ -z "$found" ] || fail "${page##*/}: $found"
    done
    grep -vE '^\.nh|^\.nr HY' "$pages/simrun.1" >hyphens.1
    [ -n "$(broken "$PWD/hyphens.1")" ] || fail "self-test: hyphens pass"
fi

# A build for `make demo` has both sections, too.
make -C "$source_dir" -n demo BUILD="$binary_dir" >demo
grep -q -- '--target tools manual$' demo || fail "make demo builds no manual: $(cat demo)"

# Section 5: every keyword and key that the tools know is there.
formats=$binary_dir/share/man/man5
for format in env 3dm yaml; do
    page=$formats/ispace-$format.5
    [ -s "$page" ] || fail "no page $page"
    ! grep -n '@[A-Z_]' "$page" || fail "ispace-$format: text missing"
    if command -v groff >/dev/null; then
        typeset_page "$page"
        [ ! -s groff.err ] || fail "ispace-$format: $(cat groff.err)"
    fi
done
keywords=$(printf '#env 1\nnothing\n' | { envc --to env 2>&1 >/dev/null || true; } | sed 's/.*known: //; s/,//g')
[ "$(wc -w <<<"$keywords")" -gt 20 ] || fail "no list of keywords: $keywords"
for keyword in $keywords; do
    grep -qx "\.SS $keyword" "$formats"/ispace-env.5 "$formats"/ispace-3dm.5 ||
        fail "the manual lacks the record $keyword"
done
grep -q '^\.BR sill= ' "$formats/ispace-env.5" || fail "the manual lacks keys"

# Section 7: every request of the server has a paragraph.
page=$binary_dir/share/man/man7/ispace-protocol.7
if command -v groff >/dev/null; then
    typeset_page "$page"
    [ ! -s groff.err ] || fail "ispace-protocol: $(cat groff.err)"
fi
verbs=$(sed -n 's/^ *{"\([A-Z]*\)", .*&C::.*/\1/p' "$source_dir"/lib/engine/server/session*.cc | sort -u)
[ "$(wc -w <<<"$verbs")" -gt 20 ] || fail "no list of requests: $verbs"
plain "$page" | grep -E -A 1 '^\.(SS|TP)|^(\.B.* )?(HELP|QUIT|TOKEN)\b|^\.B[RI]? (HELP|QUIT|TOKEN)' >heads
for verb in $verbs; do
    grep -qw -- "$verb" heads || fail "the manual lacks the request $verb"
done

# ispace-stability(7) lists every schema, and no other.
page=$binary_dir/share/man/man7/ispace-stability.7
if command -v groff >/dev/null; then
    typeset_page "$page"
    [ ! -s groff.err ] || fail "ispace-stability: $(cat groff.err)"
fi
promised() { plain "$1" | sed -n '/^\.SS JSON/,/^\.SS CSV/p' | sed -n 's/^\.B \(ispace-.*\/[0-9]*\|GeoJSON of .*\)$/\1/p' | LC_ALL=C sort; }
sed -n 's/^  "title": "\(.*\)",$/\1/p' "$binary_dir"/share/schemas/*.json | LC_ALL=C sort >schemas
[ "$(wc -l <schemas)" -eq "$(ls "$binary_dir"/share/schemas/*.json | wc -l)" ] || fail "titles of schemas: $(cat schemas)"
promised "$page" | diff schemas - || fail "schemas of the build (<) and ispace-stability (>) differ"
sed '/ispace.-scan/d' "$page" >without_scan
! promised without_scan | diff -q schemas - >/dev/null || fail "self-test: a schema that is not promised passes"

# Each program for real devices that docs/robots.md names has a row in ispace-wire's table of programs that were tried.
plain <(sed -n '/^\.SH PROGRAMS THAT WERE TRIED/,/^\.EE/p' "$source_dir/lib/extensions/wire/ispace-wire.7") >tried
sed -n '/^## Programs for real devices/,$s/^| `--[^|]*|[^|]*|\(.*\)|$/\1/p' "$source_dir/docs/robots.md" |
    sed 's/`[^`]*`//g' | grep -oE '[[:alpha:]][[:alnum:]_]*' | grep -vxE 'ROS|s|driver|a|few|lines|of' >named
[ "$(wc -l <named)" -gt 9 ] || fail "no programs found in docs/robots.md: $(cat named)"
while read -r program; do
    grep -qw -- "$program" tried || fail "docs/robots.md names $program, which ispace-wire(7) does not list as tried"
done <named
