# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Read by the other scripts here: a scratch folder to be in, and ways to say what is expected.
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

# expect_status N COMMAND…: its output goes to ./out and ./err.
expect_status() {
    local wanted=$1 status=0
    shift
    "$@" >out 2>err || status=$?
    [ "$status" -eq "$wanted" ] ||
        fail "status $status, expected $wanted, of: $* ($(head -n 5 err))"
}

# expect_error N TOOL ARGUMENT…: status N, one line `TOOL: …` on stderr, nothing on stdout.
expect_error() {
    local wanted=$1 tool=$2
    shift
    expect_status "$wanted" "$@"
    [ ! -s out ] || fail "output in spite of the error: $*"
    [ "$(wc -l <err)" -eq 1 ] || fail "not one line of error: $*: $(cat err)"
    grep -q "^$tool: " err || fail "an error without the tool's name: $*: $(cat err)"
}

# expect_same A B WHAT
expect_same() {
    cmp "$1" "$2" || fail "$3"
}
