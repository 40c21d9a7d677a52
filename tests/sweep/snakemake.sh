#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/batch with Snakemake: the single run's bytes, and no job twice.
. "$(dirname "$0")/batch.sh"

snakemake --version >/dev/null 2>&1 || skip "no snakemake (Debian's has 670 MB of dependencies)"
export HOME=$scratch XDG_CACHE_HOME=$scratch/cache
set_up snake
cd snake
snakemake --cores 2 >../out 2>../err || fail "$(tail -n 20 ../err)"
cd ..
expect_single snake
(cd snake && snakemake --cores 2) >out 2>&1
grep -q 'Nothing to be done' out || fail "it does something twice: $(cat out)"
