# SPDX-License-Identifier: GPL-3.0-or-later
"""A client of Pioneer robots, written from the published packets; it shares no code with the programs it talks to.
Numbers are in millimetres and degrees."""
import socket
import struct

from device_run import check

PULSE, OPEN, CLOSE, ENABLE, MOVE, VEL, HEAD, CONFIG, RVEL = 0, 1, 2, 4, 8, 11, 12, 18, 21
SIM_STAT = 237
STATUS, CONFIGURED, SIMULATION, SCAN, LONG_SCAN = 0x32, 0x20, 0x62, 0x60, 0x61


def checksum(body):
    total = 0
    for i in range(0, len(body) - 1, 2):
        total = (total + (body[i] << 8 | body[i + 1])) & 0xFFFF
    return total ^ body[-1] if len(body) % 2 else total


def packet(number, data=b""):
    body = bytes([number]) + data
    return b"\xfa\xfb" + bytes([len(body) + 2]) + body + checksum(body).to_bytes(2, "big")


def command(number, value):
    kind = 0x3B if value >= 0 else 0x1B
    return packet(number, bytes([kind]) + abs(value).to_bytes(2, "little"))


class Status:
    """A standard status packet of a p3dx-sh."""

    def __init__(self, data):
        (self.x, self.y, heading, self.left, self.right, self.battery, self.stall, _, self.flags, _,
         count) = struct.unpack_from("<HHhhhBHhHBB", data)
        self.heading = heading * 360 / 4096
        self.sonars = dict(struct.unpack_from("<BH", data, 19 + 3 * k) for k in range(count))
        tail = struct.unpack_from("<BBBBBHBhHhbb", data, 19 + 3 * count)
        self.rotspeed = tail[7] / 10
        check(19 + 3 * count + struct.calcsize("<BBBBBHBhHhbb") == len(data), "a status of another size")
        self.is_stalled = self.stall & 0x0101 == 0x0101


class Pioneer:
    """A robot at (address, port). Whatever is torn or lost on the way ends the script."""

    def __init__(self, where):
        self.socket = socket.create_connection(where, timeout=30)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.bytes = b""
        self.status, self.scan, self.parts = None, None, []
        self.statuses = self.scans = 0
        self.names = []
        for number in range(3):
            self.socket.sendall(packet(number))
            answer, data = self.read()
            check(answer == number, f"SYNC{number} is answered by packet {answer}")
            self.names = data.split(b"\0")[:-1]

    def send(self, number, value):
        self.socket.sendall(command(number, value))

    def read(self):
        """The next packet: its number and its data."""
        while len(self.bytes) < 3 or len(self.bytes) < 3 + self.bytes[2]:
            more = self.socket.recv(65536)
            if not more:
                raise EOFError
            self.bytes += more
        check(self.bytes[:2] == b"\xfa\xfb", "bytes that are no packet")
        end = 3 + self.bytes[2]
        body, total = self.bytes[3:end - 2], self.bytes[end - 2:end]
        check(int.from_bytes(total, "big") == checksum(body), "a wrong checksum")
        self.bytes = self.bytes[end:]
        self.note(body[0], body[1:])
        return body[0], body[1:]

    def note(self, number, data):
        if number == STATUS:
            self.status = Status(data)
            self.statuses += 1
        elif number in (SCAN, LONG_SCAN):
            head, size = (6, 2) if number == SCAN else (0, 5)
            total, first, here = struct.unpack_from("<HHB", data, head)
            check(first == len(self.parts), f"a scan goes on at {first} behind {len(self.parts)}")
            self.parts += [struct.unpack_from("<H", data, head + 5 + size * k)[0] for k in range(here)]
            if len(self.parts) == total:
                self.scan, self.parts = self.parts, []
                self.scans += 1

    def wait(self, number):
        """The data of the next packet with this number."""
        while True:
            found, data = self.read()
            if found == number:
                return data

    def until(self, is_true, most=600):
        """Reads statuses, a tenth of a simulated second apart, until one meets the condition; sends a packet now and
        then to stay connected."""
        for k in range(most):
            self.wait(STATUS)
            if is_true(self.status):
                return self.status
            if k % 10 == 9:
                self.socket.sendall(packet(PULSE))
        raise SystemExit("FAILED: waited for " + str(most) + " statuses in vain")

    def rests(self):
        """Waits until it has gone and stands again."""
        self.until(lambda s: s.left or s.right)
        return self.until(lambda s: not s.left and not s.right)
