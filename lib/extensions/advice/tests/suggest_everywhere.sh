#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# suggest_everywhere.sh scenes|K/N: five suggestions of coverage in each scene of share/scenes, or in each K-th of N
# maps in the folder ISPACE_TEST_DATA, run as they are printed; coverage then reports the gain told.
# Bounds, for the time: two scanners with a range of an eighth of the map, candidates a sixteenth of it apart, and at
# most 80 cells along a side; gains are exact none the less.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
part=${1:?scenes or K/N}
check=$source_dir/lib/extensions/advice/tests/suggest_everywhere.py

if [ "$part" = scenes ]; then
    cp -r "$scenes"/* .
    python3 "$check" scenes
    exit 0
fi
[ -n "${ISPACE_TEST_DATA:-}" ] || skip "ISPACE_TEST_DATA names no folder of real maps"
python3 "$check" "$ISPACE_TEST_DATA" "$part"
