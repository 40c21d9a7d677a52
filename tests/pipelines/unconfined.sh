#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Where the system refuses filters of system calls, meshes and pictures are read with --unconfined alone.
. "$(dirname "$0")/common.sh"

! grep -q '^ISPACE_SANITIZE:[A-Z]*=ON' "$binary_dir/CMakeCache.txt" || skip "sanitizers want calls that confined programs lack"

printf 'v 0 0 0\nv 4 0 0\nv 4 0 2\nf 1 2 3\n' >wall.obj
printf '#env 1\nispace size=9,9\nmesh at=0,0 file=wall.obj\n' >room.env
python3 - <<'PY'
import struct
width = height = 40
rows = b"".join(bytes(0 if x in (2, 37) or y in (2, 37) else 255 for x in range(width) for _ in range(3)) for y in range(height))
with open("plan.bmp", "wb") as out:
    out.write(b"BM" + struct.pack("<IHHI", 54 + len(rows), 0, 0, 54) +
              struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, len(rows), 0, 0, 0, 0) + rows)
PY

# Runs a command under a filter that fails prctl(PR_SET_SECCOMP) with EINVAL, as a system without seccomp does.
cat >without_seccomp.py <<'PY'
import ctypes, os, platform, struct, sys
number = {"x86_64": 157, "aarch64": 167}.get(platform.machine())
if number is None:
    sys.exit(77)
steps = [(0x20, 0, 0, 0), (0x15, 0, 3, number), (0x20, 0, 0, 16), (0x15, 0, 1, 22), (0x06, 0, 0, 0x00050016),
         (0x06, 0, 0, 0x7FFF0000)]
program = ctypes.create_string_buffer(b"".join(struct.pack("<HBBI", *step) for step in steps))
filter_ = struct.pack("<HxxxxxxQ", len(steps), ctypes.addressof(program))
libc = ctypes.CDLL(None, use_errno=True)
if libc.prctl(38, 1, 0, 0, 0) != 0 or libc.prctl(22, 2, filter_, 0, 0) != 0:
    sys.exit(77)
os.execvp(sys.argv[1], sys.argv[1:])
PY
status=0
python3 without_seccomp.py true || status=$?
[ $status -ne 77 ] || skip "this system has no filters to take away"

envc room.env -o room.glb || fail "a mesh is not read"
envc plan.bmp --resolution 0.1 -o plan.glb || fail "a picture is not read"
for tool in "envc room.env -o none.glb" "envc plan.bmp --resolution 0.1 -o none.glb" "coverage room.env"; do
    expect_status 1 python3 without_seccomp.py $tool
    one_error "${tool%% *}" "$tool"
    grep -q 'seccomp.*--unconfined' err || fail "$tool: $(cat err)"
    [ ! -e none.glb ] || fail "$tool: a product"
done
python3 without_seccomp.py envc room.env --unconfined -o again.glb || fail "--unconfined reads no mesh"
python3 without_seccomp.py envc plan.bmp --resolution 0.1 --unconfined -o plan2.glb || fail "--unconfined reads no picture"
cmp room.glb again.glb || fail "--unconfined changes the result"
