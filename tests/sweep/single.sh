#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/batch without any runner: one job after the other, for the others to equal.
. "$(dirname "$0")/batch.sh"

rm -rf "$single"
set_up run
(cd run && ispace-sweep commands sweep.yaml | sh && ispace-sweep join sweep.yaml -o table.csv)
[ "$(wc -l <run/table.csv)" -eq 101 ] || fail "not 100 jobs: $(wc -l run/table.csv)"
mv run "$single"
