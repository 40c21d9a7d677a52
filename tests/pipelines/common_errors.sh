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
    # envc joins any number of inputs.
    [ "$tool" = envc ] || expect_error 2 "$tool" a.env b.3dm c.env "${extra[@]}"

    expect_status 0 "$tool" --version
    grep -qx "$tool (ispace) [0-9.]*" <(head -n 1 out) || fail "$tool --version: $(cat out)"
    expect_status 0 "$tool" -h
    mv out short
    expect_status 0 "$tool" --help
    expect_same short out "$tool: -h and --help differ"
    [ ! -s err ] || fail "$tool --help talks on stderr"
    awk -v tool="$tool" 'length > 100 { print tool " --help is wide: " $0; bad = 1 } END { exit bad }' out
done
expect_status 1 envc <empty
expect_status 1 coverage "$data/room.env" - <empty
[ "$(ls -A)" = "$(printf '%s\n' empty err folder out short)" ] || fail "left behind: $(ls -A)"
