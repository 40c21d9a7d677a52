#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The types of ispace-sweep.
. "$(dirname "$0")/../pipelines/common.sh"

command -v mypy >/dev/null || skip "no mypy"
tests=$PWD
cd "$source_dir/share"
mypy --config-file "$source_dir/tests/sweep/mypy.ini" --cache-dir=/dev/null sweep >"$tests/types" ||
    fail "$(cat "$tests/types")"
