#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# share/examples/shares with each of its runners that is here: the parts and the table of a run on one machine. Eight
# shares leave eight parts and the small files beside them, and no other.
. "$(dirname "$0")/../pipelines/common.sh"

/usr/bin/python3 -c 'import yaml' 2>/dev/null || skip "no python3-yaml"
shares=$source_dir/share/examples/shares

# set_up FOLDER: copies the example as its first lines say, with a tenth of its seeds.
set_up() {
    cp -r "$shares" "$1"
    cp "$scenes/l-room.env" "$1"
    sed -i 's/1\.\.400/1..40/' "$1/sweep.yaml"
}

# expect_shares FOLDER: the parts and the table of `single`, and no other files.
expect_shares() {
    local i
    expect_same single/table.csv "$1/table.csv" "$1: another table"
    for i in 1 2 3 4 5 6 7 8; do
        expect_same "single/part$i.jsonl" "$1/part$i.jsonl" "$1: another part $i"
    done
    [ "$(find "$1" -name 'part*' | wc -l)" -le 16 ] || fail "$1: $(ls "$1")"
    [ ! -e "$1/results" ] || fail "$1: files of jobs"
}

set_up single
(
    cd single
    for i in 1 2 3 4 5 6 7 8; do ispace-sweep run sweep.yaml --shard "$i/8" -q -o "part$i.jsonl"; done
    ispace-sweep join part*.jsonl -o table.csv
)
[ "$(wc -l <single/table.csv)" -eq 41 ] || fail "not 40 jobs: $(wc -l <single/table.csv)"

ran=""
if [[ $(PARALLEL_HOME=$scratch parallel --version 2>/dev/null) = "GNU parallel "* ]]; then
    set_up spread
    (cd spread && PARALLEL_HOME=$scratch ./parallel.sh --jobs 2) >out 2>err || fail "$(cat err)"
    expect_shares spread
    ran="$ran parallel"
fi
if snakemake --version >/dev/null 2>&1; then
    set_up snake
    (cd snake && HOME=$scratch XDG_CACHE_HOME=$scratch/cache snakemake --cores 2) >out 2>err || fail "$(tail -n 20 err)"
    expect_shares snake
    ran="$ran snakemake"
fi
if /usr/bin/python3 -c 'import dask.distributed' 2>/dev/null; then
    set_up dask
    (cd dask && HOME=$scratch /usr/bin/python3 share.py) >out 2>err || fail "$(tail -n 20 err)"
    expect_shares dask
    ran="$ran dask"
fi
# A Kubernetes Job is not run here: its commands are, with the index that each pod gets.
set_up pods
(
    cd pods
    command=$(/usr/bin/python3 -c 'import sys, yaml
job = yaml.safe_load(open("kubernetes.yaml"))
container = job["spec"]["template"]["spec"]["containers"][0]
sys.stdout.write(container["args"][0])')
    for index in 0 1 2 3 4 5 6 7; do JOB_COMPLETION_INDEX=$index sh -c "$command"; done
    ispace-sweep join part*.jsonl -o table.csv
)
expect_shares pods
echo "ran with:$ran, and the commands of pods"
