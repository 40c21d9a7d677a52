#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Empty input, missing file, folder as a file, bad options: the same manners in every tool.
. "$(dirname "$0")/common.sh"

: >empty
mkdir folder
placed=(--sensor laser --strategy grid)

for tool in $tools; do
    extra=()
    [ "$tool" = arrange ] && extra=("${placed[@]}")
    expect_error 1 "$tool" empty "${extra[@]}"
    expect_error 1 "$tool" missing.env "${extra[@]}"
    grep -q 'missing.env' err || fail "$tool does not name the missing file: $(cat err)"
    expect_error 1 "$tool" folder "${extra[@]}"
    expect_error 2 "$tool" "$data/room.env" --no-such-option
    expect_error 2 "$tool" "$data/room.env" --threads many
    expect_error 2 "$tool" "$data/room.env" --threads -1
    expect_error 2 "$tool" "$data/room.env" --output
    # A suffix that no format has is a slip, whatever else it may be the suffix of.
    for suffix in bag dwg foo; do
        [ "$tool" = simrun ] && continue # has no -o
        expect_error 2 "$tool" "$data/room.env" "${extra[@]}" -o "out.$suffix"
        grep -q "suffix .\.$suffix., wanted \." err || fail "$tool does not name formats: $(cat err)"
    done
    expect_error 2 "$tool" - - "${extra[@]}"
    grep -q 'stdin cannot be read twice' err || fail "$tool reads stdin twice: $(cat err)"
    # envc joins any number of inputs.
    [ "$tool" = envc ] || expect_error 2 "$tool" a.env b.3dm c.env "${extra[@]}"

    expect_status 0 "$tool" --version
    grep -qx "$tool (ispace) [0-9.]*" <(head -n 1 out) || fail "$tool --version: $(cat out)"
    expect_status 0 "$tool" -h
    mv out short
    expect_status 0 "$tool" --help
    expect_same short out "$tool: -h and --help differ"
    [ "$(wc -l <out)" -le 90 ] || fail "$tool --help has $(wc -l <out) lines"
    # Each word of its groups prints options that are in the whole page, and all of them together are that page's.
    "$tool" --help all >whole
    sed -n 's/^More options.*/&/; /^More options/,/^$/s/^  \([a-z-]*\) .*/\1/p' out >words
    [ "$(wc -l <words)" -ge 5 ] || fail "$tool --help names $(wc -l <words) groups"
    options() { grep -oE '^  -.*' "$@" | sed 's/^  \([^ ]*\).*/\1/' | LC_ALL=C sort -u; }
    while read -r word; do "$tool" --help "$word" || fail "$tool --help $word"; done <words >parts
    diff <(cat out parts | options) <(options whole) || fail "$tool: options of the groups (<) and of --help all (>) differ"
    expect_error 2 "$tool" --help gruppe
    grep -q ": all, " err || fail "$tool does not list its groups: $(cat err)"
    expect_status 0 "$tool" --help quiet
    [ "$(options out)" = -q, ] || fail "$tool --help quiet: $(cat out)"
    # A file is an operand.
    expect_status 0 "$tool" --help room.env
    expect_same short out "$tool: --help room.env is another page"
    [ ! -s err ] || fail "$tool --help talks on stderr"
    awk -v tool="$tool" 'length > 100 { print tool " --help is wide: " $0; bad = 1 } END { exit bad }' out
done
expect_status 1 envc <empty
expect_status 1 coverage "$data/room.env" - <empty
[ "$(ls -A)" = "$(printf '%s\n' empty err folder out parts short whole words)" ] || fail "left behind: $(ls -A)"
