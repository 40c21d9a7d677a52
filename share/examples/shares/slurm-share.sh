#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm-share.sh: a task of an array, started by slurm.sh: one share of the sweep. After a node failed, Slurm requeues
# the task, which continues its part. It runs as many jobs at a time as it has cores (--cpus-per-task).
#SBATCH --job-name=ispace-shares
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --output=/dev/null
#SBATCH --error=slurm-%A_%a.txt
#SBATCH --open-mode=append
set -euo pipefail
exec ispace-sweep run sweep.yaml --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" -q \
    -o "part$SLURM_ARRAY_TASK_ID.jsonl"
