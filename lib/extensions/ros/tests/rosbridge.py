# SPDX-License-Identifier: GPL-3.0-or-later
"""For the scripts beside it: a client of rosbridge with the standard library alone."""
import base64
import json
import os
import socket
import struct

from device_run import check


class Rosbridge:
    """A WebSocket with a small buffer."""

    def __init__(self, address):
        host, port = address.removeprefix("ws://").rsplit(":", 1)
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.socket.settimeout(60)
        self.socket.connect((host, int(port)))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET / HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self.socket.recv(1)
        check(b" 101 " in head, f"no WebSocket: {head}")

    def say(self, message):
        text = json.dumps(message).encode()
        check(len(text) < 126, "the request is long")
        self.socket.sendall(bytes([0x81, 0x80 | len(text)]) + bytes(4) + text)

    def _bytes(self, count):
        out = b""
        while len(out) < count:
            piece = self.socket.recv(count - len(out))
            if not piece:
                return None
            out += piece
        return out

    def message(self):
        """The next message, of its fragments; None at the end."""
        whole = b""
        while True:
            head = self._bytes(2)
            if head is None or head[0] & 15 == 8:
                return None
            size = head[1] & 127
            if size > 125:
                size = struct.unpack(">H" if size == 126 else ">Q", self._bytes(2 if size == 126 else 8))[0]
            whole += self._bytes(size)
            if head[0] & 128:
                return json.loads(whole)
