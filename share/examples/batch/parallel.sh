#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# parallel.sh [OPTION OF PARALLEL]...: the jobs that are not done yet, as many at a time as there are
# cores (or --jobs N, or --sshlogin HOST with a shared folder), then the table and the picture.
set -euo pipefail
ispace-sweep commands sweep.yaml --missing -j 1 | parallel --will-cite "$@"
ispace-sweep join sweep.yaml -o table.csv
ispace-sweep plot sweep.yaml --x count --by device -o curves.svg
