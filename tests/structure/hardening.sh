#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The hardening of compiler and linker against overruns is in the programs: position-independent, relocations read-only
# from the start, no executable stack, stack canaries, checked calls of libc, checked subscripts of the standard
# library, and landing pads for indirect jumps.
. "$(dirname "$0")/../pipelines/common.sh"

for program in readelf nm objdump; do
    command -v "$program" >/dev/null || skip "no $program here"
done
grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" || skip "sanitizers come without it"

# Each check reports the defects of a program.
headers() {
    readelf -hW "$1" | has 'Type: *DYN' || echo "is not position-independent"
    readelf -lW "$1" >segments
    grep -q GNU_RELRO segments || echo "has no RELRO segment"
    grep -q 'GNU_STACK.* RW ' segments || echo "has an executable stack"
    ! grep -q 'LOAD.* RWE ' segments || echo "has memory that is both writable and executable"
    readelf -dW "$1" | has -E 'BIND_NOW|FLAGS_1.*NOW' || echo "binds functions lazily"
}
calls() {
    nm -D --undefined-only "$1" >imports
    grep -q __stack_chk_fail imports || echo "has no stack canaries"
    grep -qE '__[a-z]+_chk(@|$)' imports || echo "has no checked calls of libc (FORTIFY)"
    grep -q __glibcxx_assert_fail imports || echo "does not check subscripts (_GLIBCXX_ASSERTIONS)"
}
landing_pads() {
    [ "$(uname -m)" = x86_64 ] || return 0
    objdump -d --no-show-raw-insn --section=.text "$1" >code
    grep -q endbr64 code || echo "has no landing pads (CET)"
}

found=0
for program in "$binary_dir"/bin/* "$binary_dir"/lib/ispace/*; do
    [ -f "$program" ] || continue
    [ "$(head -c 2 "$program")" != '#!' ] || continue  # a script
    { headers "$program"; landing_pads "$program"; } >wrong
    # The small modules have no buffers to guard.
    case $program in *.so | */read-picture) ;; *) calls "$program" >>wrong ;; esac
    while read -r line; do
        echo "$(basename "$program") $line" >&2
        found=1
    done <wrong
done
[ "$found" -eq 0 ] || fail "programs without hardening, see above"

# The checks find missing hardening.
if command -v cc >/dev/null; then
    echo 'int main(void) { return 0; }' >plain.c
    cc -no-pie -Wl,-z,lazy,-z,norelro,-z,execstack -fcf-protection=none plain.c -o plain 2>/dev/null ||
        skip "cc makes no unprotected program to compare with"
    [ "$({ headers plain; calls plain; } | wc -l)" -ge 7 ] || fail "the checks find little: $(headers plain; calls plain)"
fi
