# SPDX-License-Identifier: GPL-3.0-or-later
"""A long run of 100 robots, as fast as it goes and recorded, with clients that come and go. An hour of torture simulates
24 hours. Memory is flat, and the record has every step of every robot, in order."""
import os
import shutil
import statistics
import time

import clients
import lab as labs

ROBOTS = 100
HOURS = 24       # simulated, in an hour of torture
DT = 0.25        # seconds; the record of 24 hours has 35 million rows
PER_ROW = 80     # bytes of a row at most
MOST_GROWTH = 24 * labs.MIB


def write_scene(folder):
    with open(os.path.join(folder, "yard.env"), "w", encoding="utf-8") as file:
        file.write("#env 1\nfence path=0,0;60,0;60,60;0,60 closed=yes\n")
        file.writelines(f"cube at={6 + 12 * (i % 5)},{6 + 12 * (i // 5)} size=2,2,1\n" for i in range(25))
    with open(os.path.join(folder, "crowd.3dm"), "w", encoding="utf-8") as file:
        file.write("#3dm 1\nlaser id=l1 at=30,1 heading=90 step=10 rate=1\n")
        file.writelines(f"robot id=r{i} at={3 + 6 * (i % 10)},{3 + 6 * (i // 10)} walk=wander\n" for i in range(ROBOTS))


def visit(lab, port, kept):
    """A client comes, asks, and goes in one of several ways."""
    # A robot that was driven stands still when its client has gone: only a few are.
    role = lab.random.choice(("WORLD", "LASER l1", f"ROBOT r{lab.random.randrange(5)}"))
    client = clients.Client(port)
    client.socket.sendall(f"{role}\nTIME\nSTREAM\nEVENTS\nPOSES\n".encode())
    lab.count("visits")
    kept.append(client)
    while len(kept) > 8:
        leaving = kept.pop(lab.random.randrange(len(kept)))
        lab.random.choice((leaving.reset, leaving.close))()


def check_robots(lab, path, steps):
    """Every step has a row of each robot, in their order, and times advance by a step."""
    ids, row, last = [], 0, None
    with open(path, encoding="ascii") as file:
        next(file)
        for line in file:
            t, _, rest = line.partition(",")
            robot = rest.partition(",")[0]
            if row < ROBOTS:
                ids.append(robot)
            if robot != ids[row % ROBOTS]:
                return lab.violated(f"row {row + 2} of robots.csv is of {robot}, not of {ids[row % ROBOTS]}")
            if row % ROBOTS == 0:
                if last is not None and abs(float(t) - last - DT) > 1e-6:
                    return lab.violated(f"row {row + 2} of robots.csv is of t={t}, the step before of {last}")
                last = float(t)
            elif float(t) != last:
                return lab.violated(f"row {row + 2} of robots.csv is of t={t} within the step of {last}")
            row += 1
    lab.count("rows", row)
    if row != ROBOTS * (steps + 1):
        lab.violated(f"{row} rows of robots.csv after {steps} steps of {ROBOTS} robots")
    return None


def check_scans(lab, path):
    numbers = []
    with open(path, encoding="utf-8") as file:
        next(file)
        for line in file:
            numbers.append(int(line.partition('"frame":')[2].partition(",")[0]))
    lab.count("scans", len(numbers))
    if numbers != list(range(len(numbers))):
        lab.violated("frames of scans.jsonl are not 0, 1, 2, ...")


def run(lab):
    hours = HOURS * lab.minutes / 60
    write_scene(lab.folder)
    port_file = os.path.join(lab.folder, "port")
    begin = time.monotonic()
    with open(os.path.join(lab.folder, "simrun.err"), "wb") as said:
        process = lab.start(["simrun", "yard.env", "crowd.3dm", "--clock", "fast", "--dt", str(DT), "--until", f"{hours:.4f}h",
                             "--record", "run", "--record-limit", f"{int(hours * 3600 / DT * ROBOTS * PER_ROW / labs.MIB) + 500}M",
                             "--port-file", port_file, "-q"], lab.folder, err=said)
    while not os.path.exists(port_file) or not os.path.getsize(port_file):
        if process.poll() is not None:
            return lab.violated(f"simrun ended with status {process.returncode} at once")
        time.sleep(0.01)
    with open(port_file, encoding="ascii") as file:
        port = int(file.read())
    memory, kept = [], []
    while process.poll() is None:
        memory.append(clients.memory(process.pid))
        try:
            visit(lab, port, kept)
        except OSError:
            pass  # it ends just now; its status tells more
        time.sleep(0.05)
    took = time.monotonic() - begin
    if process.returncode != 0:
        with open(os.path.join(lab.folder, "simrun.err"), encoding="utf-8", errors="replace") as said:
            lab.violated(f"simrun ended with status {process.returncode}: {said.read()[-300:]}")
    memory = [bytes_used for bytes_used in memory if bytes_used]
    quarter = max(1, len(memory) // 4)
    early, late = statistics.median(memory[quarter:2 * quarter] or memory), statistics.median(memory[-quarter:])
    lab.say(f"{hours:.2f} simulated hours of {ROBOTS} robots in {took:.0f} s, {late / labs.MIB:.0f} MiB, "
            f"{(late - early) / labs.MIB:+.1f} MiB since the first quarter")
    if late - early > MOST_GROWTH:
        lab.violated(f"memory grows: {early / labs.MIB:.0f} MiB in the second quarter, {late / labs.MIB:.0f} in the last one")
    record = os.path.join(lab.folder, "run")
    with open(os.path.join(record, "info.csv"), encoding="ascii") as info:
        steps = int(info.read().splitlines()[1].split(",")[2])
    if steps != round(hours * 3600 / DT) and abs(steps - hours * 3600 / DT) > 1:
        lab.violated(f"{steps} steps in {hours} h of {DT} s each")
    check_robots(lab, os.path.join(record, "robots.csv"), steps)
    check_scans(lab, os.path.join(record, "scans.jsonl"))
    if not lab.violations:
        shutil.rmtree(record)  # gigabytes
    return None
