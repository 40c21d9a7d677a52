# SPDX-License-Identifier: GPL-3.0-or-later
"""Clients of the ports of --foxglove and --rosbridge: honest readers that check each message of a laser's topic, and
attackers that subscribe to everything, read slowly or never, send half of a handshake or of a frame, or far too much."""
import json
import socket
import struct

import clients
import grammar

PROTOCOLS = {"foxglove": "foxglove.sdk.v1", "rosbridge": ""}
LARGEST = 1 << 18  # bytes of a message to the server


def handshake(port, protocol):
    offer = f"Sec-WebSocket-Protocol: {protocol}\r\n" if protocol else ""
    return (f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n{offer}\r\n").encode()


def frame(data, opcode=1, announced=None):
    """A frame of a client, which may announce more bytes than follow."""
    data = data.encode(errors="surrogateescape") if isinstance(data, str) else data
    n = len(data) if announced is None else announced
    size = struct.pack("!B", 128 | n) if n < 126 else struct.pack("!BH", 254, n) if n < 65536 else struct.pack("!BQ", 255, n)
    return bytes([128 | opcode]) + size + bytes(4) + data


class Frames:
    """Cuts the bytes of a server into messages; raises clients.Wrong for bytes that are no WebSocket."""

    def __init__(self):
        self.buffer, self.message, self.kind, self.greeted = b"", b"", 0, False

    def add(self, data):
        """The messages that are complete, as pairs (is text, bytes)."""
        self.buffer += data
        found = []
        if not self.greeted:
            head, end, rest = self.buffer.partition(b"\r\n\r\n")
            if not end:
                return found
            if not head.startswith(b"HTTP/1.1 101 "):
                raise ConnectionError(f"refused: {head[:60]!r}")
            self.greeted, self.buffer = True, rest
        while (one := self.cut()) is not None:
            opcode, is_last, body = one
            if opcode == 8:
                raise ConnectionError("closed")
            if opcode in (9, 10):
                continue
            if (opcode == 0) == (self.kind == 0) or opcode > 2:
                raise clients.Wrong(f"a frame of opcode {opcode} within one of {self.kind}")
            self.kind, self.message = self.kind or opcode, self.message + body
            if is_last:
                found.append((self.kind == 1, self.message))
                self.kind, self.message = 0, b""
        return found

    def cut(self):
        b = self.buffer
        if len(b) < 2:
            return None
        if b[0] & 0x70 or b[1] & 0x80:
            raise clients.Wrong(f"a frame that begins with {b[:2]!r}")
        size, at = b[1], 2
        if size > 125:
            at = 4 if size == 126 else 10
            if len(b) < at:
                return None
            size = int.from_bytes(b[2:at], "big")
        if len(b) < at + size:
            return None
        self.buffer = b[at + size:]
        return b[0] & 15, bool(b[0] & 128), b[at:at + size]


class TopicReader:
    """Reads /honest_laser/scan to the end of the run: each message is whole, and none is older than the one before."""

    def __init__(self, kind, port, beams):
        self.kind, self.beams, self.seen, self.last, self.size = kind, beams, 0, -1, 0
        self.socket, self.frames = socket.create_connection(("127.0.0.1", port), None), Frames()
        self.socket.sendall(handshake(port, PROTOCOLS[kind]))
        if kind == "rosbridge":
            self.read()
            self.send({"op": "subscribe", "id": "s", "topic": "/honest_laser/scan", "queue_length": 1})

    def send(self, request):
        self.socket.sendall(frame(json.dumps(request)))

    def read(self):
        """Reads what has come; raises ConnectionError at the end of the run, Wrong if it is invalid."""
        data = self.socket.recv(1 << 18)
        if not data:
            raise ConnectionError("closed")
        for is_text, message in self.frames.add(data):
            getattr(self, self.kind)(is_text, message)

    def check(self, moment, is_whole, what):
        if moment < self.last or not is_whole:
            raise clients.Wrong(f"{what} at {moment} after {self.last}")
        self.last = moment
        self.seen += 1

    def foxglove(self, is_text, message):
        if is_text:
            told = json.loads(message)
            for channel in told.get("channels", ()) if told["op"] == "advertise" else ():
                if channel["topic"] == "/honest_laser/scan":
                    self.send({"op": "subscribe", "subscriptions": [{"id": 7, "channelId": channel["id"]}]})
        elif message[0] == 1:
            key, moment = struct.unpack_from("<IQ", message, 1)
            seconds, rest = struct.unpack_from("<iI", message, 17)
            self.size = self.size or len(message)
            self.check(moment, key == 7 and seconds * 10 ** 9 + rest <= moment and len(message) == self.size,
                       f"a scan of {len(message)} bytes, {self.size} before, of {seconds}.{rest:09} for {key}")
        elif message[0] not in (2, 3, 4):
            raise clients.Wrong(f"a message of opcode {message[0]}")

    def rosbridge(self, is_text, message):
        told = json.loads(message)
        if not is_text or told["op"] not in ("publish", "status"):
            raise clients.Wrong(f"not a message of the topic: {message[:200]!r}")
        if told["op"] == "publish":
            stamp, ranges = told["msg"]["header"]["stamp"], told["msg"]["ranges"]
            self.check(stamp["sec"] * 10 ** 9 + stamp["nanosec"], len(ranges) == self.beams,
                       f"a scan of {len(ranges)} ranges")


# Topics of the hall of part_server, and of sensors and robots that other attackers add.
TOPICS = ("/clock", "/tf", "/tf_static", "/map", "/room", "/people", "/diagnostics", "/honest/odom", "/honest/sonar_0",
          "/honest_laser/scan", "/eye_laser/scan", "/eye/image_raw/compressed", "/eye/camera_info", "/xr1/odom", "/xl1/scan",
          "/xc1/image_raw/compressed", "/xk1/depth/image_rect", "/none", "", "/" + "t" * 3000)
INPUTS = ("/cmd_vel", "/honest/cmd_vel", "/xr1/cmd_vel", "/xr2/cmd_vel", "/xr1/initialpose", "/initialpose", "/xr1/goal_pose",
          "/goal_pose", "/clock", "x")
TYPES = ("geometry_msgs/Twist", "geometry_msgs/msg/TwistStamped", "geometry_msgs/PoseWithCovarianceStamped",
         "geometry_msgs/PoseStamped", "std_msgs/Bool", "")


def speed(r):
    return r.choice((0, 0.3, -0.5, 1e308, -1e-320, 2 ** 64, None, "1", []))


def twist(r):
    return {"linear": {"x": speed(r), "y": speed(r)}, "angular": {"z": speed(r)}}


def malformed(r):
    return r.choice((lambda: "", lambda: "[" * r.randint(1, 100_000), lambda: "{\"op\":" * r.randint(1, 30_000),
                     lambda: "\"" + "\\u0000" * r.randint(1, 40_000) + "\"", lambda: "{}", lambda: "null", lambda: "\x00",
                     lambda: json.dumps({"op": "x" * r.randint(0, 200_000)}), lambda: "[" + "9" * r.randint(1, 200_000) + "]",
                     lambda: json.dumps({"op": r.choice((5, None, [], {}))})))()


def foxglove_request(r):
    def numbers(most):
        return [r.randint(0, 400) for _ in range(r.choice((1, 3, most)))]

    def number(*values):
        return struct.pack("<" + "I" * len(values), *values)
    return r.choice((
        lambda: {"op": "subscribe", "subscriptions": [{"id": r.randint(0, 9000), "channelId": n} for n in numbers(5000)]},
        lambda: {"op": "subscribe", "subscriptions": [{"id": n, "channelId": n} for n in range(200)]},
        lambda: {"op": "unsubscribe", "subscriptionIds": numbers(20_000)},
        lambda: {"op": "advertise", "channels": [{"id": n, "topic": r.choice(INPUTS), "encoding": r.choice(("json", "cdr", "")),
                                                   "schemaName": r.choice(TYPES)} for n in numbers(1500)]},
        lambda: {"op": "unadvertise", "channelIds": numbers(20_000)},
        lambda: {"op": "getParameters", "id": "p", "parameterNames": ["p" * 30] * r.choice((0, 1, 5000))},
        lambda: {"op": "setParameters", "id": "p", "parameters": [
            {"name": f"{grammar.name(r)}.{r.choice(('at', 'heading', 'x'))}", "value": r.choice(([1, 2], 30, "x", None, [1e308]))}
            for _ in range(r.choice((1, 40, 2000)))]},
        lambda: {"op": "subscribeParameterUpdates", "parameterNames": [f"{n}.at" for n in numbers(10_000)] + ["eye.at"]},
        lambda: {"op": "fetchAsset", "requestId": 1, "uri": r.choice(("package://ispace/room.glb", "file:///etc/passwd", "x" * 9999))},
        lambda: b"\1" + number(r.randint(0, 400)) + r.choice((json.dumps(twist(r)).encode(), r.randbytes(r.randint(0, 200)))),
        lambda: b"\2" + number(r.randint(0, 4), r.randint(0, 9), 4) + b"json{}",
        lambda: r.randbytes(r.randint(0, 2000))))()


def rosbridge_request(r):
    topic = r.choice(TOPICS)
    return r.choice((
        lambda: {"op": "subscribe", "id": f"i{r.randint(0, 99)}", "topic": topic, "throttle_rate": r.choice((0, 0, 100, -5, 1e99)),
                 "queue_length": r.choice((0, 1, 1000, -1, 1e99)), "compression": r.choice(("none", "cbor", "cbor-raw", "png", ""))},
        lambda: {"op": "subscribe", "id": "i", "topic": f"/t{r.randint(0, 3000)}"},
        lambda: {"op": "unsubscribe", "topic": topic},
        lambda: {"op": "advertise", "topic": r.choice(INPUTS), "type": r.choice(TYPES)},
        lambda: {"op": "advertise", "topic": f"/t{r.randint(0, 3000)}", "type": r.choice(TYPES)},
        lambda: {"op": "unadvertise", "topic": r.choice(INPUTS)},
        lambda: {"op": "publish", "topic": r.choice(INPUTS), "msg": r.choice((twist(r), {"twist": twist(r)}, None, []))},
        lambda: {"op": "call_service", "id": "c", "service": r.choice((
            "/rosapi/topics", "/rosapi/topics_and_raw_types", "/rosapi/nodes", "rosapi/get_param_names", "/rosapi/get_time", "/reset",
            "/resume", "/pause", "/none")), "args": r.choice(({}, [], None, {"topic": topic}))},
        lambda: {"op": r.choice(("fragment", "png", "set_level", "auth", "status")), "data": "x" * r.randint(0, 9000)}))()


REQUESTS = {"foxglove": foxglove_request, "rosbridge": rosbridge_request}
STYLES = ("polite", "polite", "polite", "flood", "flood", "deaf", "deaf", "slow", "half", "late", "big", "silent", "vanish", "noise")


class TopicAttacker:
    """One connection, opened again when it ends."""

    def __init__(self, r, kind, port):
        self.r, self.kind, self.port, self.socket, self.role = r, kind, port, None, kind

    def connect(self):
        self.style, self.frames = self.r.choice(STYLES), Frames()
        self.socket = socket.socket()
        if self.style in ("deaf", "slow"):
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        self.socket.settimeout(5)
        self.socket.connect(("127.0.0.1", self.port))
        greeting = handshake(self.port, PROTOCOLS[self.kind])
        if self.style == "late":
            self.left = greeting
        elif self.style != "noise":
            self.socket.sendall(greeting)
            # A frame before the answer is an error, and would end the connection.
            self.frames.add(self.socket.recv(2048))
        self.socket.setblocking(False)

    def act(self):
        """Sends a request, reads available messages; returns the number of requests sent."""
        if self.socket is None:
            self.connect()
            return 1
        sent = getattr(self, self.style)()
        if self.r.random() < 0.004:
            self.close()
        return sent

    def one(self):
        """A request as a frame."""
        request = malformed(self.r) if self.r.random() < 0.1 else REQUESTS[self.kind](self.r)
        if isinstance(request, dict):
            request = json.dumps(request)
        return frame(request[:LARGEST - 16], opcode=1 if isinstance(request, str) else 2)

    def send(self, data):
        """A frame that does not fit the buffer of the system is torn, which ends the connection."""
        try:
            if self.socket.send(data) < len(data):
                raise ConnectionError
        except BlockingIOError:
            return 0
        return 1

    def polite(self):
        """Checks that each message is one of the protocol."""
        self.read()
        return self.send(self.one())

    def read(self):
        try:
            data = self.socket.recv(1 << 18)
        except BlockingIOError:
            return
        if not data:
            raise ConnectionError
        for is_text, message in self.frames.add(data):
            if is_text:
                op = json.loads(message).get("op")
                if not isinstance(op, str):
                    raise clients.Wrong(f"a message without op: {message[:200]!r}")
            elif self.kind == "foxglove" and (not message or message[0] not in (1, 2, 3, 4)):
                raise clients.Wrong(f"a message of opcode {message[:1]!r}")

    def flood(self):
        sent = self.send(b"".join(self.one() for _ in range(8)))
        self.drop(1 << 18)
        return 8 * sent

    def deaf(self):
        return self.send(self.one())

    def slow(self):
        self.drop(self.r.choice((1, 64, 2048)))
        return self.send(self.one()) if self.r.random() < 0.2 else 0

    def half(self):
        """A frame that announces more than comes, and grows by a byte at a time."""
        if self.r.random() < 0.05:
            self.send(frame("{", announced=self.r.choice((2000, LARGEST - 1, LARGEST + 1, 1 << 62))))
        else:
            self.send(b"x")
        return 0

    def late(self):
        """A handshake a byte at a time."""
        self.send(self.left[:1] or b"\x89\x80\0\0\0\0")
        self.left = self.left[1:]
        return 0

    def big(self):
        size = self.r.choice((LARGEST - 1, LARGEST, LARGEST + 1, 1 << 20))
        self.send(frame(b"{" + b" " * (size - 2) + b"}", opcode=self.r.choice((1, 2))))
        self.drop(1 << 18)
        return 1

    def silent(self):
        return 0

    def vanish(self):
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        sent = self.send(self.one())
        self.close()
        return sent

    def noise(self):
        self.send(self.r.randbytes(self.r.randint(1, 3000)) + b"\r\n\r\n")
        self.drop(1 << 18)
        return 1

    def drop(self, most):
        try:
            if not self.socket.recv(most):
                raise ConnectionError
        except BlockingIOError:
            pass

    def close(self):
        if self.socket is not None:
            self.socket.close()
        self.socket = None


def hoard(kind, port):
    """A client with thousands of subscriptions that never reads; returns its socket."""
    one = socket.socket()
    one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
    one.settimeout(5)
    one.connect(("127.0.0.1", port))
    one.sendall(handshake(port, PROTOCOLS[kind]))
    frames, channels = Frames(), []
    while not (frames.greeted and (channels or kind == "rosbridge")):
        for is_text, message in frames.add(one.recv(1 << 16)):
            channels += [channel["id"] for channel in (json.loads(message) if is_text else {}).get("channels", ())]
    for first in range(0, 4000, 1000):
        numbers = range(first, first + 1000)
        if kind == "foxglove":
            one.sendall(frame(json.dumps({"op": "subscribe", "subscriptions": [
                {"id": n, "channelId": channels[n % len(channels)]} for n in numbers]})))
        else:
            one.sendall(b"".join(frame(json.dumps({"op": "subscribe", "id": f"i{n}", "topic": TOPICS[n % 12],
                                                   "queue_length": 1000})) for n in numbers))
    return one


def connects(kind, port, patience=5):
    """Returns whether the server accepts a WebSocket and answers it."""
    with socket.create_connection(("127.0.0.1", port), patience) as one:
        one.sendall(handshake(port, PROTOCOLS[kind]))
        frames, asked = Frames(), False
        while data := one.recv(1 << 16):
            if frames.add(data):
                return True
            if frames.greeted and not asked:
                asked = True
                one.sendall(frame(json.dumps({"op": "call_service", "service": "/rosapi/get_time"})))
    return False
