# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Read by the tests of share/examples/batch: a folder with the example as its first lines say to set it up, and
# the same sweep run job after job (by single.sh), which every runner must equal.
. "$(dirname "$0")/../pipelines/common.sh"

/usr/bin/python3 -c 'import yaml' 2>/dev/null || skip "no python3-yaml"
batch=$source_dir/share/examples/batch
picture=yes
/usr/bin/python3 -c 'import matplotlib' 2>/dev/null || picture=

# set_up FOLDER: copies the example with its rooms; without matplotlib it draws no picture.
set_up() {
    cp -r "$batch" "$1"
    cp "$scenes/crowded.env" "$scenes/l-room.env" "$1"
    if [ -z "$picture" ]; then
        echo "no python3-matplotlib: no pictures"
        sed -i 's/ curves\.svg$//; s/, "curves\.svg"$//; s/ &&$//; /plot/d' "$1"/[!sm]* "$1/slurm.sh"
        sed -i "s/-o table\.csv\$/-o table.csv'/" "$1/slurm.sh"
    fi
}

single=$binary_dir/tests/scratch/sweep.single

# expect_single FOLDER: results and table are those of serial jobs, without other files, and a picture exists.
expect_single() {
    (cd "$1" && [ -z "$(ispace-sweep commands sweep.yaml --missing)" ]) || fail "$1: jobs left"
    diff -r "$single/results" "$1/results" || fail "$1: results differ from the single run's"
    expect_same "$single/table.csv" "$1/table.csv" "$1: another table than the single run's"
    [ -z "$picture" ] || grep -q '</svg>' "$1/curves.svg" || fail "$1: no picture"
}
