#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/projector: a program that turns a projector keeps its picture before a person, the same each time; a
# projector that stays does not.
. "$(dirname "$0")/../pipelines/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
export PYTHONPATH="$source_dir/lib/client/python"
example=$source_dir/share/examples/projector

# verdict FOLDER OPTION…: runs the example there. Prints its report.
verdict() {
    local folder=$1
    shift
    mkdir "$folder"
    (cd "$folder" && timeout 60 "$example/test.sh" "$@" 2>errors) || fail "$(cat "$folder/errors")"
}
# share REPORT: the percentage of its time
share() { awk '{ print $3 }' <<<"$1"; }
followed=$(verdict followed)
[ "$(share "$followed")" -ge 75 ] || fail "the picture is lost: $followed"
[ "$(verdict again)" = "$followed" ] || fail "the same program leads another time elsewhere"
still=$(verdict still --still)
[ "$(share "$still")" -le 10 ] || fail "$still"
# A projector turns within its ranges alone.
simrun --replay followed/run --clock fast --until 1 -q >/dev/null || fail "no replay"
expect_status 1 envc "$example/room.env" --set p.tilt=30 --check
has "is beyond the tilt_range of the projector, -90 to 20" err || fail "$(cat err)"
