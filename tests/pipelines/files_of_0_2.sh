#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that version 0.2 wrote, as ispace-stability(7) promises: records, models, layouts, runs and certificates are read
# as the same rooms; unfinished jobs of that version are refused with the reason; JSON, CSV and the protocol have all
# that readers of 0.2 expect. The files of release/ are those of the commit of the release, the others of the last one
# before version 0.3.
. "$(dirname "$0")/common.sh"

command -v python3 >/dev/null || skip "no python3 here"
old=$data/files_0.2
cp -r "$old" files
chmod -R u+w files
cd files
# A stranger's version: these tests say what holds for files of another one.
if envc --version | has -F '(ispace) 0.2'; then fail "this is version 0.2"; fi

# keeps OLD NEW: all keys of the old JSON, or JSON lines, are in the new, with values of the same type; equal figures
# within 1e-6, but for the version and for null, which may have become a figure.
cat >keeps.py <<'END'
import json, sys

def lines(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file if line.strip()]

def compare(old, new, at):
    if isinstance(old, dict):
        assert isinstance(new, dict), f"{at}: no object"
        for key, value in old.items():
            if key in ("version", "history"):
                continue
            assert key in new, f"{at}: the key {key} is gone"
            compare(value, new[key], f"{at}.{key}")
    elif isinstance(old, list):
        assert isinstance(new, list) and len(old) == len(new), f"{at}: another list"
        for index, (before, after) in enumerate(zip(old, new)):
            compare(before, after, f"{at}[{index}]")
    elif isinstance(old, (int, float)) and not isinstance(old, bool):
        assert isinstance(new, (int, float)) and abs(old - new) <= 1e-6 * max(1, abs(old)), f"{at}: {old}, now {new}"
    elif old is not None:
        assert old == new, f"{at}: {old}, now {new}"

before, after = lines(sys.argv[1]), lines(sys.argv[2])
assert len(before) == len(after), f"{len(before)} lines, now {len(after)}"
for number, (old, new) in enumerate(zip(before, after), 1):
    compare(old, new, f"line {number}")
END
keeps() { python3 keeps.py "$1" "$2" 2>keeps.err || fail "$1: $(tail -n 1 keeps.err)"; }
printf '{"a":{"b":1}}\n' >one.json
printf '{"a":{"c":1}}\n' >two.json
if python3 keeps.py one.json two.json 2>keeps.err; then fail "self-test: a key that is gone passes"; fi

# Rooms, and the same from a model: digests and figures.
envc room.env --info --json >new.json
keeps info.json new.json
envc catalogue.env --info --json >new.json
# Its mesh has other triangles, hence another digest, by assimp from 5.3 on.
version=$(sed -n 's/^ASSIMP_VERSION:INTERNAL=//p' "$binary_dir/CMakeCache.txt")
case ${version:-none} in
    5.[0-2].*) keeps catalogue.json new.json ;;
    *)
        for file in catalogue.json new.json; do sed 's/"digest":"[^"]*"/"digest":""/g' $file >without.$file; done
        keeps without.catalogue.json without.new.json
        ;;
esac
envc house/house.env --info --json >new.json
keeps house_info.json new.json
envc release/room.env --info --json >new.json
keeps release/info.json new.json
envc square.env --to env | tail -n +3 >plain.env  # after the history
envc square.glb --to env | tail -n +4 | cmp - plain.env || fail "the model is another room"

# Layouts: no warning, and the figures of then.
coverage -q room.env best.3dm --json >new.json 2>err
keeps coverage.json new.json
coverage -q room.env best.3dm --trace trace.jsonl -o traced.svg >/dev/null 2>err || fail "a trace of 0.2: $(cat err)"
[ ! -s err ] || fail "a layout of 0.2: $(cat err)"
coverage -q house/house.env house.3dm --json >new.json
keeps house_coverage.json new.json
coverage -q --grid 100,100 release/room.env release/room.3dm --json >new.json
keeps release/coverage.json new.json
(cd release && coverage cameras.3dm --json) >new.json 2>err || fail "a layout of the release: $(cat err)"
[ ! -s err ] || fail "a layout of the release: $(cat err)"
scan -q room.env best.3dm >new.jsonl
keeps scans.jsonl new.jsonl
scan -q house/house.env house.3dm >new.jsonl
keeps house_scans.jsonl new.jsonl

# A run: replayed, measured, and written again with the columns of then, in their order, at the front.
simrun --replay run --clock fast --record again >/dev/null 2>err || fail "no replay: $(cat err)"
[ ! -s err ] || fail "a replay: $(cat err)"
cmp run/robots.csv again/robots.csv || fail "the replay moves differently"
keeps run/scans.jsonl again/scans.jsonl
for table in run/*.csv; do
    head -n 1 "$table" >columns
    head -n 1 "again/${table##*/}" | has "^$(cat columns)" || fail "$table: other columns: $(head -n 1 "again/${table##*/}")"
done
scan -q --run run >new.jsonl
keeps run/scans.jsonl new.jsonl
coverage -q --run run run/scene.env --json >new.json || fail "no measure of a run"
simrun square.env session.3dm --clock fast --dt 0.1 --until 0.5 --script drive.txt --record fresh >/dev/null
golden-diff --abs 1e-9 release/run/robots.csv fresh/robots.csv || fail "robots move differently than in the release"
cmp release/run/info.csv fresh/info.csv || fail "info.csv differs from the release"
keeps release/run/scans.jsonl fresh/scans.jsonl
simrun --replay house_run --clock fast >/dev/null 2>err || fail "no replay of a building: $(cat err)"

# A proof holds in any version.
arrange square.env two.3dm --verify two.certificate >verified 2>err || fail "the certificate: $(cat err)"

# Unfinished jobs are of one version, and the error names both.
expect_error 1 arrange square.env --sensor laser,range=2,fov=120:3 --proof poses --gap 0.001% --resume -o proof.3dm
grep -q "version of ispace (.*0\.2\.0.*differs; delete the file" err || fail "the store: $(cat err)"
arrange -q room.env --sensor urg-04lx:2 --strategy grid -X 3 -Y 3 --shard 2/2 -o rest.part
expect_error 1 arrange --merge best.part rest.part -o merged.3dm
grep -q "version of ispace (.*0\.2\.0" err || fail "the part: $(cat err)"

# The protocol: to the requests of then, replies have the words, keys and values of then.
if command -v nc >/dev/null; then
    cat >replies.py <<'END'
import sys

def fields(line):
    return dict(word.split("=", 1) for word in line.split() if "=" in word)

before, after = (open(path, encoding="utf-8").read().splitlines() for path in sys.argv[1:])
assert len(before) == len(after), f"{len(before)} lines, now {len(after)}"
for old, new in zip(before, after):
    if old.startswith("OK HELP"):
        verbs = {request.split()[0] for request in new.removeprefix("OK HELP ").split(" | ")}
        wanted = {request.split()[0] for request in old.removeprefix("OK HELP ").split(" | ")}
        assert wanted <= verbs, f"requests are gone: {wanted - verbs}"
    elif old.startswith("ERR"):
        assert old.split()[:2] == new.split()[:2], f"{old}\n{new}"
    else:
        plain = [word for word in old.split() if "=" not in word]
        assert plain == [word for word in new.split() if "=" not in word], f"{old}\n{new}"
        assert fields(old).items() <= fields(new).items(), f"{old}\n{new}"
END
    for role in robot laser world change; do
        cp "$data"/square.env "$data"/session.3dm .
        sh "$data/talk.sh" "$old/square.env" "$old/session.3dm" <"release/$role.txt" >replies 2>err || fail "$role: $(cat err)"
        python3 replies.py "release/$role.out" replies 2>err || fail "$role: $(tail -n 3 err)"
    done
else
    echo "no nc here: the protocol is not tried"
fi

# Each option of the release is there, or names what replaces it.
while read -r tool option; do
    [ -e "$tool.help" ] || "$tool" --help all >"$tool.help"
    grep -qE -- "(^|[ ,])$option([ ,=[]|\$)" "$tool.help" || fail "$tool has no $option any more"
done <release/options.txt

# Results of a sweep are of one version, too.
if /usr/bin/python3 -c 'import yaml' 2>/dev/null; then
    expect_status 1 ispace-sweep run sweep.yaml --reuse results.jsonl
    grep -q 'made by version 0\.2\.0: --reuse takes lines of' err || fail "results of 0.2: $(cat err)"
    ispace-sweep join sweep.yaml results.jsonl >table.csv || fail "no table of results of 0.2"
fi
