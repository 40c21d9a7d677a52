# SPDX-License-Identifier: GPL-3.0-or-later
"""Two robots and three lasers of two models, at ten times real time: no packet is lost or torn. A minute of simulated
time, or ISPACE_WIRE_SECONDS seconds."""
import os
import pathlib
import socket
import threading
import time

from device_run import SCENES, Run, check, scratch
from pioneer import CLOSE, ENABLE, OPEN, RVEL, STATUS, VEL, Pioneer, packet

LAYOUT = """#3dm 1
robot id=r1 model=pioneer-3dx at=3,2
robot id=r2 model=pioneer-3dx at=3,-2 heading=180
laser id=ride on=r1 at=0.1,0,0.3 range=0.02,10
laser id=urg1 model=urg-04lx at=-3,3 heading=-45
laser id=urg2 model=urg-04lx on=r2 at=0.1,0,0.3
laser id=utm model=utm-30lx at=-3,-3 heading=45
"""
SECONDS = float(os.environ.get("ISPACE_WIRE_SECONDS", "60"))
RATE = 10
# Steps, scans a second, milliseconds between two of them (those of the UTM are rounded to 5 ms steps).
LASERS = {"urg1": (44, 725, 10), "urg2": (44, 725, 10), "utm": (0, 1080, 40)}


class Failed(Exception):
    pass


def require(condition, message):
    if not condition:
        raise Failed(message)


def drive(where, name, results):
    """Circles; every status counts a tenth of a second of simulated time."""
    robot = Pioneer(where)
    for number, value in ((OPEN, 1), (36, -90), (37, 90), (38, 100), (35, 1), (ENABLE, 1),
                          (VEL, 200), (RVEL, 25)):
        robot.send(number, value)
    robot.until(lambda s: s.left and robot.scans > 1)
    statuses, scans = robot.statuses, robot.scans
    robot.until(lambda s: robot.statuses == statuses + round(10 * SECONDS), round(11 * SECONDS) + 100)
    # The last status may have come without its scan as yet.
    lost = robot.statuses - statuses - (robot.scans - scans)
    require(abs(lost) <= 1, f"{lost} scans are lost")
    robot.send(ENABLE, 0)
    robot.socket.sendall(packet(CLOSE))
    results[name] = f"{robot.statuses} statuses, {robot.scans} scans"


def sum_of(line):
    return chr((sum(line) & 0x3F) + 0x30).encode()


def number_of(text):
    value = 0
    for c in text:
        value = value << 6 | c - 0x30
    return value


def scan(where, name, results):
    """Streams scans without end, and looks at every byte of each."""
    first, last, rate = LASERS[name]
    stream = socket.create_connection(where, timeout=30).makefile("rwb")
    request = f"MD{first:04}{last:04}01000".encode()
    stream.write(b"BM\n" + request + b"\n")
    stream.flush()
    times = []

    def read_packet():
        lines = []
        while True:
            line = stream.readline()
            require(line.endswith(b"\n"), "half a line")
            if line == b"\n":
                return lines
            lines.append(line[:-1])

    require(read_packet()[0] == b"BM", "no answer to BM")
    require(read_packet() == [request, b"00P"], "no answer to MD")
    while not times or times[-1] - times[0] < 1000 * SECONDS:
        head, status, *lines = read_packet()
        require(head == request[:-2] + b"00" and status == b"99b", f"a scan headed {head} {status}")
        for line in lines:
            require(line[-1:] == sum_of(line[:-1]), "a wrong check character")
        data = b"".join(line[:-1] for line in lines[1:])
        require(len(data) == 3 * (last - first + 1), f"{len(data)} bytes of ranges")
        times.append(number_of(lines[0][:-1]))
    stream.write(b"QT\n")
    stream.flush()
    stream.close()
    gaps = [b - a for a, b in zip(times, times[1:])]
    period = 1000 / rate
    require(max(gaps) <= period + 5 and min(gaps) >= period - 5,
            f"gaps from {min(gaps)} to {max(gaps)} ms between scans {period} ms apart")
    results[name] = f"{len(times)} scans, {min(gaps)} to {max(gaps)} ms apart"


def watched(work, where, name, results, failures):
    try:
        work(where, name, results)
    except (Failed, SystemExit, EOFError, OSError) as failure:
        failures.append(f"{name}: {failure!r}")


def main():
    pathlib.Path("all.3dm").write_text(LAYOUT)
    ports = [argument for name in ("r1", "r2") for argument in ("--p2os", name + "=0")]
    ports += [argument for name in LASERS for argument in ("--scip", name + "=0")]
    results, failures, threads = {}, [], []
    began = time.monotonic()
    with Run(SCENES / "ispace.env", "all.3dm", "--clock", f"real:{RATE}", *ports) as run:
        for work, devices in ((drive, run.ports["p2os"]), (scan, run.ports["scip"])):
            for name, where in devices.items():
                threads.append(threading.Thread(target=watched,
                                                args=(work, where, name, results, failures)))
                threads[-1].start()
        for thread in threads:
            thread.join()
    wall = time.monotonic() - began
    for name, result in sorted(results.items()):
        print(f"{name}: {result}")
    print(f"{SECONDS:g} simulated seconds in {wall:.1f} s")
    check(not failures, "; ".join(failures))
    check(len(results) == 5, "not all of them ended")


if __name__ == "__main__":
    with scratch() as folder:
        os.chdir(folder)
        main()
