#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# No tool links OpenCV or what that draws in (GDAL, and 140 libraries at each start): the module for
# pictures does, which is opened when a picture asks for it.
. "$(dirname "$0")/../pipelines/common.sh"

heavy='libopencv|libgdal'
module=$binary_dir/lib/ispace/pictures.so
ldd "$module" >module.ldd
grep -qE "$heavy" module.ldd || fail "the module for pictures does without OpenCV: $(cat module.ldd)"
for tool in $tools; do
    ldd "$binary_dir/bin/$tool" >tool.ldd
    if grep -E "$heavy" tool.ldd; then fail "$tool links them"; fi
    [ "$(wc -l <tool.ldd)" -le 60 ] || fail "$tool links $(wc -l <tool.ldd) libraries"
done

# Where the module is missing, only pictures that need it are refused, with what to install.
mkdir -p moved/bin
cp "$binary_dir/bin/envc" moved/bin
envc=$scratch/moved/bin/envc
"$envc" "$data/pictures/room.png" --resolution 0.05 --to env >/dev/null
status=0
"$envc" "$data/pictures/room.jpg" --resolution 0.05 --to env >out 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status without the module"
grep -q 'a JPEG picture needs OpenCV (Debian: libopencv-imgcodecs406): .*pictures.so' err ||
    fail "no hint: $(cat err)"
