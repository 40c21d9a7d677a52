#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# `ispace TOOL` runs the tool of its installation, with its streams and status; its help and its manual agree.
. "$(dirname "$0")/common.sh"

for tool in $tools; do
    [ "$(ispace "$tool" --version)" = "$("$tool" --version)" ] || fail "ispace $tool is another tool"
    # The summary is that of the manual page, which names ispace, too, for apropos.
    summary=$(sed -n "s/^$tool \\\\- \(.*\) (ispace)$/\1/p" "$binary_dir/share/man/man1/$tool.1")
    ispace --help | has -x "  $tool *$summary" || fail "ispace --help says otherwise of $tool than: $summary"
done
[ "$(ispace --help | sed -n '/^Tools:/,/^$/p' | grep -c '^  ')" -eq "$(wc -w <<<"$tools")" ] || fail "$(ispace --help)"
ispace --version | has -x "ispace $(sed -n 's/^project(ispace VERSION \([^ ]*\).*/\1/p' "$source_dir/CMakeLists.txt")" ||
    fail "$(ispace --version)"

# Streams and status are the tool's.
ispace envc "$data/room.env" --to env | ispace envc --info | has 'indoor area' || fail "no pipe"
expect_status 3 ispace coverage "$scenes/ispace.env" "$scenes/ispace.3dm" --require 100%
expect_status 2 ispace scan --bogus
one_error scan "ispace scan --bogus"
expect_status 1 ispace envc /nonexistent/room.env
one_error envc "ispace envc /nonexistent/room.env"

# Errors come with a hint.
expect_error 2 ispace
expect_error 2 ispace scna
grep -q 'unknown tool `scna`, did you mean `scan`?' err || fail "$(cat err)"
expect_error 2 ispace --bogus
expect_error 2 ispace --help scan
expect_error 2 ispace help scan coverage
expect_error 2 ispace help ../man1/scan
expect_error 2 ispace help ''
expect_error 2 ispace ''
expect_error 2 ispace $'sc\nan'
expect_status 1 sh -c 'ispace --help >/dev/full'

# Every program writes its errors as JSON on request, and its version.
programs="$tools ispace golden-diff"
! /usr/bin/python3 -c 'import yaml' 2>/dev/null || programs+=" ispace-sweep"
for program in $programs; do
    expect_status 2 "$program" --errors json --bogus
    [ "$(wc -l <err)" -eq 1 ] && has "^{\"schema\":\"ispace-message/1\",\"tool\":\"$program\",.*\"severity\":\"error\",\"status\":2,.*}$" <err ||
        fail "$program: $(cat err)"
    "$program" --version --json | has "^{\"schema\":\"ispace-version/1\",\"tool\":\"$program\"," || fail "$program: no version"
done
expect_status 2 ispace --errors json scan --bogus
has '"tool":"scan"' <err || fail "ispace --errors json scan: $(cat err)"
expect_status 2 ispace --errors yaml scan

# The page is the one of this installation, by a man that is in PATH.
mkdir bin
printf '#!/bin/sh\necho "$@"\n' >bin/man
chmod +x bin/man
for page in ispace:man1/ispace.1 scan:man1/scan.1 env:man5/ispace-env.5 ispace-3dm:man5/ispace-3dm.5 wire:man7/ispace-wire.7; do
    [ "$(PATH=$PWD/bin:$PATH ispace help "${page%:*}")" = "$binary_dir/share/man/${page#*:}" ] || fail "another page: $page"
done
[ "$(PATH=$PWD/bin:$PATH ispace help)" = "$binary_dir/share/man/man1/ispace.1" ] || fail "no page of ispace itself"
mkdir empty
status=0
PATH=$PWD/empty "$binary_dir/bin/ispace" help scan 2>err || status=$?
[ "$status" -eq 1 ] && grep -q 'man is not installed (Debian: man-db)' err || fail "status $status: $(cat err)"

# All tools are one program, which links in any folder call; they find their files beside it.
for tool in $tools golden-diff; do
    [ "$binary_dir/bin/$tool" -ef "$binary_dir/bin/ispace" ] || fail "$tool is another program than ispace"
done
mkdir -p usr/bin usr/lib/ispace/bin usr/share
cp "$binary_dir/bin/ispace" usr/bin
ln -s ../../../bin/ispace usr/lib/ispace/bin/scan
ln -s ../lib/ispace/bin/scan usr/bin/scan
ln -s "$source_dir/share" usr/share/ispace
for scan in "usr/bin/ispace scan" usr/lib/ispace/bin/scan usr/bin/scan; do
    $scan --list-models | has urg-04lx || fail "no devices by $scan"
done
(PATH=$PWD/usr/bin && scan --version) | has '^scan ' || fail "not found in PATH"
# A copy is a tool by its name, or else asks for one.
cp -L "$binary_dir/bin/scan" usr/bin/my-scan
expect_status 2 usr/bin/my-scan
grep -q 'which tool? (see ispace --help)' err || fail "$(cat err)"
cp -L "$binary_dir/bin/scan" usr/lib/ispace/bin/envc
usr/lib/ispace/bin/envc --version | has '^envc ' || fail "no copy by another name"

# Help and page name the same options; the page's example runs.
page=$binary_dir/share/man/man1/ispace.1
for option in $(ispace --help | grep -oE -- '^  -.*  ' | tr ' ,' '\n\n' | grep '^-'); do
    grep -qF -- "${option//-/\\-}" "$page" || fail "the page lacks $option"
done
cp "$scenes/crowded.env" .
sed -n '/^\.EX/,/^\.EE/p' "$page" | sed -e '/^\./d' -e 's/\\-/-/g' >example.sh
bash -euo pipefail example.sh >out 2>err || fail "an example fails: $(cat err)"
