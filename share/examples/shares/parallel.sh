#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# parallel.sh [OPTION OF PARALLEL]...: eight shares of the sweep, as many at a time as there are cores (or --jobs N, or
# --sshlogin HOST with a shared folder), then the table.
set -euo pipefail
seq 8 | parallel --will-cite "$@" ispace-sweep run sweep.yaml --shard {}/8 -j 1 -q -o part{}.jsonl
ispace-sweep join part*.jsonl -o table.csv
