#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm.sh [TASKS]: submits the sweep as an array of TASKS (8) tasks, and a job that joins their parts; ends with it,
# with its status. The nodes share the folder.
set -euo pipefail
array=$(sbatch --parsable --array="1-${1:-8}" slurm-share.sh)
# A failed task ends the joining job, too, which would else wait for ever.
sbatch --wait --dependency="afterok:$array" --kill-on-invalid-dep=yes --output=slurm-join.txt \
    --wrap 'ispace-sweep join part*.jsonl -o table.csv'
