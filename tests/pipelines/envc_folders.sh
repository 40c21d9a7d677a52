#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that records name are found from wherever a product lies, and products do not depend on the
# folder they are made from; layouts bring their room along, alone and joined with it.
. "$(dirname "$0")/common.sh"

mkdir -p a/meshes b
cp "$scenes/catalogue.env" a
cp "$scenes/meshes/steps.obj" a/meshes

envc a/catalogue.env -o a/one.glb
(cd a && envc catalogue.env -o two.glb)
expect_same a/one.glb a/two.glb "the model depends on the folder it was made from"
for format in env yaml; do
    envc a/one.glb --to $format -o "b/again.$format"
    envc "b/again.$format" -o "b/again_$format.glb"
    [ "$(envc "b/again_$format.glb" --info --json)" = "$(envc a/one.glb --info --json)" ] ||
        fail "another room after glb, $format, glb"
done
(cd b && envc again.env --check)
envc a/one.glb -o b/moved.glb
envc b/moved.glb --to env | has 'file=a/meshes/steps.obj' || fail "$(envc b/moved.glb --to env)"

# A layout alone, in another folder than its room.
envc "$data/room.env" -o a/room.glb
arrange a/room.glb --sensor laser,range=3:2 --strategy grid -X 3 -Y 3 -o b/best.3dm
grep -q 'file=../a/room.glb' b/best.3dm || fail "$(cat b/best.3dm)"
envc b/best.3dm --info >alone.txt
grep -q 'laser 2' alone.txt || fail "$(cat alone.txt)"
envc b/best.3dm -o both.glb -MD
grep -q 'a/room.glb' both.glb.d || fail "the rule lacks the room: $(cat both.glb.d)"
envc b/best.3dm --move '*:0.25,0' --to 3dm | tee moved.3dm | coverage --json >moved.json
grep -q 'file=a/room.glb' moved.3dm || fail "$(cat moved.3dm)"

# Room and layout as one layout: a scene that goes with its room.
envc a/room.glb b/best.3dm --to 3dm -o b/whole.3dm
coverage a/room.glb b/whole.3dm --json >whole.json
coverage a/room.glb b/best.3dm --json >best.json
expect_same whole.json best.json "the joined layout sees something else"

# Two files of a product exist together, or not at all.
small_disk
expect_status 1 envc a/catalogue.env --to obj -o disk/room.obj
[ -z "$(ls disk)" ] || fail "left behind on a full disk: $(ls disk)"
