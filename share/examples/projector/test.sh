#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test.sh [--still]: runs follow.py in the room for a minute, and prints how long the picture was in its place. Writes the
# record into the current folder. Requires simrun in PATH, and the module ispace in PYTHONPATH.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
rm -f port
simrun "$here/room.env" "$here/room.3dm" -q --clock step --dt 0.1 --noise --seed 1 --port-file port --record run >/dev/null &
# Ends with simrun's status if that ends before it listens.
until [ -s port ]; do
    kill -0 $! 2>/dev/null || wait $!
    sleep 0.1
done
"$here/follow.py" "127.0.0.1:$(cat port)" "$@"
wait $!
"$here/judge.py" run
