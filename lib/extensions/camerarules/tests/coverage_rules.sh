#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# coverage --facing and --privacy: faces seen from ahead, and zones that cameras must not see.
. "$ISPACE_SOURCE_DIR/tests/pipelines/common.sh"

cat >room.env <<'END'
#env 1
ispace size=10,8,3
zone id=door path=-1,-1;1,-1;1,1;-1,1
zone id=desk1 path=3,-4;5,-4;5,-2;3,-2
zone id=desk2 path=-5,2;-4,2;-4,4;-5,4
END
cat >dome.3dm <<'END'
#3dm 1
camera id=c at=0,0,2.9 tilt=-90 projection=omni fov=179 pixels=2000,2000 range=30
END

# Straight above the middle: a quarter of the square lies within 45 degrees to the west of the camera.
coverage room.env dome.3dm --facing door,45deg,0 >out
has '^facing door within 45 degrees of 0: 25.00% of 4.00 m2 is seen$' <out || fail "not a quarter: $(tail -2 out)"
expect_status 0 coverage room.env dome.3dm --facing zone:door,45deg,0=25%
expect_status 3 coverage room.env dome.3dm --facing zone:door,45deg,0=26%

# Privacy: the exit status, the zones of a glob, the levels, and JUnit's file.
expect_status 3 coverage room.env dome.3dm --privacy 'zone:desk*' --junit rules.xml
has 'privacy of desk1' <rules.xml || fail "no rule in the file of JUnit"
coverage room.env dome.3dm --privacy 'desk*' -q >out && fail "a zone in view passes"
has '^privacy of desk2: 2.00 of 2.00 m2 is seen by c$' <out || fail "no camera named: $(tail -2 out)"
expect_status 0 coverage room.env dome.3dm --privacy 'desk*,inspect'
expect_status 0 coverage room.env dome.3dm --privacy desk1,100000 --report rules.html
has 'privacy of desk1' <rules.html || fail "no rule in the report"

expect_error 2 coverage room.env dome.3dm --privacy bed
expect_error 2 coverage room.env dome.3dm --privacy desk1,often
expect_error 2 coverage room.env dome.3dm --facing door,45deg
expect_error 2 coverage room.env dome.3dm --facing door,0deg,0
expect_error 2 coverage --batch list --privacy desk1
