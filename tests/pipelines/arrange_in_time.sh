#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A limit of time holds for every strategy, objective and proof, also in a room where one view takes long.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
# Instrumented, single views take several seconds.
grep -q 'ISPACE_SANITIZE:[A-Z]*=OFF' "$binary_dir/CMakeCache.txt" || skip "instrumented"

# A star of walls: from a point between them nearly all are in sight.
python3 - <<'END' >star.env
import math
print("#env 1\nispace size=40,30\nzone id=a at=-17,-12 size=2,2\nzone id=b at=17,12 size=2,2")
for i in range(2500):
    angle = math.radians(137.5 * i)
    print(f"wall from=0,0 to={14 * math.cos(angle):.3f},{14 * math.sin(angle):.3f}")
END
printf -- '-15,-12,0\n15,12,180\n' >places.csv

python3 - <<'END' || fail "a limit of a second does not hold"
import os, re, resource, subprocess, sys, time

help_text = subprocess.run(["arrange", "--help", "all"], stdout=subprocess.PIPE, text=True, check=True).stdout
choices = lambda option: re.search(rf"{option} ([a-z|]+)", help_text)[1].split("|")
strategies, optimizers = choices("--strategy"), choices("--optimize")
proofs = choices("--proof")
assert len(strategies) >= 6 and len(optimizers) >= 3 and len(proofs) >= 2, (strategies, optimizers, proofs)
laser, uwb = "laser,range=8,fov=180:2", "uwb:3"
objectives = {"coverage": [], "localise": ["--objective", "localise"]}

runs = [[laser, "--strategy", s] for s in strategies if s != "list"]
runs += [[uwb, "--strategy", s, *objectives["localise"]] for s in strategies if s != "list"]
runs += [[uwb, "--strategy", "list", "--places", "places.csv"]]
runs += [[sensor, *how] for sensor in (laser, uwb) for how in objectives.values()]
runs += [[laser, "--optimize", o] for o in optimizers]
runs += [[laser, "--proof", p] for p in proofs if p != "poses"]  # not of walls without thickness
path = ["--objective", "path:a,b", "--optimize"]
runs += [[sensor, *path, o] for sensor in (laser, "camera:2") for o in ("greedy", "exact")]
runs += [["ultrasound:5"], ["pir:2"], ["radar:2"], ["rfid:2"], ["ranger,range=5:2"], [laser, "--crowd", "20"],
         [laser, "--connected"], [laser, "--target", "60%"], [laser, "--privacy", "b"]]
runs += [[laser, "--redundancy", "2"], [laser, "--refine"], [laser, "--robust", "mounting:5cm,3deg"],
         [laser, "--alternatives", "2"]]
slowest, wrong = (0, []), []
for sensor, *how in runs:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    made = subprocess.run(["arrange", "star.env", "--sensor", sensor, *how, "--time-limit", "1s", "-j", "1", "-q",
                           "--no-progress", "-o", "out.3dm"], stderr=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # Processor time, as others may keep the machine busy.
    took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    slowest = max(slowest, (took, [sensor, *how]))
    print(f"{took:.1f} s: {sensor} {' '.join(how)} ({made.returncode})")
    if made.returncode not in (0, 3) or took > 3:
        wrong.append((took, made.returncode, sensor, how, made.stderr[-300:]))
print("slowest:", *slowest)
assert not wrong, "\n".join(map(str, wrong))
END
