#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# cameras.sh [FOLDER]: computes the floor that four dome cameras on the ceiling of an office see, the number that sees
# 90 % of it, and the number that recognises people there; each answer with its proof. Requires the tools in PATH;
# writes its files to FOLDER (default: ispace-cameras).
set -eu
unset CDPATH
examples=$(cd "$(dirname "$0")" && pwd)
# Beside the examples, or in a copy of them those of the installation.
scenes=$examples/../scenes
[ -e "$scenes/ispace.env" ] || scenes=$(dirname "$(readlink -f "$(command -v ispace)")")/../share/ispace/scenes
office=$scenes/open-office.env
mkdir -p "${1:-ispace-cameras}"
cd "${1:-ispace-cameras}"
dome=dome-2.8-1080p,fov=110
exactly="--candidates 1,1,8 --optimize exact"

run() {
    echo "\$ $*"
    "$@" 2>&1
}

run envc "$office" -o office.glb
run arrange office.glb --sensor $dome:4 $exactly -o four.3dm
run arrange office.glb --sensor $dome $exactly --target 90% -o most.3dm
run arrange office.glb --sensor $dome $exactly --target 90% --density recognise -o recognise.3dm
coverage office.glb recognise.3dm --density recognise -o recognise.png >recognise.txt

# Coverage of a layout, and its number of cameras.
share() { LC_ALL=C printf '%.2f %%' "$(sed -n 's/^result coverage=\([^%]*\)%.*/\1/p' "$1")"; }
count() { grep -c '^camera' "$1"; }
echo
echo "four domes of 110 degrees see $(share four.3dm) of the floor; $(count most.3dm) see $(share most.3dm)"
echo "to recognise people on 90 % of it takes $(count recognise.3dm): $(share recognise.3dm)"
