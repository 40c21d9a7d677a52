#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The tracker as a network: three nodes that find people in the scans of six lasers, and a program that fuses what
# arrives of it. In lockstep it does the same twice, however fast the programs are; lost and late messages cost it
# little; one laser alone tracks worse.
. "$(dirname "$0")/../pipelines/common.sh"

examples=$binary_dir/examples
cp "$scenes/ispace.env" .
sed 's/range=7/range=7 sigma=0.01/' "$scenes/network.3dm" >network.3dm

# network LAYOUT SECONDS: runs the programs on it; the record is in run.
network() {
    rm -rf port run
    simrun ispace.env "$1" --clock fast --until "$2" --noise --seed 7 --record run --port-file port -q >announced 2>warnings &
    server=$!
    trap 'kill "$server" 2>/dev/null || true; cleanup' EXIT
    for ((i = 0; i < 3000; ++i)); do [ -s port ] && break; sleep 0.02; done
    local pids=()
    for node in n1 n2 n3; do
        timeout 120 "$examples/tracker_node" "$(cat port)" "$1" "$node" >"$node.out" 2>&1 &
        pids+=($!)
        [ "${slow:-}" = "$node" ] && sleep 1
    done
    timeout 120 "$examples/tracker_fusion" "$(cat port)" hub >fusion.out 2>&1 || fail "fusion: $(cat fusion.out)"
    for pid in "${pids[@]}"; do wait "$pid" || fail "a node: $(cat n?.out)"; done
    wait "$server" || fail "simrun: $(cat warnings)"
}

network network.3dm 30
[ "$(wc -l <run/tracks.csv)" -gt 500 ] || fail "few tracks: $(cat fusion.out n?.out)"
coverage --run run --tracks run/tracks.csv --truths people --json >judged.json
python3 - <<'END' || fail "the fusion tracks badly: $(cat judged.json)"
import json
judged = json.load(open("judged.json"))
assert judged["mota"] > 0.8, judged["mota"]
assert judged["motp"] < 0.15, judged["motp"]
END
cp -r run first
slow=n2 network network.3dm 30
for file in tracks people events; do cmp "first/$file.csv" "run/$file.csv" || fail "another $file.csv the second time"; done

# Many messages lost: it still tracks, with fewer findings.
sed 's/loss=1%/loss=40%/' network.3dm >lossy.3dm
network lossy.3dm 10
read -r fused _ <fusion.out
[ "$fused" -gt 200 ] && [ "$fused" -lt 450 ] || fail "$fused findings of 600 with 40 % lost"

expect_status 0 "$examples/tracker_node" --help
expect_status 2 "$examples/tracker_node" 1 network.3dm
expect_status 1 "$examples/tracker_node" 1 network.3dm n1
expect_status 2 "$examples/tracker_fusion" 1
expect_status 1 "$examples/tracker_fusion" 1 hub

# The client of Python, two nodes in one program.
grep -v '^node' network.3dm >python.3dm
cat >>python.3dm <<'END'
node id=n1 sensors=l1 delay=20ms skew=1000ppm lockstep=yes
node id=hub lockstep=yes
END
cat >nodes.py <<'END'
import concurrent.futures

import ispace

with ispace.simrun("ispace.env", "python.3dm", clock="fast", until=2) as run:
    with run.node("n1") as node, run.node("hub") as hub, run.world() as world:
        assert node.sensors == ["l1"] and node.lockstep and hub.sensors == []
        hub.hear("n1")
        scan = node.scan("l1", ispace.Scan)
        assert len(scan.ranges) == 181, len(scan.ranges)
        assert node.send("two  words") == 1
        with concurrent.futures.ThreadPoolExecutor() as pool:  # each waits for the other
            times = list(pool.map(lambda one: one.await_time(0.5), (node, hub)))
        assert 0.5 <= times[0] < 0.51 and 0.5 <= times[1] < 0.51, times
        message = hub.receive(1)
        assert (message.sender, message.number, message.text) == ("n1", 1, "two  words")
        assert abs(message.time - 0.02) < 1e-9, message
        node.track("a", 1, 2, 0.5, "person")
        world.track("b", -1, 0.5)
        try:
            node.scan("l2", ispace.Scan)
            raise AssertionError("l2 is no sensor of n1")
        except ispace.Refused as refused:
            assert refused.code == 404
END
PYTHONPATH=$source_dir/lib/client/python python3 -B nodes.py || fail "the client of Python"

# A node of a sensor that is not there.
printf 'node id=n9 sensors=l7\n' | cat network.3dm - >wrong.3dm
expect_status 1 simrun ispace.env wrong.3dm --clock fast --until 1
one_error simrun "an unknown sensor"
grep -q 'wrong.3dm:.*no placed sensor has the id `l7`' err || fail "$(cat err)"
