#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Another reader finds in a LAS file the points that the same scan has as CSV, to a tenth of a millimetre.
. "$(dirname "$0")/common.sh"

command -v node >/dev/null || skip "no node here"
[ -d "$binary_dir/npm/node_modules/copc" ] || skip "npm could not fetch a reader of LAS"
export NODE_PATH=$binary_dir/npm/node_modules
read_las() { node "$source_dir/tests/npm/read_las.js" "$@"; }

cp "$data/square.env" .
cat >sensors.3dm <<'END'
#3dm 1
laser id=front.laser at=0.5,0.25,1 heading=30 tilt=-20 fov=240 step=0.5 range=2.5 spin=10
laser id=nods at=0,0,1 step=15 sweep=tilt sweep_span=60 sweep_step=30
END
printf '#3dm 1\nranger id=pin at=-1,0,0.5 tilt=-20 pixels=40,30 range=1.8\n' >ranger.3dm

# sensor,t,x,y,z of the points of both, no returns left out, ten-thousandths as LAS has them.
rounded() { awk -F, -v OFS=, '{ for (i = 3; i <= 5; i++) $i = sprintf("%.3f", $i + 0); print $1, $2 + 0, $3, $4, $5 }' | sed 's/-0\.000/0.000/g'; }
compare() {
    read_las "$1" | rounded >read
    rounded <"$2" >meant
    [ -s meant ] || fail "no points in $2"
    python3 - read meant <<'END'
import csv, sys
read, meant = ([row for row in csv.reader(open(name))] for name in sys.argv[1:])
assert len(read) == len(meant), (len(read), len(meant))
for a, b in zip(read, meant):
    assert a[0] == b[0] and abs(float(a[1]) - float(b[1])) < 1e-6, (a, b)
    assert all(abs(float(x) - float(y)) < 0.0011 for x, y in zip(a[2:], b[2:])), (a, b)
END
}

scan square.env sensors.3dm --frames 2 -o lasers.las
scan square.env sensors.3dm --frames 2 --to csv |
    awk -F, -v OFS=, 'NR > 1 && $7 != "" { print $1, $4, $8, $9, $10 }' >lasers.csv
compare lasers.las lasers.csv
scan square.env sensors.3dm --frames 2 --las-version 1.3 -o old.las
# The package reads 1.2 and 1.4 alone: the head of 1.3 ends before what 1.4 adds, and the points are the same.
python3 - lasers.las old.las <<'END' || fail "not LAS 1.3"
import struct, sys
new, old = (open(name, "rb").read() for name in sys.argv[1:])
size, start, _, kind, length, count = struct.unpack_from("<HIIBHI", old, 94)
assert (*old[24:26], size, kind) == (1, 3, 235, 1) and length * count == len(old) - start, (old[24:26], size, kind, count)
assert old[131:227] == new[131:227] and old[start:] == new[struct.unpack_from("<I", new, 96)[0]:]
END
scan square.env ranger.3dm --frames 3 -o ranger.las
scan square.env ranger.3dm --frames 3 --to csv |
    awk -F, -v OFS=, 'NR > 1 && $6 != "" { print $1, $3, $7, $8, $9 }' >ranger.csv
compare ranger.las ranger.csv

# The same bytes for any number of threads and through a pipe; more than fits into memory waits on disk.
scan square.env ranger.3dm --noise --frames 400 --to las -j 1 | cmp - <(
    scan square.env ranger.3dm --noise --frames 400 --to las -j 2)

# No points at all.
printf '#3dm 1\nlaser id=short at=0,0 range=0.5\n' >short.3dm
scan square.env short.3dm -o none.las
[ "$(read_las none.las | wc -l)" -eq 0 ] || fail "points out of nothing"
expect_error 2 scan square.env sensors.3dm --to las --coordinates sensor
printf '#3dm 1\ncamera id=c at=0,0\n' >camera.3dm
expect_error 2 scan square.env camera.3dm --to las

# The check can fail.
sed '1s/,/,9/' lasers.csv >other.csv
if (compare lasers.las other.csv) 2>/dev/null; then fail "self-test: another point passes"; fi
