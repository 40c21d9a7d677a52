#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Scripts of .ci and of the benchmarks: another clang-format changes and checks nothing, an unknown fuzzer is named before
# anything is built, and results of benchmarks become tables, also beside one that ended early.
. "$(dirname "$0")/../pipelines/common.sh"

mkdir bin
for program in bash env sed dirname; do ln -s "$(command -v "$program")" bin; done
printf '#!/bin/sh\necho "Debian clang-format version 19.1.7"\n[ "$1" = --version ] || exit 9\n' >bin/clang-format
chmod +x bin/clang-format
for option in --check ''; do
    status=0
    # shellcheck disable=SC2086
    env PATH="$PWD/bin" "$source_dir/.ci/format" $option >out 2>err || status=$?
    [ "$status" -eq "$([ -n "$option" ] && echo 0 || echo 1)" ] || fail "format $option: status $status: $(cat out err)"
    grep -q 'formatted with clang-format 14, here is 19; nothing done' err || fail "format $option: $(cat out err)"
done

expect_status 2 "$source_dir/.ci/fuzz" 1 1 nosuch
grep -q '^fuzz: no target nosuch; targets:.* yaml ' err || fail "fuzz: $(cat err)"

command -v python3 >/dev/null || skip "no python3 here"
mkdir results
cat >results/two.json <<'END'
{"context": {"table first": "A title\nplan\t   m2\ta core\t"},
 "benchmarks": [{"name": "first/1/iterations:3/manual_time", "label": "made, 45 m2\t   45\t   1.5\t", "time_unit": "ms"},
                {"name": "two/rays/real_time", "real_time": 3.0, "cpu_time": 2.0, "time_unit": "us", "rate": 7.0}]}
END
python3 "$source_dir/tests/bench/tables.py" results || fail "tables.py"
printf 'plan,m2,a core\n"made, 45 m2",45,1.5\n' | cmp - results/two_first.csv || fail "$(cat results/two_first.csv)"
printf 'run,real_time_ms,cpu_time_ms,rate\ntwo/rays,0.003,0.002,7\n' | cmp - results/two.csv || fail "$(cat results/two.csv)"
echo '{"context": {}, "benchmarks": [' >results/cut.json
sed -i 's/"label"/"error_message": "above its goal", "label"/' results/two.json
expect_status 1 python3 "$source_dir/tests/bench/tables.py" results
grep -q 'cut.json is incomplete' err && grep -q 'first/1: above its goal' err || fail "tables.py: $(cat err)"
