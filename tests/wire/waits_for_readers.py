# SPDX-License-Identifier: GPL-3.0-or-later
"""A client of rosbridge that pauses gets each message of a run with --clock fast and --wait-for-readers; without it, the end of the
run says how many it lost."""
import base64
import json
import os
import re
import shutil
import socket
import struct
import time

from device_run import SOURCE, Run, check, scratch

SECONDS, SCANS = 20, 20 * 50


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
