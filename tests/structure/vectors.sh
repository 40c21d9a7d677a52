#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Loops that are compiled for several processors are in their vectors: those of random normals, which only -O3 puts there
# (GCC 12). The results would be the same without, only later.
. "$(dirname "$0")/../pipelines/common.sh"

for program in nm objdump; do
    command -v "$program" >/dev/null || skip "no $program here"
done
[ "$(uname -m)" = x86_64 ] || skip "no x86-64"
! grep -q 'CMAKE_BUILD_TYPE:[A-Z]*=Debug' "$binary_dir/CMakeCache.txt" || skip "no release build"
grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" || skip "sanitizers come without them"

# vectors ARCH REGISTER: the loop for that processor has such registers.
vectors() {
    local name
    name=$(nm "$binary_dir/lib/libispace_base.a" 2>/dev/null | awk '{ print $NF }' | grep "drawSome.*arch_x86_64_$1" | sort | head -n 1)
    [ -n "$name" ] || skip "no loop for x86-64-$1 here"
    objdump -d --no-show-raw-insn --disassemble="$name" "$binary_dir/lib/libispace_base.a" >code
    grep -q "mulps.*$2" code || fail "the loop of random normals for x86-64-$1 is not in vectors"
}
vectors v3 ymm
vectors v4 zmm
