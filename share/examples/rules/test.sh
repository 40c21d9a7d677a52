#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test.sh [--mended]: runs controller.py in the flat and judges it by rules.yaml, as a CI server would. Writes rules.txt
# (which rule failed when, and the states then), junit.xml and the record into the current folder. Exit status 3: a rule
# failed. Requires simrun in PATH, and the module ispace in PYTHONPATH.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
rm -f port
simrun "$here/flat.env" "$here/flat.3dm" -q --clock step --dt 0.1 --script "$here/day.txt" --port-file port --record run \
    --expect "$here/rules.yaml" --expect-report rules.txt --junit junit.xml >/dev/null &
# Ends with simrun's status if that ends before it listens.
until [ -s port ]; do
    kill -0 $! 2>/dev/null || wait $!
    sleep 0.1
done
"$here/controller.py" "127.0.0.1:$(cat port)" "$@"
status=0
wait $! || status=$?
cat rules.txt
exit "$status"
