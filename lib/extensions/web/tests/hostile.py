#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages of strangers, lies and silence at simrun --web: rejected, without harm to others."""

import os
import socket
import time

from running import Run, check
from web_client import WebClient, dial


def first_line(url, request):
    """The first line of the answer to a raw request; "" if the server just closes."""
    client, _ = dial(url)
    with client:
        client.sendall(request)
        try:
            return client.recv(4096).split(b"\r\n")[0].decode()
        except ConnectionError:
            return ""


def strangers(run):
    own = run.url.rstrip("/")
    host = own.removeprefix("http://")
    port = host.rsplit(":", 1)[1]
    for origin, status in ((own, 101), (f"http://localhost:{port}", 101), (None, 101),
                           ("http://evil.example", 403), (f"http://evil.example:{port}", 403),
                           (f"https://127.0.0.1:{port}", 403), ("null", 403),
                           ("http://127.0.0.1:1", 403), (own + ".evil.example", 403)):
        check(WebClient(run.url, origin=origin).status == status, f"origin {origin}")
    for name, status in ((f"localhost:{port}", 101), ("evil.example", 403), ("127.0.0.1", 403),
                         (f"rebound.evil.example:{port}", 403), (f"[::1]:{port}", 403)):
        check(WebClient(run.url, host=name).status == status, f"host {name}")
        if status == 403:
            line = first_line(run.url, f"GET / HTTP/1.1\r\nHost: {name}\r\n\r\n".encode())
            check(" 403 " in line, f"the page of {name}: {line}")
    line = first_line(run.url, b"GET / HTTP/1.1\r\n\r\n")
    check(" 403 " in line, f"without Host: {line}")
    line = first_line(run.url, f"GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil\r\n\r\n".encode())
    check(" 403 " in line, f"two of Host: {line}")
    line = first_line(run.url, f"GET / HTTP/1.0\r\nHost: {host}\r\n\r\n".encode())
    check(line == "HTTP/1.1 200 OK", f"to a client of HTTP/1.0: {line}")


def lies(run):
    """Frames that claim to be huge, that are, and invalid ones."""
    for length in (4097, 1 << 20, 1 << 40, (1 << 63) + 5):
        client = WebClient(run.url)
        client.receive()
        client.frame(b"x", length=length)
        try:
            kind, code = client.receive()
            check((kind, code) in (("close", 1009), ("close", 1002)), f"{length}: {code}")
        except ConnectionError:
            pass
    # In pieces that are small.
    client = WebClient(run.url)
    client.receive()
    try:
        for i in range(100):
            client.frame(b"x" * 100, opcode=0 if i else 1, fin=False)
        check(client.receive()[0] == "close", "a message of many pieces has no end")
    except ConnectionError:
        pass
    for garbage in (os.urandom(4096), b"\x00" * 4096, b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 4000,
                    b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999\r\n\r\n",
                    b"GET " + b"/" * 9000):
        first_line(run.url, garbage + b"\r\n\r\n")
        client = WebClient(run.url)
        client.receive()
        client.socket.sendall(garbage)
        client.socket.close()


def latest(watcher):
    return float(watcher.ask("TIME").split("t=")[1].split()[0])


def silence(run):
    """Two hundred silent sockets, and pages that never read: time advances for others."""
    watcher = WebClient(run.url)
    watcher.receive()
    watcher.ask("WORLD")
    deaf = [WebClient(run.url) for _ in range(20)]
    for client in deaf:
        client.send("LASER l1")
        client.send("STREAM")
        for _ in range(100):
            client.send("FRAME")
    idle = []
    for _ in range(200):
        client, _ = dial(run.url)
        client.sendall(b"GET")
        idle.append(client)
    began, before = time.monotonic(), latest(watcher)
    time.sleep(1)
    passed = latest(watcher) - before
    wall = time.monotonic() - began
    print(f"among 220 that do not listen {passed:.3f} s went by in {wall:.3f} s")
    check(passed > 0.7 * wall, f"the world fell behind: {passed} s in {wall} s")
    newcomer = WebClient(run.url)
    check(newcomer.status == 101, "no place for a newcomer")
    newcomer.receive()
    check(newcomer.ask("FRAME").startswith("{"), "no frames for a newcomer")
    for client in idle:
        client.close()


def too_many(run):
    """More WebSockets than the limit: the server rejects the last ones, the first ones stay."""
    clients, refused = [], 0
    for _ in range(100):
        try:
            clients.append(WebClient(run.url))
        except (ConnectionError, socket.timeout):
            refused += 1
    check(refused > 0, "a hundred WebSockets at once")
    clients[0].receive()
    check(clients[0].ask("WORLD").startswith("OK WORLD"), "the first one is gone")
    for client in clients:
        client.socket.close()


with Run() as run:
    strangers(run)
    lies(run)
    silence(run)
    too_many(run)
    check(WebClient(run.url).status == 101, "nobody is let in afterwards")
    check(run.stop() == 0, "simrun did not end well")
