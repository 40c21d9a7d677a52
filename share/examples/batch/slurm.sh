#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm.sh [TASKS]: submits the sweep as an array of TASKS (100) tasks, and a job that joins their results; ends with
# it, with its status. The nodes share the folder.
set -euo pipefail
tasks=${1:-100}
array=$(sbatch --parsable --array="1-$tasks" slurm-array.sh "$tasks")
# A failed task ends the joining job, too, which would else wait for ever.
sbatch --wait --dependency="afterok:$array" --kill-on-invalid-dep=yes --output=slurm-join.txt \
    --wrap 'ispace-sweep join sweep.yaml -o table.csv &&
        ispace-sweep plot sweep.yaml --x count --by device -o curves.svg'
