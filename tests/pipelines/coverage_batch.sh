#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# coverage --batch: many scenes in one process give the output of many processes, even if single ones fail.
. "$(dirname "$0")/common.sh"

cp "$scenes"/* . 2>/dev/null || true
cp "$data"/{square.env,half.3dm,whole.3dm,zones.env,several.3dm,leaky.env} .
cp square.env "a room.env"
{ cat square.env; echo 'laser id=in at=3,3 model=urg-04lx'; } >own.env
cat >list <<'LIST'
# All of these work.
ispace.env ispace.3dm
square.env half.3dm

"a room.env" whole.3dm   # quoted
own.env
half.3dm square.env
hall.env hall.3dm
zones.env several.3dm
LIST
options="--grid 50 --any-environment"

# The same bytes as single runs, for any number of threads.
grep -v '^#' list | sed 's/ *#.*//' | while read -r line; do
    [ -z "$line" ] || eval "coverage -q $options --json $line"
done >single
[ "$(wc -l <single)" -eq 7 ] || fail "not 7 single runs"
for threads in 1 2 7; do
    # shellcheck disable=SC2086
    coverage -q $options --batch list -j $threads >batch
    expect_same single batch "a batch on $threads threads differs from single runs"
done
# shellcheck disable=SC2086
coverage -q $options --batch - -o reports.jsonl <list
expect_same single reports.jsonl "a list on stdin, reports in a file"

# A defect of one scene is reported with its position, writes `null`, and stops no other scene.
cat >bad <<'LIST'
square.env half.3dm
missing.env half.3dm
square.env half.3dm hall.3dm
leaky.env half.3dm
square.env "half.3dm
square.env
square.env -
own.env
LIST
expect_status 1 coverage --batch bad -j 2
[ "$(grep -c '^null$' out)" -eq 6 ] || fail "not six lines of null: $(cut -c1-40 out)"
[ "$(sed -n '1p;8p' out | grep -c '^{"schema":"ispace-coverage/1"')" -eq 2 ] || fail "$(cut -c1-40 out)"
cut -c1-60 err >said
cat >wanted <<'SAID'
coverage: bad:2: missing.env: error: No such file or directory
coverage: bad:3: error: more than ENV and LAYOUT: put names with blanks in quotes
coverage: bad:4: leaky.env:
coverage: bad:5: error: the quote that opens here is not closed
coverage: bad:6: error: square.env holds no placed sensor: give a layout after it
coverage: bad:7: error: stdin is not read by a job of a list: give a file
coverage: bad:8: own.env:3:1: warning: laser in stands outside
coverage: bad: error: 6 of 8 jobs failed, see above
SAID
while read -r line; do
    grep -qF "$line" err || fail "not said: $line; but: $(cat err)"
done <wanted
expect_status 1 coverage -q --batch bad
! grep -q warning err || fail "-q warns: $(cat err)"

# Requirements count for each; a JUnit file lists them all.
printf 'square.env half.3dm\nsquare.env whole.3dm\n' >two
expect_status 0 coverage --batch two --require 40%
expect_status 3 coverage --batch two --require 40% --require free:60% --junit two.xml
[ "$(wc -l <out)" -eq 2 ] || fail "reports are missing: $(cat out)"
grep -q '^coverage: two:1: error: free coverage is 50.00% (exact), below the required 60%' err || fail "$(cat err)"
grep -q '^coverage: error: 1 of 2 jobs missed a requirement' err || fail "$(cat err)"
python3 "$source_dir/tests/schemas/junit.py" two.xml || fail "not JUnit: $(cat two.xml)"
grep -q 'tests="4" failures="1" errors="0"' two.xml || fail "$(cat two.xml)"
grep -q 'name="two:1 square.env half.3dm: free:60%"' two.xml || fail "$(cat two.xml)"
expect_status 1 coverage --batch bad --require 40% --junit bad.xml
python3 "$source_dir/tests/schemas/junit.py" bad.xml || fail "not JUnit: $(cat bad.xml)"
grep -q 'tests="8" failures="1" errors="6"' bad.xml || fail "$(cat bad.xml)"
expect_status 1 coverage --batch two --require zone:door=1%
grep -q '^coverage: two:2: error: the room has no zone `door`' err || fail "$(cat err)"

# Memory does not grow with their number.
peak() {
    python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' coverage -j 2 --grid 20 --batch "$1"
}
for _ in $(seq 25); do cat two; done >some
for _ in $(seq 1000); do cat two; done >many
few=$(peak some)
all=$(peak many)
[ "$all" -lt $((few + 8192)) ] || fail "$few kB for 50 scenes, $all kB for 2000"

# A file that is no list, a full disk, and excluded options.
expect_error 1 coverage --batch "$data/random.bin"
expect_error 1 coverage --batch /dev/null
expect_error 1 coverage --batch missing
status=0
coverage --batch two >/dev/full 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status on a full disk"
one_error coverage "a full disk"
expect_error 2 coverage --batch two square.env
expect_error 2 coverage --batch two -o map.png
# Each option either works with it, as those do in this file or for any number of scenes, or is refused by name.
works="--help --version --json --batch --shard --resume --cache --grid --cell --grid-of --height --plane --density --parallax
    --require --junit --same-environment --any-environment --output --quiet --verbose --threads --seed --errors --progress
    --no-progress --unconfined --zone --include-files --max-work --storey"
refused="--report=r.json --suggest --compare=half.3dm --run=r -MD --to=png --width=300 --color=sensor --fans=beams
    --trace=two --speeds=30% --perturb=5cm,3deg --failures=1 --crowd=1 --facing=door,45,0 --privacy=desk
    --presence=wander:1 --path=a,b --localise=20cm --time-limit=1s --title=t --project=p --client=c --author=a
    --logo=l.png --paper=a4 --prices=p.csv --material=m.csv"
for option in $refused; do
    expect_error 2 coverage --batch two -o reports.jsonl "$option"
    grep -q -e "^coverage: error: ${option%%=*} is about .*--batch" err || fail "$option: $(cat err)"
done
# Tasks of extensions are no lists, and their options say so.
expect_error 2 coverage --batch two -o reports.jsonl --tracks t.csv
grep -q -- "--batch does not go with --tracks" err || fail "--tracks: $(cat err)"
for option in --frame-rate=5 --truths=all --films=f; do
    expect_error 2 coverage --batch two -o reports.jsonl "$option"
    grep -q -- "${option%%=*} goes with --tracks" err || fail "$option: $(cat err)"
done
tasks="--tracks --frame-rate --truths --films --goal --robot --reach --way --projection"
coverage --help all | grep -oE '^  (-., )?--?[A-Za-z-]+' | sed 's/.* //' | sort >options
# shellcheck disable=SC2086
printf '%s\n' $works $refused $tasks -MF | sed 's/=.*//' | sort | diff - options || fail "an option that --batch does not know"
for option in "--cell 0.5" "--grid-of beams" "--height 1" "--plane 1" "--parallax 30" "--density 50" \
    "--include-files anywhere" "--max-work none"; do
    # shellcheck disable=SC2086
    coverage -q --batch two $option >of_two
    # shellcheck disable=SC2086
    { coverage -q --json square.env half.3dm $option && coverage -q --json square.env whole.3dm $option; } >ones
    expect_same ones of_two "a batch with $option differs from single runs"
done
cp -r "$scenes/house" "$data/house.3dm" .
printf 'house/house.env house.3dm\n' >storeys
coverage -q --any-environment --batch storeys --storey upper >of_two
coverage -q --any-environment --json house/house.env house.3dm --storey upper >ones
expect_same ones of_two "a batch with --storey differs from single runs"
expect_error 2 coverage --batch two -o two
cmp two <(printf 'square.env half.3dm\nsquare.env whole.3dm\n') || fail "the list was replaced"

# Shares joined are the whole, for any number of them.
for count in 2 3 9; do
    for index in $(seq $count); do
        # shellcheck disable=SC2086
        coverage -q $options --batch list --shard "$index/$count" >"share$index"
    done
    # shellcheck disable=SC2046
    cat $(seq -f share%g $count) >joined
    expect_same single joined "$count shares joined differ from the whole"
done

# Killed again and again, a run ends with the same bytes, messages and status. The test kills only after the first
# stored report; the list is so long that it cannot miss the time after that.
for _ in $(seq 400); do cat bad; done >long
coverage --batch long -j 2 --require 40% --junit whole.xml >whole 2>err.whole || [ $? -eq 1 ]
lines() { if [ -e "$1" ]; then wc -l <"$1"; else echo 0; fi; }
kills=0
while :; do
    before=$(lines gone_on.resume)
    coverage --batch long -j 2 --require 40% --resume -o gone_on --junit gone_on.xml 2>err.gone_on &
    job=$!
    if [ $kills -lt 12 ]; then
        while [ "$(lines gone_on.resume)" -le "$before" ] && kill -0 "$job" 2>/dev/null; do :; done
        sleep "0.00$((RANDOM % 10))"
        kill -9 "$job" 2>/dev/null && kills=$((kills + 1))
    fi
    status=0
    wait "$job" 2>/dev/null || status=$?
    [ "$status" -eq 137 ] || break
done
[ "$status" -eq 1 ] && [ "$kills" -ge 1 ] || fail "status $status after $kills kills: $(cat err.gone_on)"
expect_same whole gone_on "what was killed and gone on with differs from a whole run"
expect_same whole.xml gone_on.xml "its JUnit file does"
expect_same err.whole err.gone_on "its messages do"
[ ! -e gone_on.resume ] || fail "the checkpoint is left"

# A list may come through a pipe, and a signal ends the wait for its writer.
[ "$(coverage --batch <(cat two) | wc -l)" -eq "$(coverage --batch two | wc -l)" ] || fail "not through a pipe"
mkfifo unwritten
for signal in INT TERM; do
    for also in "" "--resume -o pipe.jsonl" "--require 40% --junit pipe.xml"; do
        # shellcheck disable=SC2086
        interrupt $signal 0.2 "$binary_dir/bin/coverage" --batch unwritten $also
    done
done

# coverage rejects the reports of another run, and keeps them.
coverage --batch long -j 1 --resume -o other.jsonl 2>/dev/null &
job=$!
for _ in $(seq 500); do [ -s other.jsonl.resume ] || sleep 0.01; done
kill -9 "$job" && wait "$job" 2>/dev/null || true
if [ -s other.jsonl.resume ]; then
    cp other.jsonl.resume kept
    expect_error 1 coverage --batch long --resume -o other.jsonl --grid 7
    expect_error 1 coverage --batch two --resume -o other.jsonl
    expect_same kept other.jsonl.resume "a checkpoint of another run was touched"
fi

# As JSON a message has its own severity and place; one without a place has that of the line.
printf '#env 1\nispace size=8,6\n' >plain.env
printf '#3dm 1\nlaser id=l1 at=0,0\nlaser id=l2 at=90,1\n' >out.3dm
echo 'plain.env out.3dm' >outside
coverage --batch outside --require 99.9% --errors json >/dev/null 2>err && fail "the requirement is met"
python3 - <<'END' || fail "messages of jobs as JSON: $(cat err)"
import json
first, second, last = [json.loads(line) for line in open("err", encoding="utf-8")]
place = [first.get(key) for key in ("severity", "file", "line", "column")]
assert place == ["warning", "out.3dm", 3, 1], first
assert first["message"].startswith("laser l2 stands outside the room"), first
assert (second["severity"], second["file"], second["line"]) == ("error", "outside", 1), second
assert second["message"].startswith("coverage is 50.00%"), second
assert last["status"] == 3, last
END
coverage --batch outside 2>&1 >/dev/null | has '^coverage: outside:1: out.3dm:3:1: warning: laser l2' ||
    fail "the line for people"
