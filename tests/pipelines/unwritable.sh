#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Outputs that cannot be made: one line naming the target, status 1, nothing half-written; and what
# -o does to files that are there already.
. "$(dirname "$0")/common.sh"

room=$data/room.env
layout=$data/room.3dm
declare -A product=(
    [envc]="envc $room --to env"
    [arrange]="arrange $room --sensor laser --strategy grid -X 2 -Y 2 --deg 4"
    [scan]="scan $room $layout"
    [coverage]="coverage $room $layout --to png"
)
mkdir folder
for tool in "${!product[@]}"; do
    # shellcheck disable=SC2086
    for target in missing/folder/file folder; do
        # scan writes a set of files into a folder.
        [ "$tool $target" != "scan folder" ] || continue
        expect_status 1 ${product[$tool]} -o $target
        grep -q "^$tool: $target" err || fail "$tool does not name $target: $(cat err)"
        [ "$(wc -l <err)" -eq 1 ] || fail "not one line: $(cat err)"
    done
    # A bad input leaves the old output as it was.
    echo old >target
    bad=${product[$tool]//$room/$data/unknown_key.env}
    # shellcheck disable=SC2086
    expect_status 1 $bad -o target
    [ "$(cat target)" = old ] || fail "$tool: the old file is gone"
    # A link stays a link, permissions stay.
    chmod 640 target
    ln -s target link
    # shellcheck disable=SC2086
    expect_status 0 ${product[$tool]} -o link
    [ -L link ] || fail "$tool replaced a link"
    [ "$(cat target)" != old ] || fail "$tool did not write through the link"
    [ "$(stat -c %a target)" = 640 ] || fail "$tool changed the permissions"
    rm -f link target
done
[ -z "$(ls -A folder)" ] || fail "left behind in the folder"
[ "$(ls -A)" = "$(printf '%s\n' err folder out)" ] || fail "left behind: $(ls -A)"
