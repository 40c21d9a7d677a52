#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A picture has the same pixels on every machine, or the tool fails: no other picture without a font or after the end of
# memory.
. "$(dirname "$0")/common.sh"

cat >scene.3dm <<'EOF'
#3dm 1
laser id=l1 at=1,1 heading=45 range=4 fov=180
EOF
draw() {  # draw FOLDER
    mkdir -p "$1"
    coverage "$scenes/crowded.env" scene.3dm --grid 40 -o "$1/map.png" &&
        coverage "$scenes/crowded.env" scene.3dm --grid 40 -o "$1/map.pdf" &&
        envc "$scenes/catalogue.env" -o "$1/plan.png"
}
draw wanted 2>err || fail "cannot draw: $(cat err)"

# Installed fonts and their configuration have no effect.
echo '<fontconfig/>' >no-fonts.conf
FONTCONFIG_FILE=$scratch/no-fonts.conf draw without 2>err || fail "cannot draw without fonts: $(cat err)"
FONTCONFIG_FILE=/nonexistent FONTCONFIG_PATH=/nonexistent HOME=/nonexistent draw broken 2>err ||
    fail "cannot draw with a broken fontconfig: $(cat err)"
for other in without broken; do
    diff -r wanted $other || fail "pictures depend on the machine's fonts ($other)"
done

# Sanitizers reserve address space.
grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" || exit 0
drawn=0 refused=0
for megabytes in $(seq 40 12 400); do
    rm -f limited.png
    status=0
    (ulimit -v $((megabytes * 1024)) && exec envc "$scenes/catalogue.env" -o limited.png) \
        >out 2>err || status=$?
    if [ "$status" -eq 0 ]; then
        expect_same wanted/plan.png limited.png "another picture under $megabytes MB"
        drawn=$((drawn + 1))
    else
        [ ! -e limited.png ] || fail "status $status, but a picture, under $megabytes MB"
        refused=$((refused + 1))
    fi
done
[ "$drawn" -gt 0 ] || fail "no limit was enough"
[ "$refused" -gt 0 ] || fail "each limit was enough"
