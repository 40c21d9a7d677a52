#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The gates for GitHub and GitLab in share/examples: they are YAML that says what it should, and their
# commands pass a layout that sees enough, and stop one that does not.
. "$(dirname "$0")/common.sh"

junit="$source_dir/tests/schemas/junit.py"
python3 "$junit" --self-test || fail "the JUnit schema"
python3 -c 'import yaml' 2>/dev/null || skip "no python3-yaml"

# commands_of FILE: the commands of the gate, a line each, without those that install ispace.
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
    lines = [step["run"] for step in job["steps"] if "run" in step]
else:
    assert job["artifacts"]["reports"]["junit"] == "coverage.xml" and job["artifacts"]["when"] == "always"
    lines = job["before_script"] + job["script"]
assert lines[0].startswith("apt-get ")
print(*lines[1:], sep="\n")
PY
}

for server in github gitlab; do
    commands_of "$source_dir/share/examples/ci-$server.yaml" >gate.sh || fail "$server: no such gate"
    [ "$(wc -l <gate.sh)" -eq 3 ] || fail "$server: not three lines: $(cat gate.sh)"
    mkdir "$server"
    cp "$data/square.env" "$server/room.env"
    cp "$data/whole.3dm" "$server/best.3dm"
    coverage "$server/room.env" "$server/best.3dm" --json >"$server/expected.json"
    (cd "$server" && sh -e ../gate.sh >../out 2>../err) || fail "$server: $(cat out err)"
    python3 "$junit" "$server/coverage.xml" || fail "$server: JUnit"
    grep -q 'tests="1" failures="0"' "$server/coverage.xml" || fail "$(cat "$server/coverage.xml")"

    # A layout that sees half of it, and one that sees enough, but not the same.
    cp "$data/half.3dm" "$server/best.3dm"
    status=0
    (cd "$server" && sh -e ../gate.sh >../out 2>../err) || status=$?
    [ "$status" -eq 3 ] || fail "$server: status $status of a layout that sees half: $(cat err)"
    grep -q 'tests="1" failures="1"' "$server/coverage.xml" || fail "$(cat "$server/coverage.xml")"
    python3 "$junit" "$server/coverage.xml" || fail "$server: JUnit of a failure"
    sed 's/at=0.01/at=0.5/' "$data/whole.3dm" >"$server/best.3dm"
    ! cmp -s "$data/whole.3dm" "$server/best.3dm" || fail "nothing moved"
    status=0
    (cd "$server" && sh -e ../gate.sh >../out 2>../err) || status=$?
    [ "$status" -eq 1 ] || fail "$server: status $status of another layout: $(cat err)"
    grep -q '^report.json differs from expected.json, line 1:' out || fail "$(cat out)"
done
