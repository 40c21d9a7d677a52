#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A compiled room is that of its records. tests/data/forged_room.glb is a room of 8 x 6 m that an older envc compiled,
# with derived data of the walls; these were changed to 5 x 6 m, with a correct checksum. Results are those of the
# records.
. "$(dirname "$0")/common.sh"

printf '#env 1\nispace size=8,6\n' >room.env
envc room.env -o true.glb
printf '#3dm 1\nlaser id=l1 at=0,0 range=5 fov=360\n' >laser.3dm

# results FOLDER ROOM: writes the results of the tools to the folder.
results() {
    mkdir -p "$1"
    cp "$2" "$1/room.glb"
    cp laser.3dm "$1"
    (
        cd "$1"
        envc room.glb --info >info
        envc room.glb --slice 0.15 -o slice.svg
        coverage room.glb laser.3dm -o map.png >report
        arrange -q room.glb --sensor laser:2 --candidates 1,1,8 -o best.3dm
        scan room.glb laser.3dm >scans.jsonl
        rm room.glb
    )
}
results wanted true.glb
grep -q '48.00 m2' wanted/report || fail "not the room: $(cat wanted/report)"
results found "$data/forged_room.glb"
diff -r wanted found || fail "a derived part counts"

# Its bytes do not matter, one by one and all together.
python3 - "$data/forged_room.glb" <<'PY'
import json, struct, sys
glb = open(sys.argv[1], 'rb').read()
size = struct.unpack('<I', glb[12:16])[0]
text = json.loads(glb[20:20 + size])
view = text['bufferViews'][text['extras']['ispace_derived']]
begin, length = 20 + size + 8 + view['byteOffset'], view['byteLength']
for name, change in (('zeros', lambda i, c: 0), ('ones', lambda i, c: 255),
                     ('shifted', lambda i, c: glb[begin + (i + 1) % length]),
                     ('flipped', lambda i, c: c ^ 1 << i % 8)):
    part = bytes(change(i, glb[begin + i]) for i in range(length))
    open(name + '.glb', 'wb').write(glb[:begin] + part + glb[begin + length:])
for i in range(0, length, 23):
    changed = bytearray(glb)
    changed[begin + i] ^= 0x40
    open(f'byte{i}.glb', 'wb').write(changed)
PY
for file in zeros ones shifted flipped byte*.glb; do
    coverage "${file%.glb}.glb" laser.3dm >report
    diff wanted/report report ||
        fail "$file: other results"
done

# An edited room has the edited size.
envc "$data/forged_room.glb" --set ispace1.size=10,6 --info | has '^indoor area  60.000 m2' ||
    fail "not 10 x 6 m"
