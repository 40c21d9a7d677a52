#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The gates for GitHub and GitLab in share/examples are valid YAML, and their commands pass a harmless edit of
# the room (0), stop one that costs coverage (3) and one that breaks the room (1), with JUnit in each case.
. "$(dirname "$0")/common.sh"

junit="$source_dir/tests/schemas/junit.py"
python3 "$junit" --self-test || fail "the JUnit schema"
python3 -c 'import yaml' 2>/dev/null || skip "no python3-yaml"

# commands_of FILE: gate.sh, which stops at the first failure as servers do, and report.sh, run in any case.
commands_of() {
    python3 - "$1" <<'PY'
import sys, yaml
document = yaml.safe_load(open(sys.argv[1]))
job = document["jobs"]["coverage"] if "jobs" in document else document["coverage"]
if "jobs" in document:
    assert set(document[True]) == {"push", "pull_request"}, "YAML reads `on` as true"
    assert all(("run" in step) != ("uses" in step) for step in job["steps"])
    upload = job["steps"][-1]
    assert upload["if"] == "always()" and "coverage.xml" in upload["with"]["path"].split()
    steps = [step for step in job["steps"] if "run" in step]
    gate = [step["run"] for step in steps if "if" not in step]
    report = [step["run"] for step in steps if step.get("if") == "always()"]
else:
    assert job["artifacts"]["reports"]["junit"] == "coverage.xml" and job["artifacts"]["when"] == "always"
    gate, report = job["before_script"] + job["script"], job["after_script"]
assert gate[0].startswith("apt-get ") and len(gate) == 3 and len(report) == 1
open("gate.sh", "w").write("\n".join(gate[1:]) + "\n")
open("report.sh", "w").write("\n".join(report) + "\n")
PY
}

# expect_gate STATUS JUNIT MESSAGE: the gate in ./$server returns this status, and its JUnit file holds these counts.
expect_gate() {
    local status=0
    rm -f "$server/coverage.xml"
    (cd "$server" && bash -e ../gate.sh >../out 2>../err) || status=$?
    [ "$status" -eq "$1" ] || fail "$server: status $status of $3: $(cat err)"
    (cd "$server" && bash -e ../report.sh >../changes 2>>../err) || :
    python3 "$junit" "$server/coverage.xml" || fail "$server: JUnit of $3"
    grep -q "$2" "$server/coverage.xml" || fail "$server: $3: $(cat "$server/coverage.xml")"
}

for server in github gitlab; do
    commands_of "$source_dir/share/examples/ci-$server.yaml" || fail "$server: no such gate"
    mkdir "$server"
    printf '%s\n' '#env 1' 'ispace id=room size=6,4' 'desk id=d at=2,1 size=1,0.5,0.4' >"$server/room.env"
    envc "$server/room.env" -o keep.env
    arrange "$server/room.env" --sensor laser,fov=360:1 -q -o "$server/best.3dm"
    (cd "$server" && coverage room.env best.3dm --json >expected.json)
    expect_gate 0 'tests="1" failures="0" errors="0"' "the room as it was"
    [ ! -s err ] || fail "$server: $(cat err)"
    [ ! -s changes ] || fail "$server: nothing has changed: $(cat changes)"

    # The desk moves by a hand: another digest, one warning, the same verdict.
    envc keep.env --move d:0.05,0 --to env -o "$server/room.env"
    expect_gate 0 'tests="1" failures="0" errors="0"' "a harmless edit"
    [ "$(grep -c 'warning: the layout was made for another environment (room.env, sha256:' err)" -eq 2 ] ||
        fail "$server: no warning by each tool: $(cat err)"
    grep -qE '^free_area: [0-9.]+ → [0-9.]+ \(±1e-6\)$|^coverage.exact: [0-9.]+ → [0-9.]+ \(±1e-6\)$' changes ||
        fail "$server: $(cat changes)"
    ! grep -qE 'digest|version' changes || fail "$server: $(cat changes)"

    # A wall of boxes hides half of the room.
    envc keep.env --add 'cube at=0,0.5 size=0.5,3,2' --to env -o "$server/room.env"
    expect_gate 3 'tests="1" failures="1" errors="0"' "a harmful edit"
    grep -qE '^coverage.exact: 0\.[0-9]+ → 0\.[0-9]+ \(±1e-6\)$' changes || fail "$server: $(cat changes)"

    # A room that cannot be read: its error is in the report for the server.
    printf '%s\n' '#env 1' 'ispace size=6,4' 'desk at=2,1 size=no' >"$server/room.env"
    expect_gate 1 'tests="1" failures="0" errors="1"' "a broken room"
    grep -q '<error message="room.env:3:.*: error: ' "$server/coverage.xml" || fail "$(cat "$server/coverage.xml")"
done

# The layout's record alone names the room: an error. So it is with --same-environment.
cd github
envc ../keep.env --move d:0.05,0 --to env -o room.env
expect_error 1 coverage best.3dm
grep -q 'error: the layout was made for another environment (room.env, sha256:' err || fail "$(cat err)"
expect_status 0 coverage best.3dm --any-environment
[ ! -s err ] || fail "$(cat err)"
for job in "coverage room.env best.3dm" "scan room.env best.3dm" "envc room.env best.3dm --to glb" \
    "arrange room.env best.3dm --sensor laser -q" "simrun room.env best.3dm --clock fast --until 0.01"; do
    expect_status 1 $job --same-environment
    grep -q 'error: the layout was made for another environment (room.env, sha256:.*) than room.env (sha256:' err ||
        fail "$job: $(cat err)"
    job=${job% -q}
    expect_status 0 $job
    [ "$(grep -c 'warning: the layout was made for another environment' err)" -eq 1 ] || fail "$job: $(cat err)"
    expect_status 0 $job --any-environment
    ! grep -q 'another environment' err || fail "$job: $(cat err)"
done

# Neither an input nor another output is replaced by the report of an error, and a run that fails has its own.
cp room.env keep.env
expect_status 2 coverage room.env best.3dm --require 90% --junit room.env
expect_status 2 coverage room.env best.3dm --require 90% --junit map.svg -o map.svg
expect_same room.env keep.env "an error replaced the room"
[ ! -e map.svg ] || fail "an error was written where the map belongs"
expect_status 2 coverage room.env best.3dm --require zone:none=90% --junit unknown.xml
grep -q '<error message="error: the room has no zone `none`' unknown.xml || fail "$(cat unknown.xml)"
expect_status 1 coverage --batch missing.txt --require 90% --junit batch.xml -o batch.jsonl
grep -q '<error message="missing.txt: error: No such file' batch.xml || fail "$(cat batch.xml)"
expect_status 1 simrun missing.env --expect 'no collision' --junit run.xml
grep -q '<error message="missing.env: error: No such file' run.xml || fail "$(cat run.xml)"
