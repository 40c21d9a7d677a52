# SPDX-License-Identifier: GPL-3.0-or-later
"""heavy.py PORT PID KIND: requests that are much work; others are answered meanwhile, and TERM is
obeyed. Prints how long the slowest answer took."""
import json
import os
import signal
import socket
import threading
import time

from clients import KIND, PID, Client, check

# The aim on an idle machine is 20 ms; it once was half a minute.
PATIENCE = float(os.environ.get("ISPACE_PATIENCE", "3"))


class Watch:
    """Another client, which requests the time continuously."""

    def __init__(self):
        self.client, self.slowest = Client("WORLD"), 0.0
        self.ends = self.is_served = False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        answer = "OK TIME "
        while not self.ends and answer.startswith("OK TIME "):
            begin, answer = time.monotonic(), ""
            try:
                answer = self.client.ask("TIME")
            finally:
                self.slowest = max(self.slowest, time.monotonic() - begin)
            time.sleep(0.005)
        self.is_served = self.ends

    def end(self, what):
        self.ends = True
        self.thread.join()
        check(self.is_served, f"{what}: no answer to TIME")
        print(f"{what}: the slowest answer of TIME took {self.slowest * 1000:.0f} ms")
        check(self.slowest < PATIENCE, f"{what}: TIME waited {self.slowest:.1f} s")


def term(what):
    """Ends the run, which the script sees the status of."""
    begin = time.monotonic()
    os.kill(PID, signal.SIGTERM)

    def is_gone():
        try:
            with open(f"/proc/{PID}/stat", encoding="ascii") as stat:
                return stat.read().rsplit(")", 1)[1].split()[0] == "Z"
        except (FileNotFoundError, ProcessLookupError):  # the script's shell has taken its status
            return True

    while not is_gone():
        check(time.monotonic() < begin + 60, f"{what}: TERM is not obeyed")
        time.sleep(0.005)
    took = time.monotonic() - begin
    print(f"{what}: TERM took {took * 1000:.0f} ms")
    check(took < PATIENCE, f"{what}: TERM took {took:.1f} s")


def globs():
    """Patterns that backtrack, over ids that nearly match."""
    watch, world = Watch(), Client("WORLD")
    pattern = "*" + "a" * 120 + "b*" + "c" + "a" * 120
    for _ in range(5):
        answer = world.ask("DELETE " + " ".join([pattern] * 8))
        check(answer.startswith("ERR 404 no record "), answer[:80])
    check(world.ask("DELETE *" + "a" * 300).startswith("ERR 400 "), "a long glob is matched")
    world.send(("DELETE " + " ".join([pattern] * 8) + "\n") * 20)
    time.sleep(0.5)
    watch.end("globs")
    term("globs")


def pictures():
    """A camera of 16 million pixels, which is recorded."""
    watch, world = Watch(), Client("WORLD")
    answer = world.ask("ADD camera id=big at=0,-1.5,1 heading=90 pixels=4000,4000")
    check(answer.startswith("OK ADD id=big"), answer)
    # Its first picture is due at the next full second at the latest.
    time.sleep(2)
    reader = Client("SENSOR big")
    reader.send("SCAN\n")
    time.sleep(1)
    watch.end("pictures")
    term("pictures")


def sums():
    """Sensors until memory would be out: the server rejects each, and the run continues."""
    watch, world = Watch(), Client("WORLD")
    answers = [world.ask("ADD laser at=0,1 step=0.0009 rate=40") for _ in range(64)]
    refused = [answer for answer in answers if not answer.startswith("OK ADD ")]
    print(f"{len(answers) - len(refused)} of 64 lasers, then {refused[0]}")
    check(0 < len(refused) < 64, "no bound, or no laser at all")
    check(all(answer.startswith("ERR 409 ") for answer in refused), refused[0])
    check(world.ask("LIST").startswith("OK LIST "), "the run has ended")
    watch.end("sums")
    term("sums")


def people():
    """People at one point, then side by side: the first are refused, and a step stays short."""
    watch, world = Watch(), Client("WORLD")
    check(world.ask("PAUSE").startswith("OK "), "no pause")
    answers = [world.ask("ADD human at=1.2,1.2 walk=wander") for _ in range(200)]
    check(answers[0].startswith("OK ADD "), answers[0])
    check(all(answer.startswith("ERR 409 ") and " overlaps " in answer for answer in answers[1:]), answers[-1])
    for i in range(5):
        answer = world.ask(f"ADD human at={-1.5 + 0.6 * i:.1f},-1.2 walk=wander")
        check(answer.startswith("OK ADD "), answer)
    check(world.ask("RESUME").startswith("OK "), "no way on")
    time.sleep(1)
    watch.end("people")
    term("people")


def pace(world):
    """Simulated seconds for each second."""
    begin, first = time.monotonic(), float(world.ask("TIME").split("t=")[1].split()[0])
    time.sleep(3)
    return (float(world.ask("TIME").split("t=")[1].split()[0]) - first) / (time.monotonic() - begin)


def motes():
    """Sensors that measure each other, until the world could not keep its pace: in a pause, while it runs, and by a
    change of all of their rates at once."""
    watch, world = Watch(), Client("WORLD")
    check(world.ask("PAUSE").startswith("OK "), "no pause")
    spots = [f"at={-2.9 + 0.01 * (i % 580):.2f},{-1.9 + 0.1 * (i // 580):.2f},1" for i in range(1200)]
    slow = [world.ask(f"ADD mote {spot} rate=1") for spot in spots[:300]]
    check(all(answer.startswith("OK ADD ") for answer in slow), slow[-1])
    answer = world.ask("SET mote*.rate=200")
    check(answer.startswith("ERR 409 the world would take "), f"300 motes at 200 Hz: {answer}")
    check(world.ask("DELETE mote*").startswith("OK "), "no end of motes")
    for is_paused in (True, False):
        added, answer = 0, ""
        for spot in spots:
            answer = world.ask(f"ADD mote {spot} rate=200")
            if not answer.startswith("OK ADD "):
                break
            added += 1
        print(f"{added} motes, then {answer}")
        check(added > 0, "no mote added")
        check(answer.startswith("ERR 409 the world would take "), f"{added} motes at 200 Hz: {answer}")
        check(world.ask("SET r1.at=-1,0.1").startswith("OK "), "a robot may not be moved")
        check(world.ask("RESUME" if is_paused else "DELETE mote1").startswith("OK "), "no way on")
        print(f"the pace is {pace(world):.2f}")
        check(world.ask("DELETE mote*").startswith("OK "), "no end of motes")
        time.sleep(2.5)
    check(world.ask("ADD mote at=0,0,1 rate=200").startswith("OK ADD "), "no room after the motes are gone")
    watch.end("motes")
    term("motes")


def pairs(sensor, source):
    """Sensors at 200 Hz, each of which measures many sources: the world refuses more, or it keeps its pace."""
    watch, world = Watch(), Client("WORLD")
    check(world.ask("PAUSE").startswith("OK "), "no pause")
    added, answer = 0, ""
    for i in range(300):
        at = f"at={-2.9 + 0.1 * (i % 58):.2f},{-1.9 + 0.6 * (i // 58):.2f}"
        for record in (f"{sensor} {at},1 rate=200", f"{source} {at} on=yes"):
            answer = world.ask(f"ADD {record}")
        if not answer.startswith("OK ADD "):
            break
        added += 1
    print(f"{added} pairs, then {answer}")
    is_refused = answer.startswith("ERR 409 the world would take ")
    check(added > 0 and (is_refused or answer.startswith("OK ADD ")), f"{added} pairs: {answer}")
    check(world.ask("RESUME").startswith("OK "), "no way on")
    reached = pace(world)
    print(f"the pace is {reached:.2f}")
    check(is_refused or reached > 0.3, f"{added} pairs at a pace of {reached:.2f}")
    watch.end(sensor)
    term(sensor)


def lights():
    pairs("lux", "lamp")


def sounds():
    pairs("microphone", "speaker")


def connected(address):
    host, port = address.rsplit(":", 1)
    connection = socket.create_connection((host, int(port)), timeout=60)
    return connection


def web_socket(address):
    connection = connected(address)
    connection.sendall((f"GET /ws HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\n"
                        "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n").encode())
    check(b" 101 " in connection.recv(100), "no WebSocket")
    return connection


def places():
    """All connections of each port taken by clients that send one request."""
    with open("announced", encoding="utf-8") as file:
        ports = json.load(file)
    web = ports["web"].removeprefix("http://").rstrip("/")
    idlers = [web_socket(web) for _ in range(64)]
    words = {"scip": b"VV\n", "cola": b"\x02sRN DeviceIdent\x03", "mjpeg": b"GET / "}
    for protocol, word in words.items():
        for _ in range(8):
            idlers.append(connected(*ports[protocol].values()))
            idlers[-1].sendall(word)
    time.sleep(1.5)
    for _ in range(3):
        idlers.append(web_socket(web))
    words["mjpeg"] = b"GET / HTTP/1.1\r\n\r\n"
    for protocol, word in words.items():
        program = connected(*ports[protocol].values())
        program.sendall(word)
        check(program.recv(100), f"no place for a client of {protocol}")
        idlers.append(program)
    term("places")


{"globs": globs, "pictures": pictures, "sums": sums, "places": places, "people": people,
 "motes": motes, "lights": lights, "sounds": sounds}[KIND]()
