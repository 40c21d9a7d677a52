# SPDX-License-Identifier: GPL-3.0-or-later
"""Clients of a running simrun: honest readers that check each line they get, and a WebSocket."""
import base64
import os
import re
import socket
import struct
import time

SCAN = re.compile(rb"SCAN (\S+) t=([0-9.]+) seq=([0-9]+) angle_min=-?[0-9.]+ angle_max=-?[0-9.]+ step=[0-9.]+ "
                  rb"n=([0-9]+) stream=1 r=([0-9.,-]*)$")
FRAME = re.compile(rb"SCAN (\S+) t=([0-9.]+) seq=([0-9]+) pose=[0-9.,-]+ format=png width=[0-9]+ height=[0-9]+ "
                   rb"stream=1 bytes=([0-9]+)$")


class Wrong(Exception):
    """A client got something that the protocol does not have."""


class Client:
    def __init__(self, port, role=None, patience=30):
        self.socket = socket.create_connection(("127.0.0.1", port), patience)
        self.file = self.socket.makefile("rb")
        if role is not None:
            greeting = self.line()
            if greeting != b"ISPACE 1":
                raise Wrong(f"the greeting is {greeting!r}")
            answer = self.ask(role)
            if not answer.startswith(b"OK "):
                raise Wrong(f"{role} is answered {answer!r}")

    def line(self):
        line = self.file.readline()
        if not line.endswith(b"\n"):
            raise ConnectionError(f"closed behind {line[-80:]!r}")
        return line[:-1]

    def ask(self, request):
        """Returns the reply; skips unrequested lines."""
        self.socket.sendall(request.encode() + b"\n")
        while True:
            line = self.line()
            if line.startswith((b"OK ", b"ERR ", b"SCAN ")) and b" stream=1 " not in line:
                return line

    def reset(self):
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.close()

    def close(self):
        self.file.close()
        self.socket.close()


class StreamReader:
    """Reads a laser or a camera to the end of the run; each reading is whole, and later than the one before."""

    def __init__(self, port, role):
        self.client, self.seen, self.last = Client(port, role, patience=None), 0, (-1.0, -1)
        self.pattern = FRAME if role.startswith("SENSOR") else SCAN
        self.client.ask("STREAM")

    def read(self):
        """Reads one reading; raises ConnectionError at the end of the run, Wrong if it is invalid."""
        line = self.client.line()
        if line.startswith(b"EVENT "):
            return
        found = self.pattern.match(line)
        if not found:
            raise Wrong(f"not a line of a stream: {line[:200]!r}")
        moment = float(found[2]), int(found[3])
        if moment[0] < self.last[0] or moment[1] <= self.last[1]:
            raise Wrong(f"t, seq = {moment} after {self.last}")
        if self.pattern is SCAN and found[5].count(b",") + 1 != int(found[4]):
            raise Wrong(f"{found[5].count(b',') + 1} ranges, n={int(found[4])}")
        if self.pattern is FRAME:
            picture = self.client.file.read(int(found[4]))
            if len(picture) < int(found[4]):
                raise ConnectionError("closed within a picture")
            if not picture.startswith(b"\x89PNG\r\n") or not picture.endswith(b"IEND\xaeB`\x82"):
                raise Wrong(f"a picture of {len(picture)} bytes that is no PNG")
        self.last = moment
        self.seen += 1


class WebSocket:
    """A connection to /ws that answers pings when it is asked to."""

    def __init__(self, port, patience=30):
        self.socket = socket.create_connection(("127.0.0.1", port), patience)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.accepted = b" 101 " in self.socket.recv(4096).split(b"\r\n")[0]

    def send(self, data, opcode=1):
        mask = os.urandom(4)
        size = struct.pack("!B", 128 | len(data)) if len(data) < 126 else struct.pack("!BH", 254, len(data))
        self.socket.sendall(bytes([128 | opcode]) + size + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def answer_pings(self):
        """A pong for whatever has come; false if the connection is closed."""
        self.socket.setblocking(False)
        try:
            data = self.socket.recv(1 << 16)
            if not data:
                return False
            self.socket.setblocking(True)
            self.send(b"", opcode=10)
        except BlockingIOError:
            pass
        except OSError:
            return False
        return True


def memory(pid, name="VmRSS"):
    """In bytes; 0 for a process that has ended."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii") as status:
            for line in status:
                if line.startswith(name + ":"):
                    return int(line.split()[1]) * 1024
    except (FileNotFoundError, ProcessLookupError):
        pass
    return 0


class Watch:
    """Requests the time continuously and stores the longest wait, less the delay of this process."""

    def __init__(self, port):
        self.client, self.slowest, self.asked = Client(port, "WORLD", patience=60), 0.0, 0

    def time(self):
        """The time of the world in seconds."""
        return float(re.match(rb"OK TIME t=([0-9.]+)", self.client.ask("TIME"))[1])

    def ask(self, pause=0.02):
        begin = time.monotonic()
        time.sleep(pause)
        late = time.monotonic() - begin - pause
        begin = time.monotonic()
        answer = self.client.ask("TIME")
        if not answer.startswith(b"OK TIME t="):
            raise Wrong(f"TIME is answered {answer!r}")
        waited = max(0.0, time.monotonic() - begin - late)
        self.slowest = max(self.slowest, waited)
        self.asked += 1
        return waited
