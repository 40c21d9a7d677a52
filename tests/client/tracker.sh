#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Two people cross each other's way (thesis, section 5.3.2): the tracker that assigns their legs to all tracks at once
# keeps their identities, the simple one does not; judged against the record. By steps it does the same twice. It also
# follows streams of a world in real time.
. "$(dirname "$0")/../pipelines/common.sh"

tracker=$binary_dir/examples/tracker
envc "$scenes/walkers.3dm" --delete guest --set l1.sigma=0.01 --set l2.sigma=0.01 --to 3dm -o walkers.3dm

# follow LAYOUT SIMRUN_OPTION…
follow() {
    local layout=$1
    shift
    rm -f port
    simrun "$scenes/tracking.env" "$layout" "$@" --noise --record run --port-file port >announced 2>warnings &
    server=$!
    trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    timeout 60 "$tracker" "$(cat port)" "$layout" --until 40 -o tracks.csv >out 2>err ||
        fail "status $? of tracker: $(cat out err)"
    kill "$server"
    wait "$server" || fail "simrun with $*: status $?, $(cat warnings)"
}

# judged SOURCE: error at 95 %, share followed, switches.
judged() {
    sed -nE "s/^$1: error .* mean, ([0-9.]+) m at .* followed ([0-9.]+) %; ([0-9]+) identity.*/\1 \2 \3/p" verdicts
}

mixed=0
for seed in 1 2 3; do
    envc walkers.3dm --set "left.speed=0.$((6 + seed))" --set "right.pause=0.$((2 * seed))" --to 3dm -o walk.3dm
    follow walk.3dm --clock step --seed "$seed"
    "$source_dir/share/examples/tracker/judge_tracks.py" tracks.csv run >verdicts
    read -r error followed switches <<<"$(judged joint)"
    [ "$switches" -eq 0 ] || fail "seed $seed: the joint tracker mixes people up: $(cat verdicts)"
    awk "BEGIN { exit !($error < 0.1 && $followed > 98) }" || fail "seed $seed: $(cat verdicts)"
    for laser in l1 l2; do
        read -r _ _ switches <<<"$(judged $laser)"
        mixed=$((mixed + switches))
    done
done
[ "$mixed" -gt 0 ] || fail "the simple tracker mixes up nobody"
cp tracks.csv first.csv
follow walk.3dm --clock step --seed 3
expect_same first.csv tracks.csv "other tracks the second time"

follow walkers.3dm --clock real:10
"$source_dir/share/examples/tracker/judge_tracks.py" tracks.csv run >verdicts
read -r error followed _ <<<"$(judged joint)"
awk "BEGIN { exit !($error < 0.3 && $followed > 60) }" || fail "in real time: $(cat verdicts)"

# A simrun that ends too soon.
rm -f port
simrun "$scenes/tracking.env" walkers.3dm --clock step --until 2 --port-file port >announced 2>warnings &
server=$!
trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
expect_status 3 timeout 60 "$tracker" "$(cat port)" walkers.3dm --until 40 -o short.csv
one_error tracker "simrun ends before --until"
kill "$server" 2>/dev/null || true
wait "$server" || true

# A person without a track is not followed.
cat >truth.py <<'END'
import sys
sys.path.insert(0, sys.argv[1])
import judge_tracks
truth = {at: {"a": (0, 0)} for at in (0, 100, 200, 300)}
sources = {"none": {0: {"1": (0, 0.1)}}, "all": {at: {"1": (0, 0)} for at in truth}}
verdict = judge_tracks.judge(truth, sources, "none")
assert verdict.present == 4 and verdict.followed == 0.25, verdict
assert judge_tracks.judge(truth, sources, "all").followed == 1
END
python3 -B truth.py "$source_dir/share/examples/tracker" || fail "times without tracks do not count"

judge=$source_dir/share/examples/tracker/judge_tracks.py
for args in "tracks.csv none" "run/people.csv run"; do
    # shellcheck disable=SC2086
    expect_status 1 python3 "$judge" $args
    one_error judge_tracks.py "$args"
done

expect_status 0 "$tracker" --help
grep -q '^usage: tracker' out || fail "no help on standard output"
expect_status 2 "$tracker"
expect_status 2 "$tracker" 1 walkers.3dm --until 4x
expect_status 1 "$tracker" 1 walkers.3dm
expect_status 1 "$tracker" 1 none.3dm
