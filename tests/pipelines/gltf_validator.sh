#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The Khronos validator finds no error in the models: every scene, one with sensors in it, a map, and
# real maps where there are some. `make check` fetches the validator.
. "$(dirname "$0")/common.sh"

command -v node >/dev/null || skip "no node here"
[ -d "$binary_dir/npm/node_modules/gltf-validator" ] || skip "npm could not fetch the validator"
export NODE_PATH=$binary_dir/npm/node_modules

for scene in "$scenes"/*.env "$scenes"/*.yaml "$data/map.yaml" "${ISPACE_TEST_DATA:-none}"/*.yaml; do
    [ -e "$scene" ] || continue
    envc "$scene" -o "$(basename "$scene").glb"
done
envc "$data/room.env" "$data/room.3dm" -o sensors.glb
[ "$(ls ./*.glb | wc -l)" -ge 5 ] || fail "too few models: $(ls)"
node "$source_dir/tests/npm/validate_gltf.js" ./*.glb

# The check can fail: a damaged mesh makes a model invalid.
sed 's/"POSITION"/"POSITIOM"/' sensors.glb >damaged.glb
if node "$source_dir/tests/npm/validate_gltf.js" damaged.glb >/dev/null; then
    fail "self-test: a damaged model passes"
fi
