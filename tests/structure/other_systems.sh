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

# strict TREE: the searches for an archive beside ispace_find_static(), which falls back to a shared library.
strict() { grep -rhE --include=CMakeLists.txt 'find_library\(.*lib[a-z0-9]*\.a' "$1"/CMakeLists.txt "$1"/lib "$1"/tools || true; }
[ -z "$(strict "$source_dir")" ] || fail "no shared library to fall back to: $(strict "$source_dir")"
mkdir -p small/lib small/tools
printf 'find_library(GLPK_STATIC libglpk.a REQUIRED)\n' >small/CMakeLists.txt
[ -n "$(strict small)" ] || fail "self-test: a library without another name passes"

# The function itself, with an archive that refers to a library that is not there.
command -v cmake >/dev/null && command -v c++ >/dev/null && command -v ar >/dev/null || skip "no compiler here"
mkdir -p probe/lib
{
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(probe LANGUAGES CXX)\ninclude(CheckFunctionExists)\n'
    sed -n '/^function(ispace_find_static/,/^endfunction/p' "$source_dir/CMakeLists.txt"
    printf 'ispace_find_static(WHOLE whole whole)\nispace_find_static(PART part part)\n'
} >probe/CMakeLists.txt
echo 'extern "C" int missing(); extern "C" int part() { return missing(); }' >part.cc
echo 'extern "C" int whole() { return 1; }' >whole.cc
for name in part whole; do
    c++ -c -fPIC $name.cc -o $name.o
    ar rc probe/lib/lib$name.a $name.o
done
found() { cmake -S probe -B probe/build -DCMAKE_LIBRARY_PATH="$PWD/probe/lib" >out 2>&1; }
! found && tr -s ' \n' ' ' <out | grep -q 'libpart.a needs further libraries, and there is no shared one' || fail "no shared library: $(cat out)"
c++ -shared whole.o -o probe/lib/libpart.so
for time in first second; do
    found || fail "the $time time: $(cat out)"
    grep -q 'WHOLE:FILEPATH=.*/libwhole\.a$' probe/build/CMakeCache.txt &&
        grep -q 'PART:FILEPATH=.*/libpart\.so$' probe/build/CMakeCache.txt || fail "the $time time: $(grep FILEPATH probe/build/CMakeCache.txt)"
    [ "$(grep -c 'needs further libraries: taking' out)" -eq "$([ $time = first ] && echo 1 || echo 0)" ] || fail "the $time time: $(cat out)"
done
