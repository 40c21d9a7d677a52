#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# web-ifc finds in an IFC export the storey, walls with their openings, spaces and sensors of the room.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

cat >büro.env <<'END'
#env 1
fence id=outer path=0,0;8,0;8,6;0,6 closed=yes thickness=0.2 height=2.5
wall  id=thin from=3,0 to=3,4 height=2
inside at=1,1
zone  id=kitchen/1 at=6,2 size=2,1.5
door  id=in wall=outer at=0,2 size=0.9,0.2,2.1
door  id=way wall=thin at=3,1 size=1,0.1,2 open=yes
window id=view wall=outer at=5,0 size=1.6 sill=0.9 height=1.2
pillar id=post at=5,4 kind=round size=0.4
table id=t1 at=1,4.5 heading=30
cube  id=box at=6,4 heading=30 size=0.5,0.4,0.3
END
cat >room.3dm <<'END'
#3dm 1
laser id=l1 at=0.5,0.5,1.2 heading=45 tilt=-10 model=urg-04lx
camera id=c1 at=7.5,5.5,2.3 heading=-135 tilt=-25 roll=5 fov=60,45 range=12
ultrasound id=u1 at=4,3,2.4 tilt=-90 fov=90 range=6
robot id=r1 at=4,2 heading=30
laser id=l2 on=r1 at=0.1,0,0.3
END

# The bytes depend on the records alone; a note reports movers.
expect_status 0 envc büro.env room.3dm -o room.ifc
grep -q 'laser.*robot\|robot.*laser' err || fail "robots are left out silently: $(cat err)"
envc büro.env room.3dm --to ifc 2>/dev/null | cmp - room.ifc || fail "another export of the same room"
LC_ALL=C grep -q '[^ -~]' room.ifc && fail "bytes that are no ASCII"
grep -qF "FILE_NAME('b\\X2\\00FC\\X0\\ro.env','',"  room.ifc || fail "a date: $(sed -n 4p room.ifc)"

# indoor FILE: its area in m2
indoor() { envc "$@" --info 2>notes | sed -n 's/^indoor area *\([0-9.]*\) m2/\1/p'; }
# same_area A B SHARE
same_area() {
    awk -v a="$1" -v b="$2" -v share="$3" 'BEGIN { exit !(a > 0 && b > 0 && (a - b) ^ 2 <= (share * a) ^ 2) }' ||
        fail "an area of $1 m2 comes back as $2 m2"
}
# envc reads its IFC back: the walls have lost the half of their thickness, doors and names stay.
same_area "$(awk 'BEGIN { print 7.8 * 5.8 + 0.9 * 0.2 - 0.005 * 2.9 }')" "$(indoor room.ifc)" 0.0005
envc room.ifc --to env >back.env 2>/dev/null
[ "$(grep -c '^door' back.env) $(grep -c '^window' back.env) $(grep -c '^pillar' back.env)" = '2 1 1' ] ||
    fail "other openings: $(cat back.env)"
grep -q '^zone id=kitchen-1 path=5,1.25;7,1.25;7,2.75;5,2.75' back.env || fail "another zone: $(grep '^zone' back.env)"
for scene in catalogue hall l-room open-office road; do
    envc "$scenes/$scene.env" -o scene.ifc 2>/dev/null
    same_area "$(indoor "$scenes/$scene.env")" "$(indoor scene.ifc)" 0.006
    grep -q 'warning' notes && fail "$scene comes back with $(cat notes)"
done

command -v node >/dev/null || skip "no node here"
# Buildings of others come back as the same rooms.
contents() { sed -n 's/^\(door\|window\|zone\|cube\) .*/\1/p' "$1" | sort | uniq -c; }
for storey in duplex.ifc:level-1 fzk-haus.ifc:erdgeschoss; do
    building=${ISPACE_TEST_DATA:-/nonexistent}/strangers/ifc/${storey%:*}
    [ -r "$building" ] || continue
    envc "$building" --storey "${storey#*:}" -o once.env 2>/dev/null
    envc once.env -o once.ifc 2>/dev/null
    envc once.ifc -o twice.env 2>/dev/null
    same_area "$(indoor once.env)" "$(indoor twice.env)" 0.002
    contents once.env >once
    # Floor outside of all rooms is a separate space in IFC.
    sed -i '/^zone id=indoor\(-[0-9]*\)\? /d' twice.env
    contents twice.env | cmp - once || fail "$building comes back with $(contents twice.env), not $(cat once)"
done

[ -d "$binary_dir/npm/node_modules/web-ifc" ] || skip "npm could not fetch a reader of IFC"
export NODE_PATH=$binary_dir/npm/node_modules
read_ifc() { node "$source_dir/tests/npm/read_ifc.js" "$@"; }

cat >check.py <<'END'
import json, math, sys
found = json.load(open(sys.argv[1]))
assert len(set(found["guids"])) == len(found["guids"]) > 40
assert all(len(guid) == 22 and guid[0] in "0123" for guid in found["guids"])
assert found["storeys"] == [{"name": "floor", "elevation": 0, "in": "büro.env"}], found["storeys"]

def near(a, b, within=1e-4):
    assert len(a) == len(b) and all(abs(x - y) <= within for x, y in zip(a, b)), (a, b)
def product(name, kind):
    rows = [row for row in found["products"][name] if row["class"] == kind]
    assert len(rows) == 1, (name, kind, rows)
    return rows[0]
def box(row, low, high):
    near(row["shape"]["low"], low)
    near(row["shape"]["high"], high)

# Four walls of 0.2 m around the room and a thin one; the door and the window are cut out of theirs.
walls = {name: row for name, rows in found["products"].items() for row in rows if row["class"] == "wall"}
assert set(walls) == {"outer 1", "outer 2", "outer 3", "outer 4", "thin"}, list(walls)
south, west, thin = walls["outer 1"], walls["outer 4"], walls["thin"]
for row, length, width, height in ((south, 8, 0.2, 2.5), (west, 6, 0.2, 2.5), (thin, 4, 0.005, 2)):
    assert row["in"] == "floor" and row["properties"]["set"] == "Qto_WallBaseQuantities"
    near([row["properties"][key] for key in ("Length", "Width", "Height")], [length, width, height])
whole = sum(walls[f"outer {i}"]["shape"]["volume"] for i in range(1, 5))
corners = 4 * 0.1 * 0.1 * 2.5  # in two walls each, which meet at their mid-lines
near([whole], [(8.2 * 6.2 - 7.8 * 5.8) * 2.5 + corners - 0.9 * 2.1 * 0.2 - 1.6 * 1.2 * 0.2], 1e-3)
box(thin, [2.9975, 0, 0], [3.0025, 4, 2])
near([thin["shape"]["volume"]], [0.005 * (4 * 2 - 1 * 2)])

door, way, view = product("in", "door"), product("way", "door"), product("view", "window")
near(door["size"] + way["size"] + view["size"], [0.9, 2.1, 1, 2, 1.6, 1.2])
assert (door["fills"], way["fills"], view["fills"]) == ("in", "way", "view")
assert product("in", "openingelement")["in"] == "outer 4" and product("view", "openingelement")["in"] == "outer 1"
box(door, [-0.02, 1.55, 0], [0.02, 2.45, 2.1])
box(view, [4.2, -0.001, 0.9], [5.8, 0.001, 2.1])
assert way["shape"] is None and way["object_type"] == "open"

# The room between the faces of its walls, and the zone.
room, zone = product("indoor", "space"), product("kitchen/1", "space")
box(room, [0.1, 0.1, 0], [7.9, 5.9, 2.5])
near([room["properties"]["NetFloorArea"], room["shape"]["volume"] / 2.5], [7.8 * 5.8] * 2)
box(zone, [5, 1.25, 0], [7, 2.75, 2.5])
near([zone["properties"]["NetFloorArea"]], [3])

post, table, cube = product("post", "column"), product("t1", "furniture"), product("box", "buildingelementproxy")
near([post["shape"]["low"][0], post["shape"]["high"][1]], [4.8, 4.2], 0.02)
assert table["kind"] == "TABLE" and cube["object_type"] == "cube"
near([cube["shape"]["volume"]], [0.5 * 0.4 * 0.3])

# Sensors, as a planner reads them; without movers.
laser, camera, ears = product("l1", "sensor"), product("c1", "audiovisualappliance"), product("u1", "sensor")
assert camera["kind"] == "CAMERA" and "r1" not in found["products"] and "l2" not in found["products"]
def check(row, **wanted):
    assert row["in"] == "floor" and row["properties"].pop("set") == "ispace_Sensor" and row["shape"]
    assert set(row["properties"]) == set(wanted), (row["properties"], wanted)
    for key, value in wanted.items():
        read = row["properties"][key]
        assert read == value or abs(read - value) < 1e-6, (key, read, value)
check(laser, Kind="laser", Model="urg-04lx", Height=1.2, Heading=45, Tilt=-10, Roll=0, FieldOfView=681 * 0.3515625,
      Range=4.095)
check(camera, Kind="camera", Height=2.3, Heading=-135, Tilt=-25, Roll=5, FieldOfView=60, FieldOfViewVertical=45,
      Range=12)
check(ears, Kind="ultrasound", Height=2.4, Heading=0, Tilt=-90, Roll=0, FieldOfView=90, FieldOfViewVertical=90, Range=6)
# It faces along its axis: the camera's body lies about its position.
assert all(low <= at <= high for low, at, high in zip(camera["shape"]["low"], (7.5, 5.5, 2.3), camera["shape"]["high"]))
END
read_ifc room.ifc >found.json || fail "web-ifc refuses the room"
python3 check.py found.json || fail "web-ifc finds another room"

# One of everything; walls that two rooms share stand once.
for scene in "$scenes"/*.env; do
    envc "$scene" -o scene.ifc 2>/dev/null
    read_ifc scene.ifc >scene.json || fail "web-ifc refuses $scene"
    python3 - scene.json "$scene" <<'END' || fail "web-ifc finds something else in $scene"
import json, sys
found, scene = json.load(open(sys.argv[1])), sys.argv[2]
rows = [row for rows in found["products"].values() for row in rows]
assert len(set(found["guids"])) == len(found["guids"])
assert any(row["class"] == "wall" for row in rows) and any(row["class"] == "space" for row in rows)
for row in rows:
    empty = row["class"] in ("door", "window") and row["object_type"] == "open"
    is_point = row["object_type"] in ("lamp", "speaker")  # these have no size
    assert empty or is_point or row["shape"], row
    in_room = row["object_type"] == "zone" and row["in"].startswith("indoor")
    assert row["class"] == "openingelement" or row["in"] == "floor" or in_room, row
if scene.endswith("catalogue.env"):
    assert {row["class"] for row in rows} >= {"furniture", "column", "covering", "buildingelementproxy", "sensor",
                                              "audiovisualappliance", "door", "window"}
END
done

# The check can fail: without its opening the wall is whole.
grep -v IFCRELVOIDSELEMENT room.ifc >whole.ifc
read_ifc whole.ifc >found.json
if python3 check.py found.json 2>/dev/null; then fail "self-test: a room without openings passes"; fi
