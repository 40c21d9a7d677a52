#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Worlds for Gazebo, read back by libsdformat, and worlds of others, where it has to see the same poses
# as envc does. Sensors as URDF, read back by urdfdom.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"
inputs=$source_dir/lib/extensions/gazebo/golden/inputs

cat >room.env <<'END'
#env 1
fence id=outer path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes thickness=0.2
wall id=thin from=3,4.9 to=3,3.6
inside id=known at=1,1
zone id=a/b at=6.5,1.2 size=2.4,2
floor id=carpet at=2,3.2 size=2.5,2
desk id=d1 at=1.2,4.4 heading=30
cube id=box at=6,4,0.2 heading=30 size=0.5,0.4,0.3
cylinder id=round at=5,2,0.4 size=0.3 height=0.5
cylinder id=oval at=2,1 size=0.4,0.2 height=0.5
END
cat >room.3dm <<'END'
#3dm 1
laser id=l1 at=0.5,0.5 heading=45 range=0.06,4 fov=240 step=0.5 rate=12 sigma=0.01,0.02 bias=0.003
robot id=r1 at=4,2 heading=30 model=pioneer-3dx
laser id=l2 on=r1 at=0.1,0,0.3 heading=90 model=lms200
camera id=c1 at=7,5,2.4 heading=-135 tilt=-30 fov=60 pixels=640,480
ranger id=g1 at=2,2,1 tilt=-10 roll=5
human id=h1 at=5,5
ultrasound id=u1 at=4,4,2.4 tilt=-90
END

envc room.env room.3dm -o room.sdf 2>err
grep -qx 'envc: warning: SDF has no such sensors, so none works in the world: ultrasound (1)' err ||
    fail "nothing said of the ultrasound: $(cat err)"
[ ! -e room.meshes.obj ] || fail "meshes where there are none"
envc room.env room.3dm --to sdf -q >stream.sdf
expect_same room.sdf stream.sdf "a stream differs"

if command -v check_urdf >/dev/null; then
    envc room.env room.3dm -o room.urdf
    check_urdf room.urdf >tree || fail "urdfdom refuses room.urdf: $(cat tree)"
    cat >wanted <<'END'
robot name is: room
---------- Successfully Parsed XML ---------------
root Link: world has 6 child(ren)
    child(1):  c1
        child(1):  c1_optical
    child(2):  g1
        child(1):  g1_optical
    child(3):  h1
    child(4):  l1
    child(5):  r1
        child(1):  l2
        child(2):  r1_left_wheel
        child(3):  r1_right_wheel
    child(6):  u1
END
    diff wanted tree || fail "another tree of links"
    # Positions and angles as urdfdom reads them; dot, which would draw them, is not needed.
    urdf_to_graphviz room.urdf graph >/dev/null 2>&1 || [ -s graph.gv ] || fail "no graph of room.urdf"
    # joint PARENT NAME X Y Z ROLL PITCH YAW
    joint() {
        sed -n "s/^\"$1\" -> \"$2_joint\" \[label=\"xyz: \(.*\) .nrpy: \(.*\)\".*/\1 \2/p" graph.gv |
            awk -v wanted="${*:3}" '{ n += NF == 6; split(wanted, w, " ")
                for (i = 1; i <= 6; i++) if (($i - w[i])^2 > 1e-8) exit 1 } END { exit n != 1 }' ||
            fail "another joint $2: $(grep "$2_joint" graph.gv)"
    }
    joint world l1 0.5 0.5 0.15 0 0 0.785398
    joint world c1 7 5 2.4 0 0.523599 -2.35619
    joint c1 c1_optical 0 0 0 -1.570796 0 -1.570796
    joint world g1 2 2 1 0.0872665 0.174533 0
    joint r1 l2 0.1 0 0.3 0 0 1.570796
    joint r1 r1_left_wheel 0 0.165 0.0975 0 0 0
    joint r1 r1_right_wheel 0 -0.165 0.0975 0 0 0
    [ "$(grep -c 'type="continuous"' room.urdf)" -eq 2 ] || fail "other wheels: $(cat room.urdf)"
    sed -i 's/<child link="l1"/<child link="l9"/' room.urdf
    if check_urdf room.urdf >/dev/null 2>&1; then fail "self-test: a link that is not there passes"; fi
else
    echo "no check_urdf here"
fi

read_sdf=$binary_dir/tests/read_sdf
[ -x "$read_sdf" ] || skip "no libsdformat here"

# sdf_facts WORLD [FOLDER...]: writes its lines to ./facts; the reader must not complain.
sdf_facts() {
    # With its folder: the reader has another road.sdf.
    "$read_sdf" "$PWD/$1" "${@:2}" >facts 2>err || fail "libsdformat refuses $1: $(cat err)"
    [ ! -s err ] || fail "libsdformat complains about $1: $(cat err)"
}
# fact TEXT: a line of it, once.
fact() {
    [ "$(grep -cxF -e "$1" facts)" -eq 1 ] || fail "not once: $1 in
$(grep -F "$(echo "$1" | cut -d' ' -f1-2)" facts)"
}
sdf_facts room.sdf
fact Valid.
fact 'world room'
sed 's/_visual"/"/' room.sdf >twins.sdf
if "$read_sdf" "$PWD/twins.sdf" >facts 2>err; then fail "self-test: a collision and a visual of one name pass"; fi
grep -q 'part1' err || fail "another error: $(cat err)"
sdf_facts room.sdf
# Ground, five things, two walls, no zone and no inside point; five sensors, a robot, a person, with
# the laser on the robot in the robot's model.
[ "$(grep -c '^model' facts)" -eq 14 ] || fail "other models: $(grep '^model' facts)"
[ "$(grep -c '^model.* static ' facts)" -eq 14 ] || fail "something moves"
[ "$(grep -c '^sensor' facts)" -eq 4 ] || fail "other sensors: $(grep '^sensor' facts)"
fact 'collision ground_plane floor at 4.000000 3.000000 0.000000 rpy 0.000000 0.000000 0.000000 plane 10.000000 8.000000'
grep -q '^collision outer part[0-9]* at 8.000000 3.000000 1.250000 rpy 0.000000 0.000000 1.570796 box 6.000000 0.200000 2.500000' facts ||
    fail "no eastern wall: $(grep '^collision outer' facts)"
fact 'collision thin part1 at 3.000000 4.250000 1.250000 rpy 0.000000 0.000000 1.570796 box 1.300000 0.002000 2.500000'
fact 'model d1 static at 1.200000 4.400000 0.000000 rpy 0.000000 0.000000 0.523599'
fact 'collision d1 part1 at 1.200000 4.400000 0.685000 rpy 0.000000 0.000000 0.523599 box 1.200000 0.800000 0.030000'
fact 'model box static at 6.000000 4.000000 0.200000 rpy 0.000000 0.000000 0.523599'
fact 'collision box part1 at 6.000000 4.000000 0.350000 rpy 0.000000 0.000000 0.523599 box 0.500000 0.400000 0.300000'
fact 'collision round part1 at 5.000000 2.000000 0.650000 rpy 0.000000 0.000000 0.000000 cylinder 0.150000 0.500000'
grep -Eqx 'collision oval part1 at 2.000000 1.000000 0.000000 rpy .* polyline [0-9]+ 0.500000' facts ||
    fail "no oval: $(grep oval facts)"
! grep '^collision carpet' facts || fail "a carpet to stumble over"
# 481 beams from -120 to 120 degrees; noise at half the range.
fact 'sensor l1 l1 at 0.500000 0.500000 0.150000 rpy 0.000000 0.000000 0.785398 gpu_lidar rate 12.000000 samples 481 1 from -2.094395 to 2.094395 up 0.000000 0.000000 range 0.060000 4.000000 noise 0.003000 0.050000'
grep -q '^sensor r1 l2 at 4.086603 2.050000 0.300000 rpy 0.000000 0.000000 2.094395 gpu_lidar .* samples 181 1' facts ||
    fail "another l2: $(grep l2 facts)"
grep -q '^sensor c1 c1 at 7.000000 5.000000 2.400000 rpy 0.000000 0.523599 -2.356194 camera .* picture 640 480 fov 1.047198 .* f 554.256258 554.256258 c 320.000000 240.000000' facts ||
    fail "another c1: $(grep c1 facts)"
grep -q '^sensor g1 g1 at 2.000000 2.000000 1.000000 rpy 0.087266 0.174533 0.000000 depth_camera .* picture 176 144 fov 0.829031 clip 0.010000 5.000000' facts ||
    fail "another g1: $(grep g1 facts)"
grep -q '^visual u1 u1_body' facts || fail "no body of u1"

envc room.env room.3dm --add 'mat at=1,2 size=1,1' --add 'gate at=2,2' --to sdf 2>err >more.sdf
grep -q 'in the world: gate (1), mat (1), ultrasound (1)$' err || fail "not all counted: $(cat err)"
# Ids that are reserved names of a world or a link.
envc room.env --add 'cube id=default at=1,2' --add 'robot id=r2 at=5,4' --add 'laser id=part1_visual on=r2 at=0,0,0.3' \
    --add 'laser id=part1 on=r2 at=0,0,0.4' -o names.sdf
sdf_facts names.sdf

# Every scene, and the same floor when envc reads its world.
indoor() { envc "$@" --info --json 2>/dev/null | sed -n 's/.*"indoor_area":\([0-9.e-]*\).*/\1/p'; }
for scene in "$scenes"/*.env; do
    name=$(basename "$scene" .env)
    envc "$scene" -o "$name.sdf" -q
    sdf_facts "$name.sdf"
done
for name in crowded ispace facilities; do
    echo "$(indoor "$scenes/$name.env") $(indoor "$name.sdf")" |
        awk '{ d = $1 - $2; if (NF != 2 || d > 1e-6 || d < -1e-6) exit 1 }' ||
        fail "another floor of $name: $(indoor "$scenes/$name.env"), $(indoor "$name.sdf")"
done

# A mesh is a file beside its world; a stream has no folder for it.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >wedge.obj
envc room.env --add 'mesh id=wedge at=5,3 heading=90 file=wedge.obj' -o mesh.sdf
sdf_facts mesh.sdf
fact 'collision wedge part1 at 0.000000 0.000000 0.000000 rpy 0.000000 0.000000 0.000000 mesh mesh.meshes.obj wedge'
grep -qx 'o wedge' mesh.meshes.obj || fail "no part wedge: $(head mesh.meshes.obj)"
grep -qx 'v 5 4 0' mesh.meshes.obj || fail "another place of wedge: $(cat mesh.meshes.obj)"
expect_error 2 envc room.env --add 'mesh file=wedge.obj' --to sdf
grep -q 'name it with -o FILE.sdf' err || fail "no hint: $(cat err)"

# A world of others: where libsdformat sees boxes and cylinders, envc does.
cp -r "$inputs"/{cabinet,models} .
grep -v 'model://sun' "$inputs/gazebo.sdf" >world.sdf
sdf_facts world.sdf "$PWD" "$PWD/models"
envc world.sdf --to env >world.env 2>/dev/null
# seen MODEL SHAPE KEYWORD ID HEIGHT: the middle of MODEL's shape, HEIGHT high, is that of the record.
seen() {
    local mine its
    mine=$(sed -n "s/^$3 id=$4 at=\([^ ]*\).*/\1/p" world.env | tr , ' ')
    its=$(grep "^collision $1 .* $2 " facts | cut -d' ' -f5-7)
    echo "$mine $its" | awk -v h="$5" '
        { x = NF; d = ($1 - $(NF - 2))^2 + ($2 - $(NF - 1))^2 + ((NF == 6 ? $3 : 0) + h / 2 - $NF)^2
          n += (NF == 5 || NF == 6) && d < 1e-10 } END { exit n != 1 }' ||
        fail "$4 elsewhere: $mine, $its"
}
seen table box cube table 0.04
seen table::leg cylinder cylinder table-2 0.7
seen crate box cube crate 0.5
# Cabinets that are included with drawers that they include.
seen cabinet box cube cabinet 0.9
seen cabinet::left box cube cabinet-2 0.4
seen cabinet::right box cube cabinet-3 0.4
seen other box cube other 0.9
seen other::left box cube other-2 0.4
seen other::right box cube other-3 0.4
grep -q '^wall id=house-5 from=3,0 to=3,2.8 thickness=0.1' world.env || fail "no inner wall: $(cat world.env)"
