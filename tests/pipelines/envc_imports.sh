#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Plans, maps and meshes that other programs wrote, through arrange and coverage: DXF by ezdxf, PNG
# by GDAL, meshes by assimp, and the real plans and maps in the folder that ISPACE_TEST_DATA names.
. "$(dirname "$0")/common.sh"

# through NAME LOWEST SENSOR: room NAME.glb is looked over, at least LOWEST per cent of it.
through() {
    arrange "$1.glb" --sensor "$3" --strategy grid -X 5 -Y 5 --deg 8 -o "$1.3dm"
    coverage "$1.glb" "$1.3dm" --json -o "$1.png" >"$1.json"
    sed -n 's/.*"coverage":{"grid":\([0-9.e-]*\).*/\1/p' "$1.json" |
        awk -v low="$2" '{ if ($1 * 100 < low || $1 > 1) exit 1; n++ } END { exit n != 1 }' ||
        fail "the coverage of $1 is not as expected: $(cut -c1-600 "$1.json")"
}

# expect_area NAME WANTED TOLERANCE
expect_area() {
    envc "$1.glb" --info --json >"$1.info"
    sed -n 's/.*"indoor_area":\([0-9.e+-]*\).*/\1/p' "$1.info" |
        awk -v w="$2" -v t="$3" '{ d = $1 - w; exit (d > t || d < -t) }' ||
        fail "$1: the indoor area is not $2: $(cat "$1.info")"
}

done_parts=""

# Drawings. The flat's area follows from its geometry, see dxf_plan.py; arcs become chords.
if /usr/bin/python3 -c 'import ezdxf' 2>/dev/null; then
    layers=(--wall-layer 'A-WALL*' --door-layer 'A-DOOR*' --window-layer 'A-GLAZ*')
    for unit in mm cm m inch; do
        /usr/bin/python3 "$source_dir/tests/pipelines/dxf_plan.py" "flat_$unit.dxf" "$unit"
        envc "flat_$unit.dxf" "${layers[@]}" -o "flat_$unit.glb"
        expect_area "flat_$unit" 49.1597 0.01
    done
    envc flat_mm.dxf "${layers[@]}" --to env >flat.env
    [ "$(grep -c '^door ' flat.env)" -eq 2 ] || fail "not the flat's two doors: $(cat flat.env)"
    [ "$(grep -c '^window ' flat.env)" -eq 2 ] || fail "not the flat's two windows"
    through flat_mm 60 laser,range=6,fov=270:3
    envc flat_mm.dxf --wall-layer 'A-WALL*' --to env >walls.env
    [ "$(grep -c '^door ' walls.env)" -eq 2 ] || fail "a layer with the name of doors holds none: $(cat walls.env)"
    done_parts+=" dxf"
fi

# Meshes: assimp reads our exports, writes them in its other formats, and envc puts these into a room.
if command -v assimp >/dev/null; then
    printf '%s\n' '#env 1' 'ispace size=6,6' 'mesh id=steps at=1,1 heading=90 file=steps.obj' >room.env
    printf '%s\n' '#env 1' 'ispace size=6,6' >bare.env
    cp "$scenes/meshes/steps.obj" .
    envc room.env -o want.glb
    envc want.glb --slice 0.3 --to geojson | grep -v history >want.slice
    for format in stl ply dae glb; do
        assimp export steps.obj "steps.$format" >assimp.log || fail "assimp writes no $format"
        up=auto
        # assimp copies the axes of an OBJ unchanged into formats whose y points up.
        case $format in glb | dae) up=z ;; esac
        sed "s/steps.obj/steps.$format up=$up/" room.env >"$format.env"
        envc "$format.env" -o "$format.glb"
        envc "$format.glb" --info >"$format.info"
        grep -q 'free area *35.190 m2' "$format.info" || fail "$format: $(cat "$format.info")"
        envc bare.env "steps.$format" --up $up --to env | has "^mesh .*file=steps.$format" ||
            fail "$format is no operand"
    done
    # The model holds the mesh: the file may go.
    rm steps.*
    envc want.glb --slice 0.3 --to geojson | grep -v history | cmp - want.slice || fail "the mesh was lost"
    through want 90 laser,range=6,fov=270:2
    done_parts+=" meshes"
fi

# A map of ARIA as its mapper writes it, with a forbidden area and points.
cat >office.map <<'END'
2D-Map
LineMinPos: -2000 -1500
LineMaxPos: 4000 2500
NumLines: 5
MinPos: -2000 -1500
MaxPos: 4000 2500
NumPoints: 3
PointsAreSorted: false
Resolution: 20
LineDensities: 5 5 5 5 5
Cairn: ForbiddenArea 0 0 0.000000 "" ICON "stairs" 2000 0 3000 1500
Cairn: RobotHome -1000 0 90.000000 "" ICON "dock"
LINES
-2000 -1500 4000 -1500
4000 -1500 4000 2500
4000 2500 -2000 2500
-2000 2500 -2000 -1500
1000 -1500 1000 500
DATA
3000 -1000
3020 -1000
3040 -1000
END
envc office.map -o office.glb
expect_area office 24 1e-6
envc office.map --to env >office.env
grep -q '^zone id=forbidden-stairs' office.env || fail "no zone of the forbidden area: $(cat office.env)"
through office 90 laser,range=6,fov=270:2
envc office.map --points --info | has 'free area *23.9[0-9]* m2' || fail "points are no obstacles"

data_dir=${ISPACE_TEST_DATA:-}
if [ -n "$data_dir" ] && [ -d "$data_dir/plans" ]; then
    for plan in he_0a1b29db_raw:116.6:0.05:40 syn_03:45:0.05:60 syn_10:164.2:0.05:30 syn_20:4404.6:0.05:1; do
        IFS=: read -r name area tolerance lowest <<<"$plan"
        envc "$data_dir/plans/$name.json" -o "$name.glb"
        expect_area "$name" "$area" "$tolerance"
        through "$name" "$lowest" laser,range=6,fov=270:3
    done
    done_parts+=" plans"
fi
if [ -n "$data_dir" ] && command -v gdal_translate >/dev/null; then
    # The same map with its picture as PNG.
    gdal_translate -q -of PNG "$data_dir/turtlebot3.pgm" turtlebot3.png
    sed 's/turtlebot3.pgm/turtlebot3.png/' "$data_dir/turtlebot3.yaml" >turtlebot3.yaml
    envc "$data_dir/turtlebot3.yaml" --to env | grep -v '^#' >pgm.env
    envc turtlebot3.yaml --to env | grep -v '^#' >png.env
    expect_same pgm.env png.env "the map with a PNG picture is another"
    done_parts+=" png"
fi
echo "imported: aria$done_parts"

# A model of ours holds the bodies of sensors, not their views.
printf '#env 1\nispace size=4,4\n' >inner.env
printf '#3dm 1\nranger at=-1,0.3,1 range=3\nlaser at=0,0 range=3\n' >inner.3dm
envc inner.env inner.3dm -o inner.glb
printf '#env 1\nispace size=20,20\nmesh file=inner.glb\n' >outer.env
printf '#3dm 1\nlaser at=1,0.3,2.4 tilt=-90 fov=0\n' | scan outer.env | has '"ranges":\[2.4\]' ||
    fail "a view of a sensor stops a beam"
