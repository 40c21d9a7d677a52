# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the scripts PORT PID KIND: clients of a running simrun, and its use of the machine."""
import os
import socket
import struct
import sys
import time

PORT, PID, KIND = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
MIB = 1 << 20


def memory(name):
    """VmRSS or VmHWM in bytes."""
    with open(f"/proc/{PID}/status", encoding="ascii") as status:
        for line in status:
            if line.startswith(name + ":"):
                return int(line.split()[1]) * 1024
    raise SystemExit("no " + name)


def descriptors():
    return len(os.listdir(f"/proc/{PID}/fd"))


def threads():
    return len(os.listdir(f"/proc/{PID}/task"))


def check(holds, what):
    if not holds:
        raise SystemExit("attack.py: " + what)


class Client:
    def __init__(self, role="", buffer=0):
        self.socket = socket.socket()
        if buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
        self.socket.settimeout(60)
        self.socket.connect(("127.0.0.1", PORT))
        self.file = self.socket.makefile("rb")
        if role:
            self.line()
            answer = self.ask(role)
            check(answer.startswith("OK "), f"{role}: {answer}")

    def line(self):
        return self.file.readline().decode(errors="replace").rstrip("\n")

    def ask(self, request):
        self.send(request + "\n")
        return self.line()

    def send(self, text):
        self.socket.sendall(text.encode())

    def push(self, data):
        """As much as goes without waiting."""
        self.socket.setblocking(False)
        try:
            return self.socket.send(data)
        except (BlockingIOError, ConnectionError):
            return 0

    def reset(self):
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.close()

    def close(self):
        self.file.close()
        self.socket.close()


def eventually(holds, what):
    end = time.monotonic() + 30
    while not holds():
        check(time.monotonic() < end, what)
        time.sleep(0.05)
