# SPDX-License-Identifier: GPL-3.0-or-later
"""A simrun under attack: it answers TIME within a second, obeys TERM within one, memory stays bounded, streams of
honest clients are whole and in order, and clients without a role block no other."""
import json
import os
import random
import re
import signal
import sys
import time
import urllib.request

import attackers
import clients
import lab as labs
import part_kills
import topics

MOST_WAIT = 1.0          # seconds
# Bytes of the whole run, from the sums of ispace-protocol(7): during a change two worlds of half a gigabyte each, 64
# million pixels of requested pictures at 7 bytes, 128 MiB of unread answers, and what the allocator keeps.
MOST_MEMORY = 2 << 30
ROUND = 15               # seconds
HALL = ["#env 1", "ispace at=0,0 size=16,6"]
LAYOUT = ["#3dm 1", "robot id=honest at=-6,2 model=pioneer-2dx", "laser id=eye_laser at=7,-2 heading=90 fov=180 step=1 rate=40",
          "laser id=honest_laser at=-7.5,0 heading=0 fov=180 step=0.5 rate=20",
          "camera id=eye at=-7,-2,2 heading=45 tilt=-20 pixels=64,48 rate=10"]
MODES = (("real, recorded", ["--clock", "real", "--record", "run"]), ("real", ["--clock", "real"]),
         ("fast", ["--clock", "fast"]), ("one thread", ["--clock", "real", "-j", "1"]),
         ("recorded fast", ["--clock", "fast", "--record", "run"]))
READERS = ("LASER honest_laser", "SENSOR eye")
BEAMS = 361  # of honest_laser


class Run:
    """A simrun and its ports."""

    def __init__(self, lab, folder, options):
        self.lab, self.folder = lab, folder
        self.said = open(os.path.join(folder, "simrun.err"), "wb")
        read_end, write_end = os.pipe()
        self.process = lab.start(["simrun", "hall.env", "layout.3dm", "--load", ".", "--max-clients", "300",
                                  "--web", "127.0.0.1:0", "--scip", "honest_laser=0", "--cola", "eye_laser=0",
                                  "--mjpeg", "eye=0", "--foxglove", "127.0.0.1:0", "--rosbridge", "127.0.0.1:0",
                                  "--record-limit", "2G", *options], folder, out=write_end, err=self.said)
        os.close(write_end)
        with os.fdopen(read_end, encoding="utf-8") as first:
            line = first.readline()
        if not line:
            self.said.flush()
            with open(self.said.name, encoding="utf-8") as text:
                raise SystemExit("torture: simrun does not start: " + text.read())
        self.announced = json.loads(line)
        self.ports = {kind: int(re.search(r":(\d+)", self.announced[kind].split("//")[-1])[1])
                      for kind in ("listen", "web", "foxglove", "rosbridge")}
        self.port, self.page = self.ports["listen"], self.ports["web"]
        self.pid = self.process.pid

    def port_of(self, kind):
        return int(next(iter(self.announced[kind].values())).rpartition(":")[2].split("/")[0])

    def end(self, what):
        """Sends TERM; returns the seconds until the run ended. Kills a run that does not obey."""
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        while self.process.poll() is None and time.monotonic() < begin + 60:
            time.sleep(0.002)
        took = time.monotonic() - begin
        if self.process.poll() is None:
            labs.kill_session(self.pid)
            self.process.wait()
            self.lab.violated(f"{what}: TERM is not obeyed within a minute")
        elif self.process.returncode != 0:
            self.said.flush()
            with open(self.said.name, encoding="utf-8", errors="replace") as text:
                self.lab.violated(f"{what}: simrun ended with status {self.process.returncode}: {text.read()[-300:]}")
        self.said.close()
        return took


def child(work, report):
    """A process that does work(report) until it is killed, perhaps before its first step."""
    open(report, "w", encoding="utf-8").close()
    pid = os.fork()
    if pid:
        return pid
    try:
        with open(report, "w", encoding="utf-8") as file:
            work(file)
    except BaseException as error:  # no thread of this process may continue as if it were the first one
        sys.stderr.write(f"torture: {error!r}\n")
    finally:
        os._exit(0)


def read_stream(role, connect, report):
    seen = 0
    try:
        reader = connect()
        while True:
            reader.read()
            if reader.seen > seen:
                seen = reader.seen
                report.write(f"seen {seen}\n")
                report.flush()
    except clients.Wrong as wrong:
        report.write(f"wrong {role}: {wrong}\n")
    except OSError as error:
        report.write(f"ended {error}\n")


def write_scenes(folder):
    os.makedirs(folder)
    texts = {"hall.env": HALL, "other.env": [*HALL, "cube at=0,0 size=1,1,1"], "layout.3dm": LAYOUT,
             "broken.env": ["#env 1", "wall from=0,0 to=0,0"]}
    for name, lines in texts.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
    os.mkfifo(os.path.join(folder, "fifo.env"))


def last_counts(path, word):
    """The last count in a report, and the lines of its violations."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().splitlines()
    counts = [int(line.split()[1]) for line in lines if line.startswith(word + " ")]
    return (counts[-1] if counts else 0), [line[6:] for line in lines if line.startswith("wrong ")], \
        [line for line in lines if line.startswith("ended ")]


class Siege:
    """One round: attackers, honest readers and a watch on one run."""

    def __init__(self, lab, number):
        self.lab, self.number = lab, number
        self.mode, options = MODES[number % len(MODES)]
        self.name = f"round {number} ({self.mode})"
        self.folder = os.path.join(lab.folder, f"round{number}")
        write_scenes(self.folder)
        self.run = Run(lab, self.folder, options)
        self.children, self.reports = [], {}
        r = random.Random(f"{lab.seed} server {number}")
        self.watch = clients.Watch(self.run.port)
        for role in READERS:
            self.add(role, lambda report, role=role: read_stream(
                role, lambda: clients.StreamReader(self.run.port, role), report))
        for kind in topics.PROTOCOLS:
            self.add(kind, lambda report, kind=kind: read_stream(
                kind, lambda: topics.TopicReader(kind, self.run.ports[kind], BEAMS), report))
        time.sleep(0.3)
        for i in range(2):
            seed, count = r.random(), r.choice((4, 12, 40))
            self.add(f"attackers {i}", lambda report, seed=seed, count=count: attackers.attack(
                self.run.ports, seed, count, report))

    def add(self, name, work):
        path = os.path.join(self.folder, name.replace(" ", "-") + ".report")
        self.reports[name] = path
        self.children.append(child(work, path))

    def hold(self, seconds):
        """Watches; returns the violations."""
        end, most, waited = time.monotonic() + seconds, 0, 0
        try:
            while time.monotonic() < end and waited <= 20:
                waited = max(waited, self.watch.ask())
                most = max(most, clients.memory(self.run.pid, "VmHWM"))
        except (OSError, clients.Wrong) as error:
            self.lab.violated(f"{self.name}: the watch: {error!r}; simrun {'runs' if self.run.process.poll() is None else 'is gone'}")
        took = self.run.end(self.name)
        for pid in self.children:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
        return waited, most, took

    def judge(self, waited, most, took):
        limit = labs.allowed(MOST_WAIT)
        lab, sent, seen = self.lab, 0, 0
        if waited > limit:
            lab.violated(f"{self.name}: TIME waited {waited:.1f} s")
        if took > limit:
            lab.violated(f"{self.name}: TERM took {took:.1f} s")
        if most > MOST_MEMORY:
            lab.violated(f"{self.name}: {most >> 20} MiB of memory")
        for name, path in self.reports.items():
            attacker = name.startswith("attackers")
            count, wrong, ended = last_counts(path, "sent" if attacker else "seen")
            sent, seen = sent + count * attacker, seen + count * (not attacker)
            for text in wrong[:3]:
                lab.violated(f"{self.name}: {text}")
            if not attacker and count == 0:
                lab.violated(f"{self.name}: {name} got nothing: {ended}")
        torn = list(part_kills.torn_files(os.path.join(self.folder, "run")))
        if torn:
            lab.violated(f"{self.name}: half a line ends {', '.join(torn)}")
        lab.say(f"{self.name}: {sent} requests, {seen} readings whole, TIME {1000 * waited:.0f} ms, TERM {1000 * took:.0f} ms, "
                f"{most >> 20} MiB")
        lab.count("rounds")
        lab.count("requests", sent)
        lab.count("readings", seen)


def check_places(lab):
    """64 WebSockets that answer pings and take no role, silent clients and half handshakes at each other port: others
    get in."""
    folder = os.path.join(lab.folder, "places")
    write_scenes(folder)
    run = Run(lab, folder, ["--clock", "real"])
    sockets = [clients.WebSocket(run.page) for _ in range(64)]
    devices = {kind: [clients.Client(run.port_of(kind)) for _ in range(8)] for kind in ("scip", "cola", "mjpeg")}
    for kind in topics.PROTOCOLS:
        devices[kind] = [clients.Client(run.ports[kind]) for _ in range(64)]
        for client in devices[kind][:48]:
            client.socket.sendall(topics.handshake(run.ports[kind], topics.PROTOCOLS[kind])[:random.choice((-1, None))])
    end = time.monotonic() + 2.5
    while time.monotonic() < end:
        for web in sockets:
            web.answer_pings()
        time.sleep(0.1)

    def tries(what, attempt):
        lab.count("places")
        try:
            if not attempt():
                lab.violated(f"places: {what} is refused")
        except OSError as error:
            lab.violated(f"places: {what}: {error!r}")

    def ask(kind, data, answer):
        client = clients.Client(run.port_of(kind), patience=5)
        client.socket.sendall(data)
        return answer in client.socket.recv(4096)

    tries("the page behind 64 WebSockets", lambda: urllib.request.urlopen(
        f"http://127.0.0.1:{run.page}/", timeout=5).status == 200)
    tries("a WebSocket behind 64 of them", lambda: clients.WebSocket(run.page, 5).accepted)
    tries("SCIP behind 8 silent clients", lambda: ask("scip", b"VV\n", b"VV"))
    tries("CoLa behind 8 silent clients", lambda: ask("cola", b"\x02sRN DeviceIdent\x03", b"sRA"))
    tries("MJPEG behind 8 silent clients", lambda: ask("mjpeg", b"GET / HTTP/1.0\r\n\r\n", b"HTTP/1."))
    for kind in topics.PROTOCOLS:
        tries(f"{kind} behind 64 silent clients", lambda kind=kind: topics.connects(kind, run.ports[kind]))
    for client in [*sockets, *(client for held in devices.values() for client in held)]:
        client.socket.close()
    run.end("places")


def check_hoards(lab):
    """Clients of topics with thousands of subscriptions each that never read delay neither the world nor others."""
    folder = os.path.join(lab.folder, "hoards")
    write_scenes(folder)
    run = Run(lab, folder, ["--clock", "real"])
    watch = clients.Watch(run.port)
    hoards = [topics.hoard(kind, run.ports[kind]) for kind in topics.PROTOCOLS for _ in range(40)]
    lab.count("hoards", len(hoards))
    begin = time.monotonic()
    first, waited = watch.time(), 0
    while time.monotonic() < begin + 4:
        waited = max(waited, watch.ask())
    pace = (watch.time() - first) / (time.monotonic() - begin)
    if waited > labs.allowed(MOST_WAIT):
        lab.violated(f"hoards: TIME waited {waited:.1f} s")
    if pace < 0.5 / labs.allowed(1):
        lab.violated(f"hoards: the world goes at {pace:.2f} of its pace")
    for one in hoards:
        one.close()
    took = run.end("hoards")
    if took > labs.allowed(MOST_WAIT):
        lab.violated(f"hoards: TERM took {took:.1f} s")
    lab.say(f"hoards: TIME {1000 * waited:.0f} ms, pace {pace:.2f}, TERM {1000 * took:.0f} ms")


def run(lab):
    check_places(lab)
    check_hoards(lab)
    number = 0
    while lab.left() > 3:
        siege = Siege(lab, number)
        siege.judge(*siege.hold(min(ROUND, lab.left())))
        number += 1
