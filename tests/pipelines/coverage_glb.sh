#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Coverage as a picture on the floor of a model: valid for Khronos, the right way up for assimp, and
# still a room for our tools.
. "$(dirname "$0")/common.sh"

cp "$scenes/ispace.env" "$scenes/ispace.3dm" .
# Neither symmetric nor about the origin.
cat >room.env <<'END'
#env 1
fence path=200,100;208,100;208,106;203,106;203,105;200,105 closed=yes
inside at=201,101
END
cat >room.3dm <<'END'
#3dm 1
laser at=201,101 heading=45 range=4 fov=120
laser at=206,104 heading=-120 range=4 fov=100
laser at=206.5,104 heading=-170 range=3 fov=60
END

for name in ispace room; do
    coverage $name.env $name.3dm -o $name.glb >report
    coverage $name.env $name.3dm -o $name.csv >/dev/null
    coverage $name.env $name.3dm -o again.glb -j 1 >/dev/null
    expect_same $name.glb again.glb "another model with one thread"
    # It holds the scene: the same figures, without the layout.
    coverage $name.glb >again
    diff <(grep -v '^environment' report) <(grep -v '^environment' again) || fail "another scene in $name.glb"
done
envc room.glb --to env | sed -n 2p >history
grep -q '^# coverage room.env room.3dm' history || fail "no history: $(cat history)"
mkdir folder
coverage room.env room.3dm -o folder/room.glb >/dev/null

if command -v node >/dev/null && [ -d "$binary_dir/npm/node_modules/gltf-validator" ]; then
    NODE_PATH=$binary_dir/npm/node_modules node "$source_dir/tests/npm/validate_gltf.js" ispace.glb room.glb ||
        fail "Khronos' validator finds errors"
else
    echo "no validator here"
fi
if command -v assimp >/dev/null && /usr/bin/python3 -c 'import cv2' 2>/dev/null; then
    for name in ispace room; do
        assimp info $name.glb >facts 2>&1 || fail "assimp refuses $name.glb: $(tail -n 3 facts)"
        grep -q '^Textures (embed.): *1$' facts || fail "assimp sees no texture: $(cat facts)"
        assimp export $name.glb $name.obj >log 2>&1 || fail "assimp cannot export $name.glb: $(cat log)"
        check=("$source_dir/tests/pipelines/glb_floor.py" $name.glb $name.obj $name.csv)
        /usr/bin/python3 "${check[@]}" >seen || fail "$name: $(cat seen)"
        if /usr/bin/python3 "${check[@]}" flip >seen; then fail "self-test: upside down passes: $(cat seen)"; fi
    done
else
    echo "no assimp or no OpenCV here"
fi
