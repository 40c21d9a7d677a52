#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Each library costs time at every start: OpenCV's core and imgproc with the 15 they need some 4 ms,
# its imgcodecs, with GDAL and 140 more, 59 ms; Cairo, with those of X11 and fonts, 1.7 ms. So no tool
# links them: modules do, which are opened when a picture is drawn, or written as JPEG, or ROS 2 is spoken. No tool links
# assimp or decodes with OpenCV, which some files make crash: programs do that are started for each file.
. "$(dirname "$0")/../pipelines/common.sh"

heavy='libddsc|libiceoryx|libopencv|libGL|liblapack|libgdal|libcrypto|libcairo|libX11|libfontconfig|libfreetype'
max_libraries=16
# Where a static library needs others, its shared one and they come on top.
shared=$(grep -cE '^[A-Z0-9]+_STATIC:FILEPATH=.*\.so' "$binary_dir/CMakeCache.txt" || true)
max_libraries=$((max_libraries + 2 * shared))
module=$binary_dir/lib/ispace/pictures.so
ldd "$module" >module.ldd
grep -q libopencv_imgcodecs module.ldd || fail "the module for pictures does without OpenCV: $(cat module.ldd)"
ldd "$binary_dir/lib/ispace/drawing.so" >module.ldd
grep -q libcairo module.ldd || fail "the module for drawing does without Cairo: $(cat module.ldd)"
ldd "$binary_dir/lib/ispace/read-picture" >module.ldd
grep -q libopencv_imgcodecs module.ldd || fail "read-picture does without OpenCV"
ldd "$binary_dir/lib/ispace/read-mesh" >module.ldd
grep -q libassimp module.ldd || fail "read-mesh does without assimp"
for tool in $tools; do
    ldd "$binary_dir/bin/$tool" >tool.ldd
    if grep -E "$heavy|libassimp" tool.ldd; then fail "$tool links them"; fi
    [ "$(wc -l <tool.ldd)" -le $max_libraries ] ||
        fail "$tool links $(wc -l <tool.ldd) libraries, at most $max_libraries are meant: $(cat tool.ldd)"
done

# Without the module the tools reject only pictures that require it, and name the package to install.
mkdir -p moved/bin
cp -L "$binary_dir/bin/envc" moved/bin
envc=$scratch/moved/bin/envc
"$envc" "$data/pictures/room.png" --resolution 0.05 --to env >/dev/null
status=0
"$envc" "$data/pictures/room.jpg" --resolution 0.05 --to env >out 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status without the module"
grep -q 'JPEG pictures are read by .*lib/ispace/read-picture, .*OpenCV is needed (Debian: libopencv-imgcodecs[0-9]*)' err ||
    fail "no hint: $(cat err)"
package=$(sed -n 's/.*(Debian: \([^)]*\)).*/\1/p' err)
! command -v dpkg-query >/dev/null || dpkg-query -W "$package" >/dev/null || fail "no package $package here"
"$envc" "$data/room.env" --to glb -o room.glb
status=0
"$envc" "$data/room.env" --to svg >out 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status without the module for drawing"
grep -q 'drawing needs Cairo (Debian: libcairo2): .*drawing.so' err || fail "no hint: $(cat err)"

# The same for the module that speaks DDS.
if [ -e "$binary_dir/lib/ispace/dds.so" ]; then
    ldd "$binary_dir/lib/ispace/dds.so" >module.ldd
    grep -q libddsc module.ldd || fail "the module for DDS does without Cyclone: $(cat module.ldd)"
fi
cp -L "$binary_dir/bin/simrun" moved/bin
mkdir moved/share
ln -s "$source_dir/share" moved/share/ispace
status=0
"$scratch/moved/bin/simrun" "$data/room.env" --ros2 --until 0 >out 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status without the module for DDS"
grep -q 'ros2 needs Cyclone DDS (Debian: libddsc0debian): .*dds.so' err || fail "no hint: $(cat err)"

# The same for the program that reads meshes, when one is met.
"$envc" "$data/room.env" --to env >/dev/null
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >chair.obj
status=0
"$envc" chair.obj --to stl >out 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status without read-mesh"
grep -q 'meshes are read by .*lib/ispace/read-mesh, which cannot be started: No such file' err ||
    fail "no hint: $(cat err)"
