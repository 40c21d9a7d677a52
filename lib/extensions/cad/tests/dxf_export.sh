#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Drawings in DXF by envc and coverage, read by ezdxf, GDAL and envc.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

cat >room.env <<'END'
#env 1
fence id=outer path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes thickness=0.2
wall id=thin from=3,5 to=3,3.6
inside id=known at=1,1
zone id=corner at=6.5,1.2 size=2.4,2
floor id=carpet at=2,3.2 size=2.5,2
desk id=d1 at=1.2,4.4 heading=30
table id=t1 at=4.2,4.6
door id=in at=0,2 open=yes
window id=view at=5,0
END
cat >room.3dm <<'END'
#3dm 1
laser id=l1 at=0.5,0.5 heading=45 range=4
laser id=l2 at=7,5 heading=-120 range=5
robot id=r1 at=4,2 heading=30 model=pioneer-3dx
human id=h1 at=5,5
mat id=m1 at=2,2
gate id=g1 at=6,3
END

envc room.env room.3dm -o room.dxf
envc room.env room.3dm --to dxf >stream.dxf
expect_same room.dxf stream.dxf "a stream differs"
coverage room.env room.3dm -o map.dxf --json >report.json
envc room.env --slice 0.3 -o slice.dxf

# Our own reader knows the layers: the same room.
# figure KEY FILE: a number of a report
figure() { grep -o "\"$1\":[0-9.e-]*" "$2" | sed -n 1p | cut -d: -f2; }
# same KEY WANTED FOUND: the figure of two reports, to a millionth
same() {
    echo "$(figure "$1" "$2") $(figure "$1" "$3")" |
        awk '{ d = $1 - $2; e = 1e-6 * $1; if (NF != 2 || d > e || d < -e) exit 1 }' ||
        fail "$3: another $1: $(figure "$1" "$3"), not $(figure "$1" "$2")"
}
for drawing in room map; do
    envc "$drawing.dxf" --info --json >again.json
    envc room.env --info --json >want.json
    for key in indoor_area free_area perimeter door window; do same "$key" want.json again.json; done
    grep -q '"cube":5,"cylinder":3' again.json || fail "$drawing.dxf: another desk or table: $(cat again.json)"
done
envc room.dxf --to env >again.env
grep -q '^fence .*thickness=0.2' again.env || fail "no thick walls: $(cat again.env)"
grep -q '^door .*open=yes' again.env || fail "no open door: $(cat again.env)"
envc room.env --set in.open=no --to dxf | envc - --to env | grep '^door .*open=yes' && fail "a shut door opens"

# All scenes that come with ispace; of the mesh in catalogue.env there is the box around it.
for scene in "$scenes"/*.env "$scenes/office.yaml"; do
    envc "$scene" --info --json >want.json 2>/dev/null
    envc "$scene" -q -o scene.dxf
    envc scene.dxf --info --json >again.json
    same indoor_area want.json again.json
    [ "$(basename "$scene")" = catalogue.env ] || same free_area want.json again.json
    for key in door window zone floor; do
        [ -z "$(figure "$key" want.json)" ] || same "$key" want.json again.json
    done
done

# A door as deep as two fences and the space between them joins two rooms; the inside point lies in the smaller one.
cat >deep.env <<'END'
#env 1
fence id=out path=0,0;8,0;8,5;0,5 closed=yes
fence id=a path=0.3,0.3;3.35,0.3;3.35,4.7;0.3,4.7 closed=yes
fence id=b path=3.65,0.3;6.7,0.3;6.7,4.7;3.65,4.7 closed=yes
fence id=c path=7,0.3;7.7,0.3;7.7,4.7;7,4.7 closed=yes
door id=d from=3.35,2 to=3.35,2.9 size=0.9,0.7 open=yes
inside at=1,1
inside at=7.5,1
END
# expect_again ROOM: the same room through DXF
expect_again() {
    envc "$1" --info --json >want.json
    envc "$1" -q -o again.dxf
    envc again.dxf --info --json >again.json
    for key in indoor_area free_area perimeter inside; do same "$key" want.json again.json; done
}
expect_again deep.env
grep -q '"indoor_area":30.19' want.json || fail "the door does not join the rooms: $(cat want.json)"
envc again.dxf --to env | has '^door .* size=0.9,0.7 ' || fail "a door lost its depth: $(envc again.dxf --to env)"
for building in "$source_dir"/lib/extensions/ifc/golden/inputs/ifc/[ch]*.ifc ${ISPACE_TEST_DATA:+"$ISPACE_TEST_DATA"/strangers/ifc/*.ifc}; do
    case $building in
    *duplex*) storey=(--storey level-1) ;;
    *fzk*) storey=(--storey erdgeschoss) ;;
    *) storey=() ;;
    esac
    envc "$building" "${storey[@]}" -q -o building.glb 2>/dev/null
    expect_again building.glb
done
cat >stacked.env <<'END'
#env 1
ispace id=w size=6,4
window wall=w from=1,-2 to=2,-2 height=0.8 sill=0.1
window wall=w from=1,-2 to=2,-2 height=0.7 sill=0.9
inside at=0,0
END
expect_again stacked.env
envc stacked.env --to dxf | envc - --info | has 'window 2' || fail "a window above another is lost"

# Layers can be told, as of any drawing.
envc room.dxf --wall-layer walls --door-layer doors --window-layer windows --info --json >again.json
! grep -q cube again.json || fail "layers are not those that are told: $(cat again.json)"

if /usr/bin/python3 -c 'import ezdxf' 2>/dev/null; then
    facts() { /usr/bin/python3 "$source_dir/lib/extensions/cad/tests/dxf_facts.py" "$1.dxf" >facts || fail "$1.dxf"; }
    fact() { grep -qxF -e "$1" facts || fail "not there: $1 in $(cat facts)"; }
    facts room
    fact 'unit 6'
    fact 'errors 0'
    fact 'wall True 0.200 6'
    fact 'wall False 0.000 2'
    fact 'solid LWPOLYLINE 0.670 0.030'
    fact 'solid CIRCLE 0.670 0.030'
    for line in 'doors LWPOLYLINE 1' 'windows LWPOLYLINE 1' 'zones LWPOLYLINE 1' 'floors LWPOLYLINE 1' \
        'objects CIRCLE 3' 'objects LWPOLYLINE 5' 'views LWPOLYLINE 2' 'robots CIRCLE 1' \
        'text sensors l1' 'text names corner' 'text robots h1'; do
        fact "$line"
    done
    facts slice
    fact 'errors 0'
    fact 'obstacles LINE 1'
    want=$(envc room.env --slice 0.3 --to geojson | grep -o '"keyword":"free"[^}]*"area":[0-9.]*' | sed 's/.*://' |
        awk '{ sum += $1 } END { printf "%.6f", sum }')
    fact "area free $want"
    facts map
    fact 'errors 0'
    fact 'views LWPOLYLINE 3'
    # The fillings have the areas of the report: shares of the indoor floor by how many see it. Their
    # chords are within 0.1 mm of the arcs.
    python3 - <<'END' || fail "other areas: $(grep area facts) $(cat report.json)"
import json
report = json.load(open("report.json"))
areas = {line.split()[1]: float(line.split()[2]) for line in open("facts") if line.startswith("area")}
shares = report["redundancy_exact"]
assert len(shares) >= 2 and shares[1] > 0.1, shares
for times, share in enumerate(shares):
    layer = f"seen-{times}" if times else "unseen"
    assert abs(areas.get(layer, 0) - share * report["indoor_area"]) < 2e-3, (layer, areas, shares)
END
else
    echo "no ezdxf here"
fi

if command -v ogrinfo >/dev/null; then
    ogrinfo -ro -al map.dxf >features 2>&1 || fail "GDAL refuses map.dxf: $(cat features)"
    ! grep -qi 'warning\|error' features || fail "GDAL complains: $(grep -i 'warn\|err' features)"
    for layer in walls doors windows objects sensors views seen-1 unseen; do
        grep -q "Layer (String) = $layer\$" features || fail "GDAL sees no layer $layer"
    done
    grep -A20 'Layer (String) = seen-1$' features | has '^  \(MULTI\)\?POLYGON' ||
        fail "GDAL sees no area on seen-1"
else
    echo "no ogrinfo here"
fi
