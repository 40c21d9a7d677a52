#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A client that guesses tokens all the time, at this address: the right one passes each time, at the port of requests and at
# those of Foxglove and rosbridge, which answer further wrong ones with 429.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

printf '#env 1\nispace size=8,6\n' >room.env
printf '#3dm 1\nrobot id=r1 at=0,0\n' >layout.3dm
printf 's3cret\n' >token
chmod 600 token
cat >guess.py <<'END'
import json
import re
import socket
import subprocess
import threading
import time

TURNS = 40
MORE = ["--web", "127.0.0.1:0", "--foxglove", "127.0.0.1:0", "--rosbridge", "127.0.0.1:0"]
run = subprocess.Popen(["simrun", "room.env", "layout.3dm", "-q", "--token-file", "token", *MORE], stdout=subprocess.PIPE)
told = json.loads(run.stdout.readline())
PORTS = {key: int(re.search(r":(\d+)/?$", told[key])[1]) for key in ("listen", "foxglove", "rosbridge")}


def asked(token):
    """The answer to a token among requests."""
    with socket.create_connection(("127.0.0.1", PORTS["listen"]), 10) as client:
        stream = client.makefile("rb")
        stream.readline()
        client.sendall(f"TOKEN {token}\n".encode())
        return stream.readline().decode()


def opened(kind, token):
    """The status of HTTP that a page of another server gets."""
    protocol = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n" if kind == "foxglove" else ""
    with socket.create_connection(("127.0.0.1", PORTS[kind]), 10) as client:
        client.sendall((f"GET /?token={token} HTTP/1.1\r\nHost: 127.0.0.1:{PORTS[kind]}\r\nUpgrade: websocket\r\n"
                        "Connection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
                        f"Origin: https://app.example.org\r\n{protocol}\r\n").encode())
        return int(client.recv(4096).split()[1])


def guess(count):
    while not over.is_set():
        answer = asked("guess")
        assert answer.startswith(("ERR 401 ", "ERR 429 ")), answer
        count.append(answer[:7])
        time.sleep(0.005)


over, guesses = threading.Event(), []
stranger = threading.Thread(target=guess, args=(guesses,))
stranger.start()
try:
    while "ERR 429" not in guesses:
        time.sleep(0.01)
    for _ in range(TURNS):
        assert asked("s3cret") == "OK TOKEN\n"
        for kind in ("foxglove", "rosbridge"):
            assert opened(kind, "s3cret") == 101, kind
    statuses = {kind: {opened(kind, "guess") for _ in range(10)} for kind in ("foxglove", "rosbridge")}
    for kind, seen in statuses.items():
        assert 429 in seen and seen <= {401, 429}, f"{kind}: {seen}"
finally:
    over.set()
    stranger.join()
    run.terminate()
assert run.wait(30) == 0
print(f"{len(guesses)} guesses, {guesses.count('ERR 429')} of them answered 429")
END
timeout 120 python3 guess.py || fail "the owner, or the answers to guesses"
