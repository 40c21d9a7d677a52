#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test.sh [--same-for-all]: runs controller.py in the flat for 75 minutes, and prints the minutes of comfort. Writes the
# record into the current folder. Requires simrun in PATH, and the module ispace in PYTHONPATH.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
rm -f port
simrun "$here/flat.env" "$here/flat.3dm" -q --clock step --dt 0.5 --script "$here/day.txt" --port-file port --record run \
    --no-record-readings >/dev/null &
# Ends with simrun's status if that ends before it listens.
until [ -s port ]; do
    kill -0 $! 2>/dev/null || wait $!
    sleep 0.1
done
"$here/controller.py" "127.0.0.1:$(cat port)" "$@"
wait $!
"$here/comfort.py" run "$here/flat.3dm"
