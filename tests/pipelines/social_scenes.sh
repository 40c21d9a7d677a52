#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The scenes of share/benchmarks/social: the same results for any number of jobs and as stored, planners over TCP and
# over topics of ROS, and messages for those that fail. UPDATE_GOLDEN=1 stores the results anew: a scene that changes gets
# a new version.
. "$(dirname "$0")/common.sh"

bench=$source_dir/share/benchmarks/social
planner=$binary_dir/examples/social_planner
[ -x "$planner" ] || skip "no social_planner"
social() { /usr/bin/python3 "$bench/run.py" --build "$binary_dir" "$@" 2>err; }

[ "$(social --list | wc -l)" -eq 20 ] || fail "not twenty scenes"
social --list | awk '{ if ($2 < 1 || NF < 10) exit 1 }' || fail "a scene without a version or a question"
# Each file says what the list says, and is sound.
while IFS=$'\t' read -r asks file layout; do
    grep -qxF "# $asks" "$bench/$file" || fail "$file does not say: $asks"
    envc "$bench/$file" ${layout:+"$bench/$layout"} --check >said 2>&1 || fail "$(cat said)"
    [ ! -s said ] || fail "$file: $(cat said)"
done < <(/usr/bin/python3 -c "
import json
for scene in json.load(open('$bench/scenes.json'))['scenes']:
    print(scene['asks'], scene['file'], scene.get('layout', ''), sep='\t')")
# simrun's own GOTO, which knows all places, solves each of them.
social --baselines simrun --seeds 1 --jobs 2 -o solved >summary || fail "$(cat err)"
! grep '"success": false' solved/results.jsonl || fail "a scene that simrun does not solve"

part="--only distracted --only doorway --only lift --only obstruction --only queue --seeds 1"
# shellcheck disable=SC2086
social $part --jobs 1 -o one >summary.1 || fail "$(cat err)"
# shellcheck disable=SC2086
social $part --jobs 3 -o three >summary.3 || fail "$(cat err)"
cmp one/results.jsonl three/results.jsonl || fail "results depend on the number of jobs"
cmp summary.1 summary.3 || fail "summaries differ"
cmp summary.1 one/summary.md || fail "the summary in the folder differs"
grep -q "sha256:$(sha256sum <one/results.jsonl | cut -d' ' -f1)" summary.1 || fail "another digest"
[ "$(wc -l <one/results.csv)" -eq 16 ] || fail "not a row for each run"
[ ! -e one/runs/goal-lift-1 ] || fail "records are kept"
if [ -n "${UPDATE_GOLDEN:-}" ]; then cp one/results.jsonl "$data/social_part.jsonl"; fi
diff "$data/social_part.jsonl" one/results.jsonl || fail "results differ from the stored ones"
# The processor's newer instructions change no byte.
# shellcheck disable=SC2086
GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-FMA4,-AVX,-AVX_Usable \
    social $part -o old >summary.old || fail "$(cat err)"
cmp one/results.jsonl old/results.jsonl || fail "results depend on the processor"
# What tells the baselines apart: only one of them reacts to those that do not look.
/usr/bin/python3 - <<'END' || fail "the baselines do as they should not"
import json
rows = {(row["planner"], row["scene"]): row for row in map(json.loads, open("one/results.jsonl"))}
assert rows["goal", "distracted"]["person_collisions"] > 0
assert rows["orca", "distracted"]["person_collisions"] == 0 and rows["orca", "distracted"]["success"]
assert not rows["goal", "obstruction"]["success"] and rows["dwa", "obstruction"]["success"]
END

# A planner of one's own, in Python.
export PYTHONPATH=$source_dir/lib/client/python
mine="/usr/bin/python3 $bench/wait_for_people.py {server} {robot} {goal}"
social --only crossing --seeds 2 --baselines none --planner "waits=$mine" --keep -o mine >summary || fail "$(cat err)"
[ "$(grep -c '"success": true' mine/results.jsonl)" -eq 2 ] || fail "$(cat mine/results.jsonl)"
expect_status 0 coverage --run mine/runs/waits-crossing-1/run --goal goal --require success --require person_collisions=0
# Over topics of ROS.
ros="/usr/bin/python3 $bench/ros_planner.py {ros} {robot} {goal}"
social --only frontal --seeds 1 --baselines none --clock real:2 --planner "ros=$ros" -o ros >summary || fail "$(cat err)"
grep -q '"success": true' ros/results.jsonl || fail "$(cat ros/results.jsonl)"

# As worlds for learning: people go their ways from the starts of the scene, and an episode is judged as any run.
social --write rooms --seeds 2 || fail "$(cat err)"
[ "$(ls rooms | wc -l)" -eq 37 ] || fail "not 18 rooms of two seeds and a task: $(ls rooms)"
others=$(ls rooms/*.env | grep -v 'crossing-1' | sed 's/^/--room /')
# shellcheck disable=SC2086
{ echo reset; printf 'step\n%.0s' {1..80}; echo export 0 episode; echo quit; } |
    simrun rooms/crossing-1.env $others --vector 40 --shm "social-$$" --task rooms/task.yaml --seed 1 >replies ||
    fail "worlds for learning"
rm -f "/dev/shm/social-$$"
cd episode
$(sed -n '1s/^# //p' script.txt) --record run -q >addresses
expect_status 3 coverage --run run --goal goal --require success
grep -q 'the goal is not reached' err || fail "$(cat err)"
coverage --run run --goal goal --json >figures
grep -q '"duration":8,' figures || fail "$(cat figures)"
cd ..

# A planner that fails is named, with its last words; one that stands still fails the scene alone.
expect_status 1 /usr/bin/python3 "$bench/run.py" --build "$binary_dir" --only frontal --seeds 1 --baselines none \
    --planner 'bad=sh -c "echo no map >&2; exit 1"' -o bad
grep -q '^run.py: frontal: `sh` ends with status 1: no map$' err || fail "$(cat err)"
expect_status 2 /usr/bin/python3 "$bench/run.py" --only frontl
grep -q 'no scene frontl' err || fail "$(cat err)"
expect_status 2 /usr/bin/python3 "$bench/run.py" --baselines teb
expect_status 2 /usr/bin/python3 "$bench/run.py" --planner mine
social --only frontal --seeds 1 --baselines none --planner 'idle=true' -o idle >summary || fail "$(cat err)"
grep -q '"success": false' idle/results.jsonl || fail "$(cat idle/results.jsonl)"
