# SPDX-License-Identifier: GPL-3.0-or-later
"""A process of clients that send requests of grammar.py: some read each reply and check that it is that of the
request, some never read, send half lines, a byte at a time, or vanish."""
import os
import random
import socket
import struct
import time

import clients
import grammar
import topics

STYLES = ("polite", "polite", "polite", "polite", "flood", "deaf", "half", "slow", "vanish", "noise", "web")
MOST_AHEAD = 8  # requests of a polite client that wait for a reply


class Attacker:
    """One connection, opened again when it ends."""

    def __init__(self, r, port, web):
        self.r, self.port, self.page = r, port, web
        self.socket = None

    def connect(self):
        self.style, self.role, self.asked, self.buffer, self.skip = self.r.choice(STYLES), "", [], b"", 0
        self.socket = socket.socket()
        if self.style in ("deaf", "flood"):
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        self.socket.settimeout(5)
        self.socket.connect(("127.0.0.1", self.page if self.style == "web" else self.port))
        if self.style == "web":
            self.socket.sendall(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{self.page}\r\nUpgrade: websocket\r\nConnection: Upgrade"
                                "\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        elif self.style != "noise":
            self.role = grammar.role(self.r)
            self.send(self.role)
        self.socket.setblocking(False)

    def send(self, line, end=b"\n"):
        data = line.encode(errors="surrogateescape") + end
        if self.style == "polite":
            self.asked.append(line)
        try:
            done = self.socket.send(data)
        except BlockingIOError:
            done = 0
        if done < len(data) and self.style == "polite":
            raise ConnectionError  # the rest would be half a line

    def frame(self, data):
        size = struct.pack("!B", 128 | len(data)) if len(data) < 126 else struct.pack("!BH", 254, len(data))
        return bytes([128 | self.r.choice((1, 1, 1, 2, 9, 10, 8, 0, 3))]) + size + bytes(4) + data

    def act(self):
        """Sends a request, reads available replies; returns the number of requests sent."""
        if self.socket is None:
            self.connect()
            return 1
        sent = getattr(self, self.style)()
        if self.r.random() < 0.003:
            self.close()
        return sent

    def polite(self):
        self.read()
        if len(self.asked) >= MOST_AHEAD:
            return 0
        line = grammar.request(self.r, self.role)
        # A blank line is no request, and one that QUITs has the last reply.
        if line.strip() and not line.startswith("QUIT") and "\x00" not in line:
            self.send(line)
            return 1
        return 0

    def read(self):
        try:
            data = self.socket.recv(1 << 18)
        except BlockingIOError:
            return
        if not data:
            raise ConnectionError
        self.buffer += data
        while True:
            if self.skip:
                cut = min(self.skip, len(self.buffer))
                self.skip, self.buffer = self.skip - cut, self.buffer[cut:]
            line, newline, rest = self.buffer.partition(b"\n")
            if not newline or self.skip:
                return
            self.buffer = rest
            self.take(line)

    def take(self, line):
        if line.startswith((b"ISPACE 1", b"DONE ", b"FAIL ", b"EVENT ")):
            return
        size = line.rpartition(b" bytes=")[2] if line.startswith(b"SCAN ") and b" bytes=" in line else b"0"
        self.skip = int(size)
        if line.startswith(b"SCAN ") and b" stream=1" in line:
            return
        if line.startswith((b"ERR 429", b"ERR 413", b"ERR 408")):
            # The reply to a request, or the last line of a connection.
            self.asked = self.asked[1:]
            return
        if not self.asked:
            raise clients.Wrong(f"a reply that nobody asked for: {line[:200]!r}")
        asked = self.asked.pop(0)
        verb = asked.split(" ")[0].encode()
        if not line.startswith((b"OK " + verb, b"ERR ", b"SCAN ")) or (line.startswith(b"SCAN ") and verb != b"SCAN"):
            raise clients.Wrong(f"{asked[:100]!r} is answered {line[:200]!r}")

    def flood(self):
        lines = "\n".join(grammar.request(self.r, self.role) for _ in range(50))
        self.send(lines)
        self.drop()
        return 50

    def deaf(self):
        self.send(self.r.choice(("SCAN", "STREAM", "HELP", "POSES", "EVENTS", "LIST", "BINARY on")))
        return 1

    def half(self):
        line = grammar.request(self.r, self.role)
        self.send(line[:self.r.randint(0, len(line))], end=b"")
        self.drop()
        return 0

    def slow(self):
        self.send(self.r.choice("WORLDSTEP 1=;,\t"), end=b"")
        self.drop()
        return 0

    def vanish(self):
        self.send(grammar.request(self.r, self.role))
        if self.r.random() < 0.2:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            self.close()
        return 1

    def noise(self):
        self.socket.send(self.r.randbytes(self.r.randint(1, 3000)) + b"\n")
        self.drop()
        return 1

    def web_request(self):
        kind = self.r.random()
        if kind < 0.1:
            return self.r.randbytes(self.r.randint(1, 300))
        if kind < 0.3:
            return self.frame(b"FRAME")
        return self.frame(grammar.request(self.r, "WORLD").encode(errors="replace")[:4000])

    def web(self):
        self.socket.send(self.web_request())
        self.drop()
        return 1

    def drop(self):
        try:
            if not self.socket.recv(1 << 18):
                raise ConnectionError
        except BlockingIOError:
            pass

    def close(self):
        if self.socket is not None:
            self.socket.close()
        self.socket = None


def attack(ports, seed, count, report):
    """Runs until killed; writes a line to `report` for each violation, and the number of requests sent. A third of the
    attackers are clients of topics."""
    r = random.Random(seed)
    kinds = [r.choice(("foxglove", "rosbridge")) if i % 3 == 2 else "" for i in range(count)]
    attackers = [topics.TopicAttacker(r, kind, ports[kind]) if kind else Attacker(r, ports["listen"], ports["web"])
                 for kind in kinds]
    sent, told = 0, time.monotonic()
    while os.getppid() != 1:
        attacker = r.choice(attackers)
        try:
            sent += attacker.act()
        except clients.Wrong as wrong:
            report.write(f"wrong {attacker.role}: {wrong}\n")
            attacker.close()
        except (OSError, ConnectionError):
            attacker.close()
            time.sleep(0.001)
        if time.monotonic() > told + 0.2:
            told = time.monotonic()
            report.write(f"sent {sent}\n")
            report.flush()
