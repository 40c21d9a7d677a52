#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Outputs that cannot be written: one line naming the target, status 1, no half-written file; the effect of -o on
# existing files; and that no output of any tool replaces an input of the run.
. "$(dirname "$0")/common.sh"

room=$data/room.env
layout=$data/room.3dm
declare -A product=(
    [envc]="envc $room --to env"
    [arrange]="arrange $room --sensor laser --strategy grid -X 2 -Y 2 --deg 4"
    [scan]="scan $room $layout"
    [coverage]="coverage $room $layout --to png"
)
mkdir folder
for tool in "${!product[@]}"; do
    # shellcheck disable=SC2086
    for target in missing/folder/file folder; do
        # scan writes a set of files into a folder.
        [ "$tool $target" != "scan folder" ] || continue
        expect_status 1 ${product[$tool]} -o $target
        grep -q "^$tool: $target" err || fail "$tool does not name $target: $(cat err)"
        [ "$(wc -l <err)" -eq 1 ] || fail "not one line: $(cat err)"
    done
    # A bad input leaves the old output as it was.
    echo old >target
    bad=${product[$tool]//$room/$data/unknown_key.env}
    # shellcheck disable=SC2086
    expect_status 1 $bad -o target
    [ "$(cat target)" = old ] || fail "$tool: the old file is gone"
    # A link stays a link, permissions stay.
    chmod 640 target
    ln -s target link
    # shellcheck disable=SC2086
    expect_status 0 ${product[$tool]} -o link
    [ -L link ] || fail "$tool replaced a link"
    [ "$(cat target)" != old ] || fail "$tool did not write through the link"
    [ "$(stat -c %a target)" = 640 ] || fail "$tool changed the permissions"
    rm -f link target
done
[ -z "$(ls -A folder)" ] || fail "left behind in the folder"
[ "$(ls -A)" = "$(printf '%s\n' err folder out)" ] || fail "left behind: $(ls -A)"

# Links in a circle name no file; they stay.
rm -f err out
ln -s b a
ln -s a b
for tool in "${!product[@]}"; do
    # shellcheck disable=SC2086
    expect_error 1 ${product[$tool]} -o a
    [ -L a ] && [ -L b ] || fail "$tool: a link was replaced"
done

# A limit by `ulimit -f` is an error, not the end by a signal; the old file stays.
for tool in "${!product[@]}"; do
    echo old >small
    status=0
    # shellcheck disable=SC2086
    said=$(ulimit -f 0 && exec ${product[$tool]} -o small 2>&1 >/dev/null) || status=$?
    [ "$status" -eq 1 ] || fail "$tool: status $status, expected 1, beyond ulimit -f"
    [[ $said == "$tool: "*": error: File too large" ]] || fail "$tool, beyond ulimit -f: $said"
    [ "$(cat small)" = old ] || fail "$tool: the old file is gone"
done

# Every output against every input, under its own name, through a link, and by a hard link.
mkdir inputs kept
(
    cd inputs
    cp "$data/square.env" room.env
    cp "$data/half.3dm" half.3dm
    cp "$data/half.3dm" other.3dm
    cp "$data/session.3dm" robots.3dm
    cp "$data/tried.jsonl" tried.jsonl
    cp "$data/map.yaml" map.yaml
    cp "$data/map.pgm" map.pgm
    printf -- '- include: part.yaml\n' >whole.yaml
    printf -- '- fence: { path: [[0, 0], [4, 0], [4, 3], [0, 3]], closed: yes }\n' >part.yaml
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n' >desk.obj
    printf '#env 1\nfence path=-4,-4;4,-4;4,4;-4,4 closed=yes\nmesh file=desk.obj\n' >mesh.env
    printf 't,x,y,heading\n0,0,0,0\n1,0.5,0,0\n' >poses.csv
    printf 'x,y,heading\n0,0,0\n1,0,90\n' >places.csv
    printf '0 r1 SPEED 1\n' >script.txt
)
placing="--sensor laser,range=1 --candidates 1,1,4"
# A line: the input, and an option that would overwrite it; OUT stands for its name.
refused='
room.env    envc room.env --to env -o OUT
room.env    envc room.env --to svg -o OUT
part.yaml   envc whole.yaml --to yaml -o OUT
whole.yaml  envc whole.yaml --to yaml -o OUT
part.yaml   envc whole.yaml -o new.glb -MD -MF OUT
desk.obj    envc mesh.env --to glb -o OUT
desk.obj    scan mesh.env half.3dm --to jsonl -o OUT
map.pgm     envc map.yaml --to svg -o OUT
map.yaml    envc map.yaml --to ros -o OUT
room.env    arrange room.env PLACING --trace OUT -o new.3dm
places.csv  arrange room.env --sensor laser --places places.csv --curve OUT -o new.3dm
places.csv  arrange room.env --sensor laser --places places.csv --export-mps OUT -o new.3dm
half.3dm    arrange room.env half.3dm PLACING -o OUT
half.3dm    scan room.env half.3dm --to jsonl -o OUT
poses.csv   scan room.env --poses poses.csv --model laser --to csv -o OUT
poses.csv   scan room.env --poses poses.csv --model laser --to csv -o new.csv -MD -MF OUT
room.env    coverage room.env half.3dm --to csv -o OUT
half.3dm    coverage room.env half.3dm -o new.png -MD -MF OUT
other.3dm   coverage room.env half.3dm --compare other.3dm --to png -o OUT
tried.jsonl coverage room.env half.3dm --trace tried.jsonl --to png -o OUT
room.env    simrun room.env robots.3dm --until 0 --port-file OUT
robots.3dm  simrun room.env robots.3dm --until 0 --port-file OUT
script.txt  simrun room.env robots.3dm --until 0 --script script.txt --port-file OUT
'
cp -r inputs/. kept
while read -r input command; do
    [ -n "$input" ] || continue
    for way in plain hard soft; do
        rm -rf inputs
        cp -r kept inputs
        name=$way.${input##*.}
        case $way in
        plain) name=$input ;;
        hard) ln "inputs/$input" "inputs/$name" ;;
        soft) ln -s "$input" "inputs/$name" ;;
        esac
        line=${command//OUT/./$name}
        line=${line//PLACING/$placing}
        # shellcheck disable=SC2086
        (cd inputs && expect_status 2 $line && mv out err ..)
        grep -q "error: ./$name is read by this command: write to another file" err ||
            fail "$line: $(cat err)"
        [ "$(wc -l <err)" -eq 1 ] || fail "not one line: $line: $(cat err)"
        [ "$way" = plain ] || rm "inputs/$name"
        diff -r kept inputs || fail "inputs were touched, or more was written: $line"
    done
done <<<"$refused"

# Members of a set, files of a record, and files beside a product.
cd kept
mkdir set run
mv poses.csv set/laser1-0000.csv
expect_error 2 scan room.env --poses set/laser1-0000.csv --model laser --to csv -o set
[ "$(ls set)" = laser1-0000.csv ] || fail "more in the set: $(ls set)"
mv script.txt run/robots.csv
expect_error 2 simrun room.env robots.3dm --until 0 --script run/robots.csv --record run
expect_error 2 simrun room.env robots.3dm --until 0 --port-file run/info.csv --record run
expect_error 2 envc room.env --to ros -o map.yaml -MD -MF map.pgm
expect_error 2 envc room.env --to obj -o room.mtl
expect_error 2 coverage room.env half.3dm --to ros -o map.yaml --report map.json -MD -MF map.json
ln map.pgm new.pgm
expect_error 2 envc map.yaml --to ros -o new.yaml
expect_status 2 envc - --to env -o room.env <room.env
status=0
arrange room.env --sensor laser,range=1 --candidates 1,1,4 --trace both >both 2>err || status=$?
[ "$status" -eq 2 ] || fail "status $status for a trace where stdout goes: $(cat err)"
[ -z "$(find "$scratch" -name '.ispace.tmp*')" ] || fail "stand-ins are left"

# In a chroot without /proc an unnamed file cannot be given a name; files are made all the same.
cd "$scratch"
cat >no_proc.sh <<'END'
mount -t tmpfs none /proc && "$@" &&
    [ -z "$(find . -name '.ispace.tmp*')" ]
END
if unshare -m mount -t tmpfs none /proc 2>/dev/null; then
    expect_status 0 unshare -m sh no_proc.sh envc "$room" --to env -o no_proc.env
    expect_same no_proc.env <(envc "$room" --to env) "another file without /proc"
fi
