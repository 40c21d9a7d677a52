#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""latency.py [BUILD] [--samples N] [--csv FILE]: how long messages of simrun take to its clients on this machine.

A room with a laser of 181 beams and a lamp. By path, three times in milliseconds, as median and 99th percentile:

step     from the request STEP of one client to the message of that step at another: a scan, over MQTT the level of the
         lamp, on the page a frame
answer   from a request to its answer
switch   from a command to the lamp, in real time with steps of 5 ms, to its new state at the same client

The clients are this script with the standard library alone, but for DDS, where it reads the lines of a program over
Fast DDS. The first row is an echo over loopback between two processes of Python: what the clients take themselves.
"""
import argparse
import base64
import contextlib
import csv
import itertools
import json
import os
import pathlib
import random
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import time

ROOM = """#env 1
fence id=f path=0,0;6,0;6,4;0,4 closed=yes height=2.5
lamp id=l1 at=3,2
"""
LAYOUT = """#3dm 1
robot id=r1 model=pioneer-2dx at=2,2
laser id=s1 on=r1 at=0.1,0,0.3 fov=180 step=1 range=8 rate=20
"""
STEP = 0.05  # seconds
DOMAIN = 90  # of DDS
WARM = 20  # messages that are not counted
PATIENCE = 30
SCAN_TYPE, EMPTY = "sensor_msgs::msg::dds_::LaserScan_", "std_srvs::srv::dds_::Empty_"


FLIPS = []  # of each run, states of the lamp: it is off at first, and each command changes it


class Missing(Exception):
    """A path that cannot be measured here."""


class Stream:
    """A TCP connection with a buffer."""

    def __init__(self, address):
        self.socket = socket.create_connection(address, timeout=PATIENCE)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.buffer = b""

    def send(self, data):
        self.socket.sendall(data)

    def _more(self):
        piece = self.socket.recv(1 << 16)
        if not piece:
            raise EOFError("the connection has ended")
        self.buffer += piece

    def take(self, count):
        while len(self.buffer) < count:
            self._more()
        out, self.buffer = self.buffer[:count], self.buffer[count:]
        return out

    def until(self, end):
        while (at := self.buffer.find(end)) < 0:
            self._more()
        return self.take(at + len(end))


class Lines(Stream):
    """A client of the Simulator TCP Protocol."""

    def __init__(self, address, *requests):
        super().__init__(address)
        self.until(b"\n")
        for request in requests:
            self.ask(request)

    def ask(self, request):
        self.send(request.encode() + b"\n")
        answer = self.until(b"\n").decode()
        if answer.startswith("ERR"):
            raise Missing(f"{request}: {answer.strip()}")
        return answer

    def line(self, start):
        while not (line := self.until(b"\n")).startswith(start):
            pass
        return line


class WebSocket(Stream):
    """The client's side of a WebSocket."""

    def __init__(self, url, protocol=None):
        host, _, path = url.removeprefix("ws://").partition("/")
        name, port = host.rsplit(":", 1)
        super().__init__((name, int(port)))
        key = base64.b64encode(os.urandom(16)).decode()
        wanted = f"Sec-WebSocket-Protocol: {protocol}\r\n" if protocol else ""
        self.send(f"GET /{path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n{wanted}"
                  f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        head = self.until(b"\r\n\r\n")
        if b" 101 " not in head:
            raise Missing(f"{url}: {head.splitlines()[0].decode()}")

    def say(self, content):
        """A text, JSON of a dictionary, or bytes."""
        code = 2 if isinstance(content, bytes) else 1
        if isinstance(content, dict):
            content = json.dumps(content)
        data = content if isinstance(content, bytes) else content.encode()
        size = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0x80 | 126]) + struct.pack(">H", len(data))
        self.send(bytes([0x80 | code]) + size + bytes(4) + data)

    def message(self):
        whole = b""
        while True:
            first, size = self.take(2)
            size &= 127
            if size > 125:
                size = struct.unpack(">H" if size == 126 else ">Q", self.take(2 if size == 126 else 8))[0]
            whole += self.take(size)
            if first & 15 == 8:
                raise EOFError("the WebSocket has ended")
            if first & 128:
                return whole

    def wait(self, accepted):
        while not accepted(message := self.message()):
            pass
        return message


class Mqtt(Stream):
    """A client of MQTT 3.1.1 with quality of service 0."""

    def __init__(self, port, topic):
        super().__init__(("127.0.0.1", port))
        self._packet(0x10, self._text("MQTT") + bytes([4, 2, 0, 60]) + self._text(f"latency-{os.urandom(4).hex()}"))
        self._read()
        self._packet(0x82, b"\0\1" + self._text(topic) + b"\0")

    @staticmethod
    def _text(text):
        return struct.pack(">H", len(text)) + text.encode()

    def _packet(self, head, body):
        size, rest = b"", len(body)
        while rest > 127:
            size, rest = size + bytes([rest & 127 | 128]), rest >> 7
        self.send(bytes([head]) + size + bytes([rest]) + body)

    def _read(self):
        head, size, shift = self.take(1)[0], 0, 0
        while True:
            byte = self.take(1)[0]
            size, shift = size | (byte & 127) << shift, shift + 7
            if byte < 128:
                return head, self.take(size)

    def skip(self):
        """Skips messages until none comes for half a second."""
        self.socket.settimeout(0.5)
        with contextlib.suppress(TimeoutError):
            while True:
                self._read()
        self.socket.settimeout(PATIENCE)

    def publish(self, topic, payload):
        self._packet(0x30, self._text(topic) + payload.encode())

    def wait(self, topic, payload=None):
        """A message of the topic that is not retained from before, and of the payload if that is given."""
        while True:
            head, body = self._read()
            if head & 0xf0 != 0x30 or head & 1:
                continue
            length = struct.unpack(">H", body[:2])[0]
            if body[2:2 + length].decode() == topic and payload in (None, body[2 + length:].decode()):
                return


class FastDds:
    """Topics over Fast DDS, by the program of lib/extensions/ros/tests."""

    def __init__(self, program, *topics):
        self.process = subprocess.Popen([program, str(DOMAIN), *topics], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True)

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def wait(self):
        line = self.process.stdout.readline()
        if not line:
            raise Missing("the program over Fast DDS has ended")
        return json.loads(line)

    def close(self):
        self.process.stdin.close()
        self.process.wait(PATIENCE)


class Run:
    """A running simrun and its addresses."""

    def __init__(self, build, *options):
        self.process = subprocess.Popen([build / "bin" / "simrun", "room.env", "layout.3dm", "-q", *options],
                                        stdout=subprocess.PIPE, text=True)
        self.first = json.loads(self.process.stdout.readline())
        host, port = self.first["listen"].rsplit(":", 1)
        self.listen = (host, int(port))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(PATIENCE)


def broker(stack, *lines):
    """The port of a broker with these lines of configuration; None without one."""
    program = shutil.which("mosquitto", path=os.environ["PATH"] + ":/usr/sbin")
    if not program:
        return None
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    whole = (f"listener {port} 127.0.0.1", "allow_anonymous true", *lines, "")
    pathlib.Path("broker.conf").write_text("\n".join(whole), encoding="ascii")
    process = subprocess.Popen([program, "-c", "broker.conf"], stderr=subprocess.DEVNULL)
    stack.callback(process.wait)
    stack.callback(process.terminate)
    for _ in range(500):
        with contextlib.suppress(OSError):
            socket.create_connection(("127.0.0.1", port)).close()
            return port
        time.sleep(0.01)
    return None


def pause():
    """Keeps the client out of step with the server."""
    time.sleep(random.uniform(0.001, 0.004))


def measure(samples, begin, end):
    """Milliseconds from begin(i) to the end of end(i), sorted."""
    times = []
    for i in range(WARM + samples):
        pause()
        start = time.perf_counter()
        begin(i)
        end(i)
        times.append(1000 * (time.perf_counter() - start))
    return sorted(times[WARM:])


def steps(samples, run, wait, act=False):
    """From STEP to the message of that step. wait(i) reads the next message and returns its time, or None if it is that
    of this step; act: each step changes the level of the lamp."""
    world = Lines(run.listen, "WORLD")
    now, times = float(re.search(r"t=(\S+)", world.ask("TIME"))[1]), []
    for i in range(WARM + samples):
        pause()
        start = time.perf_counter()
        world.send((f"ACT l1 level={(20 + i % 60) / 100}\n" if act else "").encode() + b"STEP\n")
        while (told := wait(i)) is not None and told < now + STEP - 1e-4:
            pass  # the newest one before, at the start of a subscription
        times.append(1000 * (time.perf_counter() - start))
        now = float(re.search(rb"t=(\S+)", world.line(b"OK STEP"))[1])
    return sorted(times[WARM:])


def stamp(header):
    return header["stamp"]["sec"] + header["stamp"]["nanosec"] / 1e9


def echo(samples):
    """Loopback and Python alone."""
    code = ("import socket\ns = socket.create_server(('127.0.0.1', 0))\n"
            "print(s.getsockname()[1], flush=True)\nc = s.accept()[0]\n"
            "c.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)\nwhile d := c.recv(4096): c.sendall(d)")
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        stream = Stream(("127.0.0.1", int(process.stdout.readline())))
        times = measure(samples, lambda _: stream.send(b"TIME\n"), lambda _: stream.until(b"\n"))
        stream.socket.close()
    return times


def tcp_steps(binary):
    def scans(samples, run, **_):
        reader = Lines(run.listen, "LASER s1", f"BINARY {'on' if binary else 'off'}", "STREAM")

        def wait(_):
            line = reader.line(b"SCAN")
            if binary:
                reader.take(int(line.rsplit(b"bytes=", 1)[1].split()[0]))
            return float(re.search(rb"t=(\S+)", line)[1])
        return steps(samples, run, wait)
    return scans


def rosbridge_steps(samples, run, **_):
    client = WebSocket(run.first["rosbridge"])
    client.say({"op": "subscribe", "topic": "/s1/scan", "type": "sensor_msgs/LaserScan"})
    time.sleep(0.2)
    return steps(samples, run, lambda _: stamp(json.loads(client.message())["msg"]["header"]))


def foxglove(run, *topics):
    """A client of Foxglove's protocol that reads these topics."""
    client = WebSocket(run.first["foxglove"], "foxglove.websocket.v1")
    channels = {}
    while not set(topics) <= set(channels):
        message = json.loads(client.wait(lambda one: one.startswith(b"{")))
        if message["op"] == "advertise":
            channels.update({one["topic"]: one["id"] for one in message["channels"]})
    client.say({"op": "subscribe", "subscriptions": [{"id": i, "channelId": channels[topic]}
                                                     for i, topic in enumerate(topics)]})
    time.sleep(0.2)
    return client


def foxglove_steps(samples, run, **_):
    client = foxglove(run, "/s1/scan")

    def wait(_):
        message = client.wait(lambda one: one[:1] == b"\1")
        return struct.unpack_from("<Q", message, 5)[0] / 1e9
    return steps(samples, run, wait)


def page_steps(samples, run, **_):
    page = WebSocket("ws" + run.first["web"].removeprefix("http").rstrip("/") + "/ws")
    newest = {"t": 0}

    def wait(_):
        """Asks for frames, as the page does, until one has another time."""
        while True:
            frame = json.loads(page.wait(lambda one: one.startswith(b"{")))
            page.say("FRAME")
            if frame.get("t", 0) != newest["t"]:
                newest["t"] = frame.get("t", 0)
                return newest["t"]
    page.say("FRAME")
    return steps(min(samples, 300), run, wait)


def mqtt_steps(samples, run, port, **_):
    client = Mqtt(port, "ispace/l1/level")
    client.skip()
    return steps(samples, run, lambda i: client.wait("ispace/l1/level", str(20 + i % 60)), act=True)


def dds_steps(samples, run, fastdds, **_):
    client = FastDds(fastdds, f"{SCAN_TYPE}:rt/s1/scan")
    time.sleep(3)  # they meet
    times = steps(samples, run, lambda _: client.wait()["t"] / 1e9)
    client.close()
    return times


def tcp_answers(samples, run, **_):
    client = Lines(run.listen, "WORLD")
    return measure(samples, lambda _: client.send(b"TIME\n"), lambda _: client.until(b"\n"))


def page_answers(samples, run, **_):
    page = WebSocket("ws" + run.first["web"].removeprefix("http").rstrip("/") + "/ws")
    page.say("WORLD")
    page.wait(lambda one: b"OK WORLD" in one)
    return measure(samples, lambda _: page.say("TIME"), lambda _: page.wait(lambda one: b"OK TIME" in one))


def rosbridge_answers(samples, run, **_):
    client = WebSocket(run.first["rosbridge"])
    return measure(samples, lambda i: client.say({"op": "call_service", "id": str(i), "service": "/rosapi/get_time"}),
                   lambda _: json.loads(client.message()))


def foxglove_answers(samples, run, **_):
    client = foxglove(run)
    return measure(samples, lambda i: client.say(
        {"op": "getParameters", "parameterNames": ["clock.paused"], "id": str(i)}),
                   lambda _: client.wait(lambda one: b"parameterValues" in one))


def mqtt_answers(samples, run, port, **_):
    client = Mqtt(port, "ispace/error")
    client.skip()
    return measure(samples, lambda _: client.publish("ispace/l1/level/set", "bright"),
                   lambda _: client.wait("ispace/error"))


def dds_answers(samples, run, fastdds, **_):
    client = FastDds(fastdds, f"{EMPTY}Response_:rr/pauseReply")
    time.sleep(3)
    content = "00010000" + bytes(range(16)).hex() + "00"

    def call(_):
        client.say(f"raw {EMPTY}Request_ rq/pauseRequest {content}")

    def wait(_):
        client.wait()
    call(0)
    wait(0)
    times = []
    for i in range(min(samples, 300)):  # 100 pauses a second at most
        time.sleep(random.uniform(0.015, 0.025))
        start = time.perf_counter()
        call(i)
        wait(i)
        times.append(1000 * (time.perf_counter() - start))
    client.close()
    return sorted(times)


def tcp_switches(samples, run, **_):
    client = Lines(run.listen, "WORLD", "EVENTS state")
    return measure(samples, lambda _: client.send(f"ACT l1 on={next(FLIPS[-1]) % 2}\n".encode()),
                   lambda _: client.line(b"EVENT state"))


def page_switches(samples, run, **_):
    page = WebSocket("ws" + run.first["web"].removeprefix("http").rstrip("/") + "/ws")
    for request in ("WORLD", "EVENTS state"):
        page.say(request)
        page.wait(lambda one: b"OK " in one)
    return measure(samples, lambda _: page.say(f"ACT l1 on={next(FLIPS[-1]) % 2}"),
                   lambda _: page.wait(lambda one: b"EVENT state" in one))


def rosbridge_switches(samples, run, **_):
    client = WebSocket(run.first["rosbridge"])
    client.say({"op": "advertise", "topic": "/l1/on/set", "type": "std_msgs/Bool"})
    client.say({"op": "subscribe", "topic": "/l1/on", "type": "std_msgs/Bool"})
    client.wait(lambda one: b"publish" in one)
    wanted = []

    def command(_):
        wanted.append(next(FLIPS[-1]) % 2 == 1)
        client.say({"op": "publish", "topic": "/l1/on/set", "msg": {"data": wanted[-1]}})
    return measure(samples, command, lambda _: client.wait(
        lambda one: b"publish" in one and json.loads(one)["msg"]["data"] == wanted[-1]))


def foxglove_switches(samples, run, **_):
    client = foxglove(run, "/l1/on")
    client.say({"op": "advertise", "channels": [{"id": 1, "topic": "/l1/on/set", "encoding": "cdr",
                                                 "schemaName": "std_msgs/msg/Bool"}]})
    client.wait(lambda one: one[:1] == b"\1")
    wanted = []

    def command(_):
        wanted.append(next(FLIPS[-1]) % 2)
        client.say(struct.pack("<BI", 1, 1) + b"\0\1\0\0" + bytes([wanted[-1]]))
    return measure(samples, command, lambda _: client.wait(lambda one: one[:1] == b"\1" and one[-1] == wanted[-1]))


def mqtt_switches(samples, run, port, **_):
    client = Mqtt(port, "ispace/l1/on")
    client.skip()
    return measure(samples, lambda _: client.publish("ispace/l1/on/set", ("OFF", "ON")[next(FLIPS[-1]) % 2]),
                   lambda _: client.wait("ispace/l1/on"))


ROWS = (
    ("TCP, text", tcp_steps(False), tcp_answers, tcp_switches),
    ("TCP, binary", tcp_steps(True), None, None),
    ("page's WebSocket", page_steps, page_answers, page_switches),
    ("rosbridge, JSON", rosbridge_steps, rosbridge_answers, rosbridge_switches),
    ("Foxglove, CDR", foxglove_steps, foxglove_answers, foxglove_switches),
    ("DDS, Fast DDS", dds_steps, dds_answers, None),
)
KINDS = ("step", "answer", "switch")


def measure_paths(paths, samples, build, options, **places):
    """Times by path and kind, in a run by steps and one in real time."""
    times = {name: {} for name, *_ in paths}
    for clock, kinds in ((["--clock", "step", "--dt", str(STEP)], KINDS[:2]), ([], KINDS[2:])):
        FLIPS.append(itertools.count(1))
        with Run(build, *clock, *options) as run:
            for name, *ways in paths:
                for kind, way in zip(KINDS, ways):
                    if kind not in kinds or way is None:
                        continue
                    try:
                        times[name][kind] = way(samples, run, **places)
                    except (Missing, OSError, EOFError) as error:
                        print(f"latency: {name}, {kind}: {error or type(error).__name__}", file=sys.stderr)
    return times


def measure_all(samples, build, stack):
    """Times by path and kind of all paths that can be measured here."""
    rows = {"echo of Python": {"answer": echo(samples)}}
    for name, text in (("room.env", ROOM), ("layout.3dm", LAYOUT)):
        pathlib.Path(name).write_text(text, encoding="ascii")
    fastdds = build / "tests" / "fastdds_client"
    has_dds = fastdds.exists() and (build / "lib" / "ispace" / "dds.so").exists()
    paths = [row for row in ROWS if has_dds or "DDS" not in row[0]]
    options = ["--web", "127.0.0.1:0", "--foxglove", "0", "--rosbridge", "0"]
    options += [f"--ros2={DOMAIN}"] if has_dds else []
    rows.update(measure_paths(paths, samples, build, options, fastdds=fastdds))
    for name, lines in (("MQTT, mosquitto", ()), ("MQTT, set_tcp_nodelay", ("set_tcp_nodelay true",))):
        if port := broker(stack, *lines):
            paths = [(name, mqtt_steps, mqtt_answers, mqtt_switches)]
            rows.update(measure_paths(paths, samples, build, ["--mqtt", f"127.0.0.1:{port}"], port=port))
    return rows


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("build", nargs="?", type=pathlib.Path, default=pathlib.Path("build"))
    words.add_argument("--samples", type=int, default=1000)
    words.add_argument("--csv", type=pathlib.Path)
    given = words.parse_args()
    build, table = given.build.resolve(), given.csv and given.csv.resolve()
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        stack.callback(os.chdir, os.getcwd())
        os.chdir(folder)
        rows = measure_all(given.samples, build, stack)
    lines = [["ms", *(f"{kind} {share}" for kind in KINDS for share in ("p50", "p99"))]]
    for name, times in rows.items():
        figures = [times[kind][int(share * (len(times[kind]) - 1))] if kind in times else None
                   for kind in KINDS for share in (0.5, 0.99)]
        lines.append([name, *("-" if one is None else f"{one:.2f}" for one in figures)])
    for name, *figures in lines:
        print(f"{name:22}" + "".join(f"{one:>12}" for one in figures))
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {given.samples} messages a figure")
    if table:
        with open(table, "w", newline="", encoding="ascii") as file:
            csv.writer(file, lineterminator="\n").writerows([one.strip() for one in line] for line in lines)


if __name__ == "__main__":
    main()
