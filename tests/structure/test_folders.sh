#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# test_folders.sh [ROOT]: unit tests write into separate TestFolders. Tests run beside each other, and two that
# share a name among the temporary files remove each other's. It first shows on a made-up tree that it can fail.
set -euo pipefail
root=${1:-$(cd "$(dirname "$0")/../.." && pwd)}

# Prints the lines that name files directly among the temporary ones. $1: a tree with lib/ and tests/.
shared_names() {
    (cd "$1" && grep -rnE 'TempDir\(\)|temp_directory_path\(|"/tmp/' lib tests/client tests/support \
        --include='*_test.cc' | grep -vE 'rebased\(|std::pair\("/tmp/' || true)
}

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/lib/kernel/base" "$tree/tests/client" "$tree/tests/support"
echo 'const std::string file = ::testing::TempDir() + "a";' >"$tree/lib/kernel/base/a_test.cc"
[ -n "$(shared_names "$tree")" ] || { echo "test_folders: self-test: not noticed"; exit 1; }
echo 'const testing::TestFolder folder;' >"$tree/lib/kernel/base/a_test.cc"
[ -z "$(shared_names "$tree")" ] || { echo "test_folders: self-test: wrongly reported"; exit 1; }

found=$(shared_names "$root")
[ -z "$found" ] || { printf 'test_folders: use TestFolder (tests/support/test_folder.h)\n%s\n' "$found"; exit 1; }
