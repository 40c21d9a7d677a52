# SPDX-License-Identifier: GPL-3.0-or-later
"""A client of rosbridge that pauses gets each message of a run with --clock fast and --wait-for-readers; without it, the end of the
run says how many it lost."""
import json
import os
import re
import shutil
import socket
import time

from device_run import SOURCE, Run, check, scratch
from rosbridge import Rosbridge

SECONDS, SCANS = 20, 20 * 50


def scans(*options):
    """The number of scans that a slow client gets, and what the run says at its end."""
    with Run("square.env", "layout.3dm", "--clock", "step", "--rosbridge", "0", *options) as run:
        client = Rosbridge(run.first_line["rosbridge"])
        client.say({"op": "subscribe", "topic": "/l1/scan"})
        time.sleep(0.5)
        world = socket.create_connection(run.listen)
        world.sendall(f"WORLD\nSTEP {SECONDS * 200}\nSHUTDOWN\n".encode())
        count, times = 0, []
        while (message := client.message()) is not None:
            if message["op"] != "publish":
                continue
            count += 1
            stamp = message["msg"]["header"]["stamp"]
            times.append(stamp["sec"] * 50 + round(stamp["nanosec"] / 2e7))
            if count % 100 == 1:
                time.sleep(0.1)
        world.close()
        said = run.process.stderr.read()
        check(run.process.wait(timeout=60) == 0, "simrun failed: " + said)
    return times, said


def main():
    with scratch() as folder:
        os.chdir(folder)
        shutil.copy(SOURCE / "tests" / "data" / "square.env", "square.env")
        with open("layout.3dm", "w", encoding="ascii") as file:
            file.write("#3dm 1\nlaser id=l1 at=0,0,1 fov=360 step=0.25 rate=50\n")
        times, said = scans("--wait-for-readers")
        check("lost" not in said, said)
        first = times[0]
        check(times == list(range(first, first + len(times))) and len(times) >= SCANS, f"{len(times)} scans: {times[:9]}")
        times, said = scans()
        lost = re.search(r"slow readers lost (\d+) messages of topics \(--wait-for-readers keeps them\)", said)
        check(lost and int(lost[1]) > 0 and len(times) < SCANS, f"{len(times)} scans, and: {said}")
        print(f"{len(times)} scans without waiting, {lost[1]} lost")


main()
