#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/batch with GNU parallel: killed in the middle, then started again.
. "$(dirname "$0")/batch.sh"

export PARALLEL_HOME=$scratch
[[ $(parallel --version 2>/dev/null) = "GNU parallel "* ]] || skip "no GNU parallel"
set_up spread
cd spread
setsid ./parallel.sh --jobs 2 >../out 2>../err &
group=$!
for _ in $(seq 1200); do
    [ "$(find results -name '*.json' 2>/dev/null | wc -l)" -lt 10 ] || break
    sleep 0.05
done
kill -9 -- -"$group"
wait "$group" 2>/dev/null || true
# Jobs that were running end by themselves.
for _ in $(seq 200); do
    left=$(ispace-sweep commands sweep.yaml --missing | wc -l)
    done_before=$(find results -name '*.json' | wc -l)
    [ $((left + done_before)) -ne 100 ] || break
    sleep 0.05
done
[ "$done_before" -ge 10 ] && [ "$left" -gt 0 ] && [ $((left + done_before)) -eq 100 ] ||
    fail "$done_before jobs done and $left left when it was killed"
rm -f results/.ispace.tmp.*
./parallel.sh --jobs 2 >../out 2>../err || fail "$(cat ../err)"
cd ..
expect_single spread

# A job that fails makes it fail, after the others.
rm -r spread/results
mkdir bin
printf '#!/bin/sh\ncase $* in *seed5*) exit 1;; esac\nexec %s "$@"\n' "$binary_dir/bin/coverage" >bin/coverage
chmod +x bin/coverage
status=0
(cd spread && PATH=$scratch/bin:$PATH ./parallel.sh --jobs 2 >../out 2>../err) || status=$?
[ "$status" -eq 20 ] || fail "status $status where 20 jobs fail"
[ "$(cd spread && ispace-sweep commands sweep.yaml --missing | wc -l)" -eq 20 ] || fail "others failed, too"
