#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that other files name: the tools reject pipes and devices unopened, records name files of their folder, and no
# message quotes a line of a file elsewhere. Pipes as operands are read.
. "$(dirname "$0")/common.sh"

mkfifo pipe
printf 'geheim: 7\n' >elsewhere.yaml
mkdir job
printf '#env 1\nispace size=4,3\n' >room.env

# failed TOOL ARGUMENT…: status 1 within ten seconds, one line. refused: which quotes no other file.
failed() {
    expect_status 1 timeout 10 "$@"
    [ ! -s out ] || fail "output in spite of the error: $*"
    one_error "$1" "$*"
}
refused() {
    failed "$@"
    if grep -q 'geheim\|root:' err; then fail "quoted: $(cat err)"; fi
}

# A layout's environment.
for file in ../pipe /dev/zero ../elsewhere.yaml; do
    printf '#3dm 1\nenvironment file=%s\nlaser id=l1 at=1,1\n' "$file" >job/best.3dm
    for words in "scan job/best.3dm" "coverage job/best.3dm" "envc job/best.3dm --info"; do
        # shellcheck disable=SC2086
        refused $words
    done
done
grep -q 'elsewhere.yaml:1:1: error: .*envc --check' err || fail "no hint: $(cat err)"
printf '#3dm 1\nenvironment file=../room.env\nlaser id=l1 at=1,1\n' >job/best.3dm
coverage -q job/best.3dm >out
# In the layout's folder it is quoted, and so are records anywhere.
cp elsewhere.yaml job/own.yaml
printf '#env 1\nispase\n' >bad.env
for file in own.yaml ../bad.env; do
    printf '#3dm 1\nenvironment file=%s\nlaser id=l1 at=1,1\n' "$file" >job/best.3dm
    failed coverage job/best.3dm
    grep -q 'geheim\|ispase' err || fail "not quoted: $(cat err)"
done

# Files that rooms name.
for record in "mesh file=pipe at=1,1" "mesh file=/dev/zero at=1,1" "mesh file=elsewhere.yaml at=1,1" \
    "camera at=1,1,1 calibration=pipe" "camera at=1,1,1 calibration=elsewhere.yaml"; do
    printf '#env 1\nispace size=4,3\n%s\n' "$record" >named.env
    refused envc named.env --check
done
for file in pipe /dev/zero elsewhere.yaml; do
    printf '#env 1\nispace size=4,3\ncube at=1,1 size=1 texture=%s\n' "$file" >named.env
    refused scan named.env --view bird -o view.png
    printf 'image: %s\nresolution: 0.1\norigin: [0, 0, 0]\n' "$file" >map.yaml
    refused envc map.yaml
done

# A record of a run.
printf '#env 1\nispace size=4,3\nrobot id=r1 at=1,1\n' >walk.env
printf '0 r1 FORWARD 1\n' >script
simrun -q walk.env --clock fast --until 1 --script script --record run >out
timeout 20 simrun -q --replay run --clock fast --until 1 >out
for file in robots.csv people.csv odometry.csv bumpers.csv events.csv info.csv scene.env; do
    for target in ../pipe /dev/zero; do
        rm -rf kept
        cp -a run kept
        ln -sf "$target" "run/$file"
        refused simrun --replay run --clock fast --until 1
        rm -rf run
        mv kept run
    done
done
ln -sf ../room.env run/scene.env
refused simrun --replay run --clock fast --until 1
grep -q 'no regular file in the folder of the record' err || fail "$(cat err)"
rm run/scene.env
cp walk.env run/scene.env

# Files that its events name. The change fails; the replay continues.
for file in ../pipe pipe /dev/zero /etc/passwd ../elsewhere.yaml; do
    mkfifo -m 600 run/pipe 2>/dev/null || true
    printf 't,kind,id,other,x,y,value,text\n0.5,change,,%s,,,,LOAD x\n' "$file" >run/events.csv
    expect_status 0 timeout 20 simrun --replay run --clock fast --until 1
    grep -q "run/events.csv:2: .*no regular file in the folder of the record" err ||
        fail "$file: $(cat err)"
    if grep -q 'geheim\|root:' err; then fail "quoted: $(cat err)"; fi
done

# Parts of a job.
for tool in arrange scan; do
    for file in pipe /dev/zero; do
        refused $tool --merge "$file"
        grep -q 'a part is a regular file' err || fail "$(cat err)"
    done
done
# Rooms of storeys, and jobs of lists.
for file in pipe /dev/zero; do
    printf '#env 1\nstorey id=a file=%s\n' "$file" >storeys.env
    refused envc storeys.env --check
    printf '%s\n' "$file" >list
    for words in "coverage --batch list" "scan --batch list -o new/" \
        "arrange --batch list --sensor laser:1 -o new/"; do
        # shellcheck disable=SC2086
        expect_status 1 timeout 10 $words
        grep -q "list:1: $file: error: it is no regular file" err || fail "$words: $(cat err)"
    done
done
# Operands may be any file.
envc <(cat room.env) --info >by_pipe
envc room.env --info | sed 's/room.env/room/' >by_name
expect_same <(grep ^digest by_pipe) <(grep ^digest by_name) "a room through a pipe"
envc /dev/stdin --info <room.env | has ^digest || fail "a room through /dev/stdin"
cat room.env >pipe &
envc pipe --info | has ^digest || fail "a room through a named pipe"
wait

# Includes lie in the folder of the file that is read, unless the user allows others.
printf 'include: ../elsewhere.yaml\n' >job/up.yaml
refused envc job/up.yaml --check
grep -q -- '--include-files anywhere' err || fail "no hint: $(cat err)"
printf '#env 1\nispace size=4,3\n' >part.env
printf 'include: ../part.env\n' >job/up.yaml
for tool in envc "scan --model laser --poses /dev/null" coverage simrun "arrange --sensor laser"; do
    # shellcheck disable=SC2086
    refused $tool job/up.yaml
done
envc job/up.yaml --include-files anywhere --info | has ^digest || fail "not allowed"
envc - --info <<<'include: part.env' | has ^digest || fail "not in the current folder"
printf 'include: [../pipe, /dev/zero]\n' >job/up.yaml
expect_status 1 timeout 10 envc job/up.yaml --include-files anywhere --check
[ "$(grep -c 'no regular file' err)" -eq 2 ] || fail "$(cat err)"
