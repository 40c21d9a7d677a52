#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A WebSocket client by the standard library alone, with the manners and the bad manners of any.

web_client.py URL: prints the scene and the first frame that simrun --web sends, a line each."""

import base64
import os
import socket
import struct
import sys
from urllib.parse import urlsplit


def dial(url, timeout=60):
    """A socket to the server of a URL, and its host as a browser names it."""
    parts = urlsplit(url)
    return socket.create_connection((parts.hostname, parts.port), timeout), parts.netloc


class WebClient:
    def __init__(self, url, origin=None, host=None, path="/ws"):
        self.socket, netloc = dial(url)
        self.rest = b""
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or netloc}", "Upgrade: websocket",
                 "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                 "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode()]
        if origin is not None:
            lines.append(f"Origin: {origin}")
        self.socket.sendall("\r\n".join(lines + ["", ""]).encode())
        while b"\r\n\r\n" not in self.rest:
            self.rest += self._some()
        head, self.rest = self.rest.split(b"\r\n\r\n", 1)
        self.status = int(head.split()[1])

    def _some(self):
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError("closed")
        return data

    def _take(self, count):
        while len(self.rest) < count:
            self.rest += self._some()
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def frame(self, data, opcode=1, length=None, fin=True):
        """Sends a frame; `length` overrides its stated length."""
        size = len(data) if length is None else length
        head = bytes([(0x80 if fin else 0) | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 1 << 16:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        mask = os.urandom(4)
        body = bytes(byte ^ mask[i % 4] for i, byte in enumerate(data))
        self.socket.sendall(head + mask + body)

    def send(self, text):
        self.frame(text.encode())

    def receive(self):
        """The next message, whole; ("close", code) at the end."""
        message = b""
        while True:
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", self._take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._take(8))[0]
            data = self._take(size)
            opcode = first & 15
            if opcode == 8:
                return ("close", struct.unpack(">H", data[:2])[0] if data else 1005)
            if opcode == 9:
                self.frame(data, 10)
                continue
            message += data
            if first & 0x80:
                return message.decode()

    def ask(self, request):
        self.send(request)
        return self.receive()


def main():
    client = WebClient(sys.argv[1])
    client.receive()
    print(client.ask("FRAME"))
    print(client.receive())


if __name__ == "__main__":
    main()
