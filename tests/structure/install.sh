#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs into a staged folder and works from there: the tools find devices and scenes, man finds the manual, and no
# file points back into the build.
. "$(dirname "$0")/../pipelines/common.sh"

DESTDIR=$scratch/stage cmake --install "$binary_dir" --prefix /opt/ispace >log
mv stage/opt/ispace moved # an installed tree may be moved: no path is compiled in
[ "$(ls stage/opt)" = "" ] || fail "installed elsewhere: $(find stage)"
for tool in $tools ispace ispace-sweep golden-diff; do
    [ -x "moved/bin/$tool" ] || fail "no bin/$tool"
    [ -s "moved/share/man/man1/$tool.1" ] || fail "no man page of $tool"
done
for format in env 3dm yaml; do
    [ -s "moved/share/man/man5/ispace-$format.5" ] || fail "no man page of the format $format"
done
[ -s moved/share/man/man7/ispace-protocol.7 ] || fail "no man page of the protocol"
[ -s moved/share/man/man7/ispace-wire.7 ] || fail "no man page of device ports"
[ -s moved/share/man/man7/ispace-stability.7 ] || fail "no man page of what is stable"
for schema in "$binary_dir"/share/schemas/*.json; do
    cmp "$schema" "moved/share/ispace/schemas/${schema##*/}" || fail "not installed: $schema"
done
if command -v man >/dev/null; then
    for page in $tools ispace ispace-sweep golden-diff ispace-env ispace-3dm ispace-yaml ispace-protocol ispace-wire \
        ispace-ros ispace-stability; do
        man -M moved/share/man -w "$page" >page && grep -q moved "page" ||
            fail "man does not find $page: $(cat page)"
    done
fi
[ "$(ls moved/bin | wc -l)" -eq 8 ] || fail "more than the tools in bin: $(ls moved/bin)"
links=$(cd moved && find . -type l -printf '%p %l\n' | sort | tr '\n' ' ')
[ "$links" = "./bin/arrange ispace ./bin/coverage ispace ./bin/envc ispace ./bin/golden-diff ispace ./bin/scan ispace ./bin/simrun ispace " ] ||
    fail "links installed: $links"

mkdir elsewhere
cd elsewhere
export PATH=$scratch/moved/bin:/usr/bin:/bin
share=$scratch/moved/share/ispace
envc "$share/scenes/ispace.env" -o room.glb
# A device model comes from share/devices.
arrange room.glb --sensor urg-04lx:2 --strategy grid -X 3 -Y 3 -o best.3dm
grep -q 'model=urg-04lx' best.3dm || fail "no device in the layout"
scan room.glb best.3dm | tail -n 1 | has '"ranges":' || fail "no scan"
coverage room.glb best.3dm -o map.png
[ -s map.png ] || fail "no map"
# The module that decodes pictures lies beside the programs.
envc "$data/pictures/room.jpg" --resolution 0.05 --info | has 'indoor area' || fail "no JPEG is read"
envc "$source_dir/lib/extensions/ifc/golden/inputs/ifc/cabin-2x3-mm.ifc" --info | has 'indoor area' || fail "no IFC is read"
# A scene with a mesh beside it.
envc "$share/scenes/catalogue.env" -o catalogue.glb
# A copy of the examples finds the scenes of the installation.
mkdir copied
cp "$share"/examples/*.sh "$share"/examples/drive.txt copied
for example in demo ci cameras; do
    sh "copied/$example.sh" "copy-of-$example" >log 2>&1 || fail "the copied example $example.sh: $(tail -n 3 log)"
done
# ispace-sweep finds its modules, and the drawings of the experiments.
if /usr/bin/python3 -c 'import yaml, matplotlib' 2>/dev/null; then
    cp -r "$share/examples/batch" batch
    cp "$share/scenes/crowded.env" "$share/scenes/l-room.env" batch
    (cd batch && ispace-sweep commands sweep.yaml --shard 1/50 | sh &&
        ispace-sweep plot sweep.yaml --partial -q --x seed -o curves.svg) || fail "no sweep"
    [ -s batch/curves.svg ] || fail "no curves"
fi
if find "$share" -name '*.pyc' | grep .; then fail "compiled files are installed or left"; fi

# Without its share/ a tool reports the missing folder.
rm -rf "$share/devices"
expect_error 1 scan room.glb best.3dm
grep -q devices err || fail "$(cat err)"
