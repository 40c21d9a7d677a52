#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# On real logs the fitted beam model explains held-out scans no worse than a separate fit in Python: CSAIL, whose room is
# learned from the even scans, and Intel.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

logs=${ISPACE_TEST_DATA:-}/logs
[ -r "$logs/csail.corrected.clf" ] || skip "ISPACE_TEST_DATA has no logs/csail.corrected.clf"
/usr/bin/python3 -c 'import numpy' 2>/dev/null || skip "no python3-numpy"

for log in csail.corrected.clf intel.gfs.log; do
    grep '^FLASER' "$logs/$log" | awk 'NR % 2 == 1' >even.clf
    grep '^FLASER' "$logs/$log" | awk 'NR % 2 == 0' >odd.clf
    envc even.clf -q -o room.glb
    scan room.glb --against odd.clf -q -o beams.csv --fit fit.3dm >/dev/null
    ours=$(sed -n 's/.*held-out log-likelihood \([-0-9.e]*\) (odd.*/\1/p' fit.3dm)
    theirs=$(/usr/bin/python3 "$(dirname "$0")/beam_em.py" beams.csv)
    echo "$log: ours $ours, Python $theirs"
    awk -v a="$ours" -v b="${theirs%% *}" 'BEGIN { exit !(a >= b - 0.005) }' ||
        fail "$log: the held-out log-likelihood $ours is below that of Python, $theirs"
done
