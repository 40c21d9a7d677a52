#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/rules: the rules catch the fault of a controller over TCP, the same one each time, and pass the mended one.
. "$(dirname "$0")/../pipelines/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
export PYTHONPATH="$source_dir/lib/client/python"
example=$source_dir/share/examples/rules

# judged STATUS FOLDER OPTION…: runs the example there.
judged() {
    local wanted=$1 folder=$2 status=0
    shift 2
    mkdir "$folder"
    (cd "$folder" && timeout 60 "$example/test.sh" "$@" >report 2>errors) || status=$?
    [ "$status" = "$wanted" ] || fail "status $status instead of $wanted: $(cat "$folder/report" "$folder/errors")"
}
judged 3 faulty
grep -q '^FAILED  no heat out of the window: ' faulty/report || fail "$(cat faulty/report)"
[ "$(grep -c '^met' faulty/report)" = 4 ] || fail "$(cat faulty/report)"
grep -q '^ *t=15.100  k1 was open$' faulty/report || fail "no state of the window: $(cat faulty/report)"
grep -q 'tests="5" failures="1"' faulty/junit.xml || fail "$(cat faulty/junit.xml)"
python3 "$source_dir/tests/schemas/junit.py" faulty/junit.xml || fail "not the XML that servers read"
judged 3 again
cmp faulty/report again/report || fail "the same controller gets another report"
judged 0 mended --mended
! grep -q FAILED mended/report || fail "$(cat mended/report)"

# The report names the film of the failure.
cd faulty
film=$(sed -n 's/^ *\(simrun --replay .*\)/\1/p' rules.txt)
sh -c "$film" 2>film_errors || fail "$film: $(cat film_errors)"
[ "$(head -c 6 failure1.gif)" = GIF89a ] || fail "no film"
