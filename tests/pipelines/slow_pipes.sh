#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Streams that are not ready: a non-blocking pipe on either side is waited for.
. "$(dirname "$0")/common.sh"

command -v python3 >/dev/null || skip "no python3 here"

envc "$scenes/crowded.env" --to glb >expected.glb
envc "$scenes/crowded.env" --to env >room.env
envc - --to glb <room.env >expected2.glb

python3 - "$scenes/crowded.env" <<'END'
import fcntl, os, subprocess, sys, time

def pipe(non_blocking):
    ends = os.pipe()
    fcntl.fcntl(ends[non_blocking], fcntl.F_SETFL, os.O_NONBLOCK)
    return ends

# A reader that comes late, to a pipe that holds less than the product.
reading, writing = pipe(1)
fcntl.fcntl(writing, fcntl.F_SETPIPE_SZ if hasattr(fcntl, "F_SETPIPE_SZ") else 1031, 4096)
tool = subprocess.Popen(["envc", sys.argv[1], "--to", "glb"], stdout=writing)
os.close(writing)
time.sleep(0.3)
with open(reading, "rb") as stream:
    product = stream.read()
assert tool.wait() == 0, "writing: status %d" % tool.returncode
assert product == open("expected.glb", "rb").read(), "writing: another product"

# A writer that comes late.
reading, writing = pipe(0)
tool = subprocess.Popen(["envc", "-", "--to", "glb"], stdin=reading, stdout=subprocess.PIPE)
os.close(reading)
time.sleep(0.3)
os.write(writing, open("room.env", "rb").read())
os.close(writing)
product = tool.communicate()[0]
assert tool.returncode == 0, "reading: status %d" % tool.returncode
assert product == open("expected2.glb", "rb").read(), "reading: another product"
END
