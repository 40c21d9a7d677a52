#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Exports of envc, read by programs that others wrote: assimp, librsvg, GDAL, libxml.
. "$(dirname "$0")/common.sh"

cat >room.env <<'END'
#env 1
fence id=outer path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes thickness=0.2
wall id=thin from=3,4.9 to=3,3.6
inside id=known at=1,1
zone id=a/b at=6.5,1.2 size=2.4,2
floor id=carpet at=2,3.2 size=2.5,2 kind=checker
desk id=d1 at=1.2,4.4
table id=t1 at=4.2,4.6
cube id=box at=6,4 heading=30 size=0.5,0.4,0.3
door id=in at=0,2
window id=view at=5,0
END
cat >room.3dm <<'END'
#3dm 1
laser id=l1 at=0.5,0.5 heading=45 model=urg-04lx
robot id=r1 at=4,2 heading=30
END
# Of elements, without the known inside point and the zone, which have no body; floor, l1, r1.
nodes="outer thin carpet d1 t1 box in view floor l1 r1"

# The suffix chooses the format; the same as a stream.
for format in obj stl geojson svg png pdf; do
    expect_status 0 envc room.env room.3dm -o "room.$format"
    [ ! -s err ] || fail "talk without being asked: $(cat err)"
    envc room.env room.3dm -o "again.$format"
    [ "$format" = obj ] || expect_same "room.$format" "again.$format" "$format differs"
done
[ -e room.mtl ] || fail "no materials beside room.obj"
head -n 1 room.obj | has 'y up' || fail "room.obj does not name its axes: $(head -n 2 room.obj)"

# Our own reader finds the walls of an OBJ where they were, and in it a mesh that stands upright.
envc "$scenes/l-room.env" -q -o l.obj
envc "$scenes/l-room.env" --info --json >want.json
envc l.obj --up y --slice-walls 1 --info --json >again.json
for key in limits indoor_area perimeter; do
    part=$(grep -o "\"$key\":[^a-z]*" want.json)
    grep -qF "$part" again.json || fail "another room in l.obj: $(cat again.json), not $part"
done
printf '%s\n' '#env 1' 'ispace size=20,20' 'mesh file=l.obj up=y at=0,0' >upright.env
envc upright.env --info --json | has '"height":2.5,' || fail "l.obj lies: $(envc upright.env --info)"

# figure FILE LABEL: of `assimp info`
figure() {
    assimp info "$1" | sed -n "s/^$2: *//p" | sed -n 1p
}
if command -v assimp >/dev/null; then
    for format in obj stl; do
        assimp info "room.$format" >facts 2>&1 || fail "assimp refuses room.$format: $(tail -n 3 facts)"
        # Limits of the room with its walls, 0.1 m beyond the mid-lines: z is up in STL, y in OBJ.
        corner='(-0.1.* -0.1.* 0'
        [ "$format" = stl ] || corner='(-0.1[0-9]* 0[0-9.]* -6.1'
        sed -n 's/^Minimum point *//p' facts | has "$corner" ||
            fail "another corner of room.$format: $(grep '^M.*point' facts)"
    done
    assimp info room.obj >facts 2>/dev/null
    for node in $nodes; do
        grep -q "╴$node " facts || fail "assimp sees no $node in room.obj: $(tail -n 20 facts)"
    done
    grep -q "'wood'" facts || fail "assimp finds no materials: $(cat facts)"
    [ "$(figure room.obj Faces)" -gt 100 ] || fail "few faces in room.obj"
    [ "$(figure room.obj Faces)" = "$(figure room.stl Faces)" ] ||
        fail "OBJ and STL differ: $(figure room.obj Faces), $(figure room.stl Faces) faces"
    # The model has y up, as the OBJ.
    envc room.env -o bare.glb
    assimp info bare.glb >facts 2>&1 || fail "assimp refuses bare.glb: $(tail -n 3 facts)"
    sed -n 's/^Minimum point *//p' facts | has '(-0.1[0-9]* 0[0-9.]* -6.1' || fail "$(grep '^M.*point' facts)"
    envc room.env room.3dm -o room.glb
    assimp info room.glb >facts 2>&1 || fail "assimp refuses room.glb: $(tail -n 3 facts)"
    for node in $nodes; do
        grep -q "╴$node " facts || fail "assimp sees no $node in room.glb: $(tail -n 20 facts)"
    done
    # Only glTF holds the views of lasers: without them the formats have as many faces.
    [ "$(figure room.glb Faces)" -gt "$(figure room.stl Faces)" ] || fail "GLB without the fan of l1"
    sed '/^laser/d' room.3dm >robot.3dm
    for format in glb stl; do envc room.env robot.3dm -o "robot.$format"; done
    [ "$(figure robot.glb Faces)" = "$(figure robot.stl Faces)" ] ||
        fail "GLB and STL differ: $(figure robot.glb Faces), $(figure robot.stl Faces) faces"
    # The check can fail: half a file is refused.
    head -c 1000 room.stl >half.stl
    if assimp info half.stl >/dev/null 2>&1; then fail "self-test: half an STL passes"; fi
else
    echo "no assimp here"
fi

# png_size FILE: width and height
png_size() {
    od -An -tu1 -j16 -N8 "$1" | awk '{ print ($3 * 256) + $4, ($7 * 256) + $8 }'
}
head -c 8 room.png | cmp - <(printf '\211PNG\r\n\032\n') || fail "no PNG"
[ "$(png_size room.png | cut -d' ' -f1)" = 1200 ] || fail "not 1200 pixels: $(png_size room.png)"
if command -v xmllint >/dev/null; then
    xmllint --noout room.svg || fail "room.svg is no XML"
fi
if command -v rsvg-convert >/dev/null; then
    rsvg-convert -w 800 room.svg -o drawn.png || fail "librsvg refuses room.svg"
    # Width to height as the svg says, in millimetres.
    sed -n 's/^<svg .* width="\([0-9.]*\)mm" height="\([0-9.]*\)mm".*/\1 \2/p' room.svg >millimetres
    paste -d' ' millimetres <(png_size drawn.png) |
        awk '{ d = $1 / $2 - $3 / $4; if (NF != 4 || d > 0.01 || d < -0.01) exit 1; n++ }
             END { exit n != 1 }' ||
        fail "another shape: $(cat millimetres) mm, drawn $(png_size drawn.png)"
    # Not blank: an empty page of that size takes a few hundred bytes.
    [ "$(wc -c <drawn.png)" -gt 10000 ] || fail "a blank drawing"
else
    echo "no rsvg-convert here"
fi
# The same drawing as PDF, on a page of the same size (points of 1/72 inch).
head -c 5 room.pdf | has '^%PDF-' || fail "no PDF"
if command -v pdfinfo >/dev/null && [ -s millimetres ]; then
    paste -d' ' millimetres <(pdfinfo room.pdf | sed -n 's/^Page size: *\([0-9.]*\) x \([0-9.]*\) pts.*/\1 \2/p') |
        awk '{ x = $3 / 72 * 25.4 - $1; y = $4 / 72 * 25.4 - $2; n += NF == 4 && x * x + y * y < 0.1 }
             END { exit n != 1 }' ||
        fail "not to scale: $(cat millimetres) mm, $(pdfinfo room.pdf | grep '^Page size')"
fi
for layer in floor zones objects walls sensors robots; do
    grep -q "inkscape:groupmode=\"layer\" inkscape:label=\"$layer\"" room.svg ||
        fail "no layer $layer in room.svg"
done
for id in outer d1 a_b l1 r1; do
    grep -q "<g id=\"$id\"><title>" room.svg || fail "no group $id in room.svg"
done

if command -v ogrinfo >/dev/null; then
    ogrinfo -al -so room.geojson >facts 2>&1 || fail "GDAL refuses room.geojson: $(cat facts)"
    # The indoor region, its free floor, eleven elements, two placed.
    count=$(sed -n 's/^Feature Count: //p' facts)
    [ "$count" -ge 14 ] || fail "GDAL sees $count features: $(cat facts)"
    ogrinfo -al -q room.geojson >features 2>&1
    # geometry ID KIND
    geometry() {
        awk -v id="$1" '/^OGRFeature/ { here = 0 } $1 == "id" && $4 == id { here = 1 }
                        here && /^  [A-Z]+ \(/ { print $1 }' features | has -x "$2" ||
            fail "GDAL sees no $2 for $1: $(grep -A30 "= $1$" features | head -n 40)"
    }
    geometry indoor POLYGON
    geometry outer LINESTRING
    geometry thin LINESTRING
    geometry in LINESTRING
    geometry view LINESTRING
    geometry known POINT
    geometry a/b POLYGON
    geometry d1 POLYGON
    geometry l1 POINT
    geometry r1 POINT
    # Metres of the room, no degrees of WGS 84, in which it would lie in the Gulf of Guinea.
    grep -q '^ENGCRS\["room"' facts && grep -q 'LENGTHUNIT\["metre",1\]' facts && ! grep -q GEOGCRS facts ||
        fail "GDAL sees another frame: $(cat facts)"
    ! grep -qi 'warning\|error' facts features || fail "GDAL complains: $(grep -i 'warn\|err' facts)"
else
    echo "no ogrinfo here"
fi
grep -q '"coordinate_system":"local-metres"' room.geojson || fail "GeoJSON does not say that it is local"

# The obstacle map at a height: beside the table's foot there is floor, at its top not.
for format in geojson svg png pdf; do
    expect_status 0 envc room.env --slice 0.3 -o "slice.$format"
done
expect_status 0 envc room.env --slice 0.69 -o high.geojson
grep -q '"id":"d1"' slice.geojson || fail "no legs of the desk at 0.3 m"
[ "$(grep -o '"id":"d1"' slice.geojson | wc -l)" -eq 4 ] || fail "not four legs at 0.3 m"
[ "$(grep -o '"id":"d1"' high.geojson | wc -l)" -eq 1 ] || fail "not one board at 0.69 m"
! grep -q '"id":"box"' high.geojson || fail "a box of 0.3 m at 0.69 m"

# ROS: the map comes back as the same room.
expect_status 0 envc room.env --to ros -o map.yaml
[ -e map.pgm ] || fail "no picture beside map.yaml"
grep -q '^free_thresh: 0.196$' map.yaml || fail "another free_thresh: $(cat map.yaml)"
grep -q '^image: map.pgm$' map.yaml || fail "another picture: $(cat map.yaml)"
envc map.yaml --info --json >again.json
envc room.env --info --json >room.json
# "free_area":…, to within a cell along the walls
for file in room again; do
    sed -n 's/.*"free_area":\([0-9.e-]*\).*/\1/p' $file.json
done | paste -sd' ' | awk '{ d = $1 - $2; if (NF != 2 || d > 1.5 || d < -1.5) exit 1 }' ||
    fail "another free area: $(cat room.json again.json)"
