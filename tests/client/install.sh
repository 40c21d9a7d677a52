#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The C++ client as others get it: installed, found by CMake, linked into a program that drives a robot. A
# program for ARIA is compiled with two folders in its include path, the name of the header as it likes.
. "$(dirname "$0")/../pipelines/common.sh"

cmake --install "$binary_dir" --prefix "$scratch/prefix" >log
cp "$source_dir"/tests/client/consumer/* .
cmake -S . -B build -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1 || fail "not found: $(cat cmake.log)"
cmake --build build >build.log 2>&1 || fail "$(cat build.log)"
sed -i 's/ispace_client 0.1/ispace_client 0.2/' CMakeLists.txt
if cmake -S . -B other -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1; then
    fail "version 0.1 is taken for 0.2"
fi

# The examples are copied from there and built with what is installed.
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
