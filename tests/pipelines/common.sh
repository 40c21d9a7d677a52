# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Read by the other scripts here: enters a scratch folder, and defines functions that state expectations.
set -euo pipefail

source_dir=${ISPACE_SOURCE_DIR:?run by ctest}
data=$source_dir/tests/data
scenes=$source_dir/share/scenes
tools="envc arrange scan coverage simrun"
binary_dir=${ISPACE_BINARY_DIR:?run by ctest}

mkdir -p "$binary_dir/tests/scratch"
scratch=$(mktemp -d "$binary_dir/tests/scratch/pipeline.XXXXXX")
cleanup() { rm -rf "$scratch"; }
trap cleanup EXIT
cd "$scratch"

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

skip() {
    echo "skipped: $*"
    exit 77
}

# COMMAND | has PATTERN: grep -q ends at the first match, and a command that writes on then dies of
# SIGPIPE, which pipefail makes the status; this one reads to the end.
has() { grep "$@" | wc -l >/dev/null; }

# expect_status N COMMAND…: its output goes to ./out and ./err.
expect_status() {
    local wanted=$1 status=0
    shift
    "$@" >out 2>err || status=$?
    [ "$status" -eq "$wanted" ] ||
        fail "status $status, expected $wanted, of: $* ($(head -n 5 err))"
}

# expect_error N TOOL ARGUMENT…: status N, one line `TOOL: …` on stderr, empty stdout.
expect_error() {
    local wanted=$1 tool=$2
    shift
    expect_status "$wanted" "$@"
    [ ! -s out ] || fail "output in spite of the error: $*"
    one_error "$tool" "$*"
}

# one_error TOOL MESSAGE: ./err holds one line, which begins with the tool's name.
one_error() {
    [ "$(wc -l <err)" -eq 1 ] || fail "not one line of error: $2: $(cat err)"
    grep -q "^$1: " err || fail "an error without the tool's name: $2: $(cat err)"
}

# interrupt SIGNAL SECONDS COMMAND…: sends it to the running command, which must end with 128+n.
interrupt() {
    local signal=$1 job status=0
    set -m  # a background job ignores INT unless it has job control
    "${@:3}" 2>err &
    job=$!
    set +m
    sleep "$2"
    kill -0 "$job" || fail "the job is over too soon to be interrupted: $(cat err)"
    kill -"$signal" "$job"
    wait "$job" || status=$?
    [ "$status" -eq $((128 + $(kill -l "$signal"))) ] ||
        fail "status $status after SIG$signal: $(cat err)"
}

# small_disk: ./disk is a file system of 64 kB; ends the script where mounting is not allowed.
small_disk() {
    mkdir disk
    if ! mount -t tmpfs -o size=64k tmpfs disk 2>/dev/null; then
        echo "no right to mount: the part with a small file system is left out"
        exit 0
    fi
    trap 'umount disk; cleanup' EXIT
}

# one_job_of_each_tool: stores in ${jobs[@]}, as words to be split, the jobs of scripts that disturb a tool; product
# writes the output of the last one (./out, ./map.png), without the parts that differ between runs.
one_job_of_each_tool() {
    envc "$scenes/crowded.env" -o room.glb
    arrange -q room.glb --sensor laser,range=4,fov=180:3 --strategy grid -X 6 -Y 6 --deg 8 -o best.3dm
    { cat best.3dm; echo 'ranger id=k at=-1,0,1 heading=40 tilt=-20 pixels=64,48 sigma=0.01'; } >more.3dm
    jobs=(
        "envc $scenes/crowded.env --to glb"
        "envc $scenes/crowded.env --to png"
        "arrange room.glb --sensor laser,range=4,fov=180:3 --strategy grid -X 12 -Y 12 --deg 8 -q"
        "scan room.glb more.3dm --noise --frames 20"
        "coverage room.glb best.3dm -o map.png"
        "simrun $data/room.env $data/robots.3dm --until 5 --clock fast"
    )
}
product() {
    { sed 's/"listen":"[^"]*"/"listen":""/' out; [ ! -e map.png ] || cat map.png; } | cksum
}

# expect_same A B MESSAGE
expect_same() {
    cmp "$1" "$2" || fail "$3"
}
