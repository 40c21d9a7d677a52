#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every file of tests/data/malformed: status 1, one message that names a file and the remedy, and no product.
# malformed.err holds the messages; UPDATE_GOLDEN=1 writes them again.
. "$(dirname "$0")/../pipelines/common.sh"

expected=$source_dir/tests/envc/malformed.err
cp "$data"/malformed/* .
cp "$data/room.env" good_room.env

# Pictures that a map names, and an include, are no operands.
is_companion() {
    case "$1" in *.pgm | map_broken.png | yaml_cycle_2.yaml) return 0 ;; esac
    return 1
}

count=0
for file in "$data"/malformed/*; do
    file=$(basename "$file")
    if is_companion "$file"; then continue; fi
    inputs=("$file")
    case "$file" in *.3dm | *.ply | *.stl) inputs=(good_room.env "$file") ;; esac
    status=0
    envc "${inputs[@]}" -o product.glb >out 2>err || status=$?
    [ "$status" -eq 1 ] || fail "$file: status $status: $(head -n 3 err)"
    [ ! -s out ] || fail "$file: output in spite of the error"
    [ ! -e product.glb ] || fail "$file: a product in spite of the error"
    [ "$(wc -l <err)" -eq 1 ] || fail "$file: not one message: $(cat err)"
    grep -qE '^envc: [^ :]+\.[a-z0-9]+:([0-9]+:([0-9]+:)?)? error: .' err ||
        fail "$file: no place in: $(cat err)"
    # Without the lists of all keywords and formats, which grow.
    sed 's/, known: .*//; s/\(empty input\|environment or layout\): wanted .*/\1: wanted …/' err >>all.err
    count=$((count + 1))
done
[ "$count" -ge 50 ] || fail "only $count malformed inputs"

if [ -n "${UPDATE_GOLDEN:-}" ]; then cp all.err "$expected"; fi
diff "$expected" all.err || fail "messages differ from tests/envc/malformed.err (<)"
echo "$count malformed inputs refused"
