#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Systems beside Debian 12: warnings of other compilers end no build, and each library that is linked statically has the
# name of a shared one to fall back to.
. "$(dirname "$0")/../pipelines/common.sh"

mkdir bin
for version in 12 12.2.0 14 18.1.3; do
    printf '#!/bin/sh\necho %s\n' "$version" >bin/c++
    chmod +x bin/c++
    wanted=$(case $version in 12*) echo ON ;; *) echo OFF ;; esac)
    env -u CXX PATH="$scratch/bin:$PATH" make -C "$source_dir" -n demo BUILD="$scratch/build" >commands
    grep -q -- "-DISPACE_WERROR=$wanted " commands || fail "compiler $version: $(grep WERROR commands)"
done

# strict TREE: the searches for an archive that have no other name.
strict() { grep -rhE --include=CMakeLists.txt 'find_library\(.*lib[a-z0-9]*\.a' "$1"/CMakeLists.txt "$1"/lib "$1"/tools | grep -vE 'NAMES lib([a-z0-9]*)\.a \1 ' || true; }
[ -z "$(strict "$source_dir")" ] || fail "no shared library to fall back to: $(strict "$source_dir")"
mkdir -p small/lib small/tools
printf 'find_library(GLPK_STATIC libglpk.a REQUIRED)\n' >small/CMakeLists.txt
[ -n "$(strict small)" ] || fail "self-test: a library without another name passes"
