#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# slurm-array.sh TASKS [SWEEP]: one task of an array of TASKS, started by slurm.sh. Runs its share of the sweep's jobs
# and skips completed ones: after a node failed and Slurm requeued the task, or if the array is submitted again. The
# tools read their number of threads from --cpus-per-task.
#SBATCH --job-name=ispace-sweep
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --output=/dev/null
#SBATCH --error=slurm-%A_%a.txt
#SBATCH --open-mode=append
set -euo pipefail
ispace-sweep commands "${2:-sweep.yaml}" --shard "$SLURM_ARRAY_TASK_ID/$1" --missing | sh
