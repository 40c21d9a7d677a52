#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures that OpenCV decodes are decoded in a program without rights and with limits, which does not
# outlive the tool that started it.
. "$(dirname "$0")/common.sh"

reader=$binary_dir/lib/ispace/read-picture
sanitized=no
grep -q '^ISPACE_SANITIZE:[A-Z]*=ON' "$binary_dir/CMakeCache.txt" && sanitized=yes

# A progressive JPEG of 4000 x 4000 pixels: one scan of grey, then so many empty ones, 26 bytes and some milliseconds
# each.
cat >slow.py <<'PY'
import struct, sys
size, scans = 4000, int(sys.argv[1])
blocks = (size // 8) ** 2
def segment(mark, data):
    return b'\xff' + bytes([mark]) + struct.pack('>H', len(data) + 2) + data
def table(kind, symbol):  # its only code is 0
    return segment(0xc4, bytes([kind, 1] + [0] * 15 + [symbol]))
def scan(first, last, data):
    return segment(0xda, bytes([1, 1, 0, first, last, 0])) + data
runs, left = '', blocks
while left > 0:
    run = min(left, 32767)
    left -= run
    bits = run.bit_length() - 1
    if bits < 14:  # other lengths have no code: several of one block are never needed here
        raise SystemExit('the last run is too short')
    runs += '0' + format(run - (1 << 14), '014b')
runs += '1' * (-len(runs) % 8)
data = bytes(int(runs[i:i + 8], 2) for i in range(0, len(runs), 8)).replace(b'\xff', b'\xff\0')
sys.stdout.buffer.write(
    b'\xff\xd8' + segment(0xdb, bytes([0] + [1] * 64)) +
    segment(0xc2, struct.pack('>BHHB', 8, size, size, 1) + bytes([1, 0x11, 0])) +
    table(0x00, 0) + table(0x10, 0xe0) + scan(0, 0, bytes(blocks // 8 + 1)) +
    scan(1, 63, data) * scans + b'\xff\xd9')
PY
python3 slow.py 2 >quick.jpg
envc quick.jpg --resolution 0.01 --to env >out 2>err || true
grep -q 'bad JPEG picture' err && fail "not a JPEG: $(cat err)"

# It ends by itself where it takes longer than it may.
python3 slow.py 20000 >slow.jpg
python3 - "$reader" <<'PY'
import os, signal, socket, subprocess, sys
ours, theirs = socket.socketpair()
with open('slow.jpg') as picture:
    reader = subprocess.Popen([sys.argv[1], str(os.getpid()),
                               str(os.path.getsize('slow.jpg')), str(4 << 30), '1', '1000000', '0'],
                              stdin=picture, stdout=theirs)
status = reader.wait(timeout=100)
assert status == -signal.SIGXCPU, status
PY

# It has no rights, and ends with the tool, be that a map or a texture.
cp slow.jpg texture.jpg
printf '#env 1\nispace size=4,3\ncube at=1,1 size=1 texture=texture.jpg\n' >room.env
for command in "envc slow.jpg --resolution 0.01 --check" "scan room.env --view bird -o view.png"; do
    # shellcheck disable=SC2086
    "$binary_dir"/bin/${command%% *} ${command#* } >out 2>err &
    tool=$!
    child=
    for _ in $(seq 200); do
        child=$(pgrep -P $tool -x read-picture) && break
        sleep 0.05
    done
    [ -n "$child" ] || fail "nothing decodes for: $command: $(cat err)"
    for _ in $(seq 200); do  # until it is confined, which it is before it reads
        { [ $sanitized = yes ] || grep -q '^Seccomp:[[:space:]]*2' "/proc/$child/status"; } && break
        sleep 0.05
    done
    sleep 0.5
    kill -0 "$child" || fail "not slow: $command: $(cat err)"
    if [ $sanitized = no ]; then
        grep -q '^Seccomp:[[:space:]]*2' "/proc/$child/status" || fail "no filter of system calls"
        grep -q '^NoNewPrivs:[[:space:]]*1' "/proc/$child/status" || fail "it may gain rights"
    fi
    kill -TERM $tool
    status=0
    wait $tool || status=$?
    [ $status -eq 143 ] || fail "status $status after TERM: $command"
    for _ in $(seq 100); do
        { [ ! -d "/proc/$child" ] || grep -q '^State:.*[ZX] ' "/proc/$child/status"; } && break
        sleep 0.05
    done
    [ ! -d "/proc/$child" ] || grep -q '^State:.*[ZX] ' "/proc/$child/status" ||
        fail "left running after its parent: $command"
done

# Damaged files end with one line.
for suffix in jpg bmp webp; do
    whole=$data/pictures/room.$suffix
    head -c $(($(stat -c %s "$whole") / 2)) "$whole" >cut.$suffix
    expect_error 1 envc cut.$suffix --resolution 0.05
done
