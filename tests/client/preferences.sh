#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/preferences: a controller that reads what people prefer keeps both comfortable, the same minutes each
# time; one that serves all alike keeps one of them so.
. "$(dirname "$0")/../pipelines/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
export PYTHONPATH="$source_dir/lib/client/python"
example=$source_dir/share/examples/preferences

# minutes FOLDER OPTION…: runs the example there. Prints its report.
minutes() {
    local folder=$1
    shift
    mkdir "$folder"
    (cd "$folder" && timeout 60 "$example/test.sh" "$@" 2>errors) || fail "$(cat "$folder/errors")"
}
# share REPORT PERSON: the percentage of comfortable minutes
share() { awk -v person="$2" '$1 == person { printf "%d", 100 * $2 / $4 }' <<<"$1"; }
served=$(minutes served)
for person in ann bob; do
    [ "$(share "$served" $person)" -ge 80 ] || fail "$person is served badly: $served"
done
[ "$(minutes again)" = "$served" ] || fail "the same controller serves another time differently"
alike=$(minutes alike --same-for-all)
[ "$(share "$alike" ann)" -ge 80 ] || fail "$alike"
[ "$(share "$alike" bob)" -le 10 ] || fail "what Ann likes suits Bob, too: $alike"
