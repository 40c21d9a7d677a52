# SPDX-License-Identifier: GPL-3.0-or-later
"""A program of this machine announces thousands of participants of DDS that do not exist: simrun --ros2 forgets the
oldest of them, serves a node that it knew before, and ends at once."""
import os
import random
import shutil
import socket
import struct
import threading
import time

from dds_run import CLIENT, MODULE, Client, free_domain
from device_run import SOURCE, Run, check, scratch, skip

SECONDS = float(os.environ.get("ISPACE_FLOOD", "12"))
KINDS = ("new each time", "a few again and again", "each said to end", "with a short lease")


def of_parameter(packet, number):
    """The place of a parameter's value in an announcement, a list of them in little endian."""
    return packet.index(number.to_bytes(2, "little") + b"\x08\x00") + 4


def farewell(announcement, name):
    """A participant's end: a DATA submessage of its key alone, disposed of and unregistered."""
    inline = struct.pack("<HHBBBBHH", 0x71, 4, 0, 0, 0, 3, 1, 0)  # PID_STATUS_INFO, PID_SENTINEL
    key = b"\x00\x03\x00\x00" + struct.pack("<HH", 0x50, 16) + name + b"\x00\x00\x01\xc1" + struct.pack("<HH", 1, 0)
    data = struct.pack("<HH", 0, 16) + b"\x00\x01\x00\xc7\x00\x01\x00\xc2" + struct.pack("<iI", 0, 2) + inline + key
    return announcement[:8] + name + struct.pack("<BBH", 0x15, 0x0b, len(data)) + data


def flood(announcement, address, seconds, draw):
    """Returns how many announcements were sent."""
    own, sender, sent = announcement[8:20], socket.socket(socket.AF_INET, socket.SOCK_DGRAM), 0
    few = [draw.randbytes(12) for _ in range(400)]
    lease = of_parameter(announcement, 2)  # PID_PARTICIPANT_LEASE_DURATION
    begun = time.monotonic()
    while time.monotonic() - begun < seconds:
        kind = KINDS[int((time.monotonic() - begun) / seconds * len(KINDS))]
        for _ in range(20):
            name = draw.choice(few) if kind == KINDS[1] else draw.randbytes(12)
            packet = announcement.replace(own, name)
            if kind == KINDS[3]:
                packet = packet[:lease] + (1).to_bytes(4, "little") + bytes(4) + packet[lease + 8:]
            sender.sendto(packet, address)
            sent += 1
            if kind == KINDS[2]:
                sender.sendto(farewell(announcement, name), address)
        time.sleep(0.01)
    return sent


def main():
    if not MODULE.exists():
        skip("built without Cyclone DDS")
    draw = random.Random(3)
    domain = free_domain()
    base = 7400 + 250 * domain
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.bind(("127.0.0.1", base + 12))
    listener.settimeout(20)
    with scratch() as folder:
        os.chdir(folder)
        shutil.copy(SOURCE / "tests" / "data" / "square.env", "square.env")
        with open("layout.3dm", "w", encoding="ascii") as file:
            file.write("#3dm 1\nrobot id=r1 at=-1.2,-0.5\n")
        with Run("square.env", "layout.3dm", f"--ros2={domain}") as run:
            announcement = listener.recv(65536)
            node = Client(domain, "rt/r1/odom") if CLIENT.exists() else None
            if node:
                node.newest("rt/r1/odom")
            sent = flood(announcement, ("127.0.0.1", base + 10), SECONDS, draw)
            if node:
                had = len(node.seen["rt/r1/odom"])
                node.wait(lambda: len(node.seen["rt/r1/odom"]) > had, "odometry after the flood")
                threading.Thread(target=node.__exit__, args=(None,) * 3).start()
            with open(f"/proc/{run.process.pid}/status", encoding="ascii") as status:
                memory = next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024
            check(run.process.poll() is None, "simrun has ended")
            ended = time.monotonic()
            run.stop()
            took = time.monotonic() - ended
            print(f"{sent} participants, {memory:.0f} MiB, the end took {took:.2f} s")
            check(memory < 300, f"{memory:.0f} MiB after {sent} participants")
            check(took < float(os.environ.get("ISPACE_PATIENCE", "3")), f"TERM took {took:.1f} s")


main()
