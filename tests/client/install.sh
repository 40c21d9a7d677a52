#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The C++ client as others get it: installed, found by CMake, linked into a program that drives a robot. A
# program for ARIA is compiled with two folders in its include path, the name of the header as it likes.
. "$(dirname "$0")/../pipelines/common.sh"

cmake --install "$binary_dir" --prefix "$scratch/prefix" >log
cp "$source_dir"/tests/client/consumer/* .
cmake -S . -B build -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1 || fail "not found: $(cat cmake.log)"
cmake --build build >build.log 2>&1 || fail "$(cat build.log)"
version=$(sed -n 's/^project(ispace VERSION \([0-9]*\.[0-9]*\).*/\1/p' "$source_dir/CMakeLists.txt")
sed -i "s/find_package(ispace [^ ]* /find_package(ispace $version.99 /" CMakeLists.txt
if cmake -S . -B other -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1; then
    fail "version $version.0 is taken for $version.99"
fi
# By the package's name of 0.1, and by parts of it.
for found in ispace_client "ispace $version COMPONENTS client aria"; do
    sed -i "s/find_package(.*/find_package($found REQUIRED)/" CMakeLists.txt
    rm -rf other
    cmake -S . -B other -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1 || fail "no $found: $(cat cmake.log)"
done
# By pkg-config, from a tree that was moved.
if command -v pkg-config >/dev/null; then
    cp -r prefix moved
    export PKG_CONFIG_PATH=$scratch/moved/share/pkgconfig
    pkg-config --atleast-version="$version" ispace-client || fail "pkg-config does not know this version"
    rm -rf moved/share/cmake
    # shellcheck disable=SC2046
    "${CXX:-c++}" -std=c++11 $(pkg-config --cflags ispace-client) consumer.cpp -o by_pkg_config $(pkg-config --libs ispace-client) ||
        fail "consumer.cpp is not compiled by pkg-config"
    # shellcheck disable=SC2046
    "${CXX:-c++}" -std=c++11 $(pkg-config --cflags ispace-aria) "$source_dir/share/examples/aria/wander.cpp" \
        -o by_pkg_config $(pkg-config --libs ispace-aria) || fail "wander.cpp is not compiled by pkg-config"
fi

# Copies the examples from there and builds them with the installed files.
cp -r prefix/share/ispace/examples .
cmake -S examples -B examples/build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1 ||
    fail "the examples are not configured: $(cat cmake.log)"
cmake --build examples/build -j 2 >build.log 2>&1 || fail "$(cat build.log)"

for header in Aria.h Aria/Aria.h Sim_Aria.h; do
    sed "s:Aria[.]h:$header:" "$source_dir/share/examples/aria/wander.cpp" >wander.cpp
    "${CXX:-c++}" -std=c++11 -Wall -Wextra -Werror -pthread -I prefix/include/ispace_aria -I prefix/include \
        wander.cpp -o wander || fail "wander.cpp is not compiled with $header"
done

simrun "$data/square.env" "$data/session.3dm" --clock step --port-file port >announced &
server=$!
trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
./build/consumer "127.0.0.1:$(cat port)" >out || fail "status $?"
[ "$(cat out)" = there ] || fail "$(cat out)"
wait "$server" || fail "simrun ended with $?"
