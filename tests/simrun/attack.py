# SPDX-License-Identifier: GPL-3.0-or-later
"""attack.py PORT PID KIND: malicious clients of a simrun, and their cost for others.

Prints its measurements; fails if a sum is exceeded: memory, descriptors, threads, rates.
"""
import os
import signal
import socket
import time

from clients import KIND, MIB, PORT, Client, check, descriptors, eventually, memory, threads


def stall():
    """Each requests another big scan, or several, and reads no byte."""
    world, reader = Client("WORLD"), Client("LASER big")
    reader.ask("STREAM")
    before = memory("VmRSS")
    stalled = []
    for i in range(40):
        for k in range(5):
            client = Client("LASER big", buffer=2048)
            client.send(["STREAM\n", "BINARY on\nSTREAM\n", "SCAN\n" * 3, "STREAM\nSCAN\n",
                         f"STREAM every={k + 2}\n"][k])
            stalled.append(client)
        check(world.ask("STEP 20").startswith("OK STEP n=20 "), "the world stands")
        check(reader.line().startswith("SCAN big "), "an honest reader misses a scan")
    grown = (memory("VmHWM") - before) / MIB
    print(f"200 readers that stall: {grown:.0f} MiB")
    # Allowed unread data, the newest scans, and data on the way.
    check(grown < 128 + 64, f"memory grew by {grown:.0f} MiB")
    check(reader.ask("STOP") == "OK STOP", "an honest reader was cut off")


def rates(world, driver, seconds=1.5):
    """Steps of the world and answers to a client, a second."""
    begin, answers = time.monotonic(), 0
    first = int(world.ask("TIME").split("steps=")[1])
    while time.monotonic() < begin + seconds:
        check(driver.ask("STATUS").startswith("OK STATUS "), "no STATUS")
        answers += 1
    last = int(world.ask("TIME").split("steps=")[1])
    took = time.monotonic() - begin
    return (last - first) / took, answers / took


def asking(requests, count):
    """A process with clients that send requests and read as fast as the server does."""
    child = os.fork()
    if child:
        time.sleep(0.5)
        return child
    clients = [Client("WORLD") for _ in range(count)]
    data = (requests * 200).encode()
    while os.getppid() != 1:
        for client in clients:
            client.push(data)
            try:
                client.socket.recv(1 << 20)
            except (BlockingIOError, ConnectionError):
                pass


def flood():
    """The cost for others of a client that never reads, and of many that always send requests."""
    world, driver = Client("WORLD"), Client("ROBOT r1")
    alone = rates(world, driver)
    print(f"alone: {alone[0]:.0f} steps and {alone[1]:.0f} answers a second")

    def measure(name, least_steps, least_answers):
        steps, answers = rates(world, driver)
        print(f"{name}: {steps:.0f} steps and {answers:.0f} answers a second")
        check(steps > least_steps * alone[0], f"{name}: the world is slow")
        check(answers > least_answers, f"{name}: others wait")

    deaf = Client("LASER l1", buffer=2048)
    deaf.send("STREAM\n")
    while deaf.push(b"SCAN\nHELP\n" * 1000):
        pass
    measure("one never reads", 0.8, alone[1] / 4)
    for name, requests in [("40 pause", "PAUSE\nRESUME\n"), ("40 ask", "LIST\nPOSES\nTIME\n")]:
        child = asking(requests, 40)
        try:
            measure(name, 0.5, 20)
        finally:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)


def noise():
    """Connections of every bad kind; afterwards all is as it was."""
    world = Client("WORLD")
    before = memory("VmRSS"), descriptors(), threads()
    begin = time.monotonic()
    for i in range(10000):
        client = Client()
        kind = i % 8
        if kind == 1:
            client.reset()
        elif kind == 2:
            client.push(os.urandom(3000) + b"\n")
        elif kind == 3:
            client.push(b"x" * 100000)
        elif kind == 4:
            client.push(b"WORLD\nSTEP\n")
            client.socket.shutdown(socket.SHUT_WR)
        elif kind == 5:
            client.push(b"LASER l1\nSTREAM\n")
            client.reset()
        elif kind == 6:
            client.push(b"ROBOT r1\n" + b"STATUS\n" * 200)
        elif kind == 7:
            client.push(b"GET / HTTP/1.1\r\n\r\nWORLD\nSHUTDOWN\n")
        if kind not in (1, 5):
            client.close()
    print(f"10000 connections: {time.monotonic() - begin:.1f} s")
    long = Client("WORLD")
    child = os.fork()
    if not child:
        long.send("TIME\n" * 100000)
        os._exit(0)
    for _ in range(100000):
        check(long.line().startswith("OK TIME "), "pipelined requests lose an answer")
    os.waitpid(child, 0)
    long.close()
    eventually(lambda: descriptors() <= before[1], "descriptors stay open")
    check(threads() <= before[2], "threads were added")
    grown = (memory("VmHWM") - before[0]) / MIB
    print(f"memory: {grown:.1f} MiB more at most")
    check(grown < 32, f"memory grew by {grown:.0f} MiB")
    check(world.ask("TIME").startswith("OK TIME "), "the world is gone")


def silent():
    """Silent clients up to the limit; a new one with a request is served all the same."""
    clients = [Client() for _ in range(256)]
    time.sleep(1.2)
    for _ in range(3):
        check(Client("WORLD").ask("TIME").startswith("OK TIME "), "no place")
    greeting = clients[0].line()
    answer = clients[0].line()
    check(greeting == "ISPACE 1" and answer.startswith("ERR 408 "), f"the first: {answer}")


def crowd(firsts):
    """Clients that connect at once, without waiting for any; then each sends its first bytes."""
    clients = []
    for _ in firsts:
        client = socket.socket()
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        client.setblocking(False)
        try:
            client.connect(("127.0.0.1", PORT))
        except BlockingIOError:
            pass
        clients.append(client)
    for client, first in zip(clients, firsts):
        client.setblocking(True)
        client.settimeout(60)
        client.sendall(first)
    return clients


def storm():
    """A thousand at once: half never read, others send a byte a second or garbage. Meanwhile one
    dies with the robot in hand."""
    world, driver = Client("WORLD"), Client("ROBOT r1")
    check(driver.ask("SPEED 0.1").startswith("OK SPEED"), "no robot")
    begin = time.monotonic()
    clients = crowd([b"WORLD\nEVENTS\n", b"LASER l1\nSTREAM\n", b"W",
                     os.urandom(3000) + b"\n"] * 250)
    slow = clients[2::4]
    for client in clients[0::4] + clients[1::4] + slow:
        check(client.recv(8) == b"ISPACE 1", "no greeting")
    print(f"1000 connections at once: {time.monotonic() - begin:.2f} s")
    driver.reset()
    for byte in b"ORL":
        for _ in range(100):
            check(world.ask(f"MARK {'x' * 250}").startswith("OK MARK "), "no MARK")
        for client in slow:
            client.send(bytes([byte]))
        time.sleep(1)
    check(Client("ROBOT r1").ask("STATUS").startswith("OK STATUS "), "the robot is still held")
    check(world.ask("TIME").startswith("OK TIME "), "the world is gone")


def edits():
    """Many clients that change the world as fast as they may, and send impossible changes."""
    world, driver = Client("WORLD"), Client("ROBOT r1")
    before = memory("VmRSS")
    bad = "".join(f"SET r1.{'k' * 3000}=1\nADD human id=x path={'0,0;' * 900}\nDELETE {'*' * 3000}\n"
                  for _ in range(3))
    child = asking("ADD human id=h1 at=1,1\nDELETE h1\n" + bad, 40)
    try:
        steps, answers = rates(world, driver, 3)
        print(f"40 change the world: {steps:.0f} steps and {answers:.0f} answers a second")
        check(steps > 100 and answers > 20, "others wait")
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    print(f"memory: {(memory('VmRSS') - before) / MIB:.1f} MiB more")
    check(memory("VmRSS") - before < 256 * MIB, "memory grew")
    check(driver.ask("STATUS").startswith("OK STATUS "), "the robot is gone")


def idle():
    time.sleep(2)


{"idle": idle, "storm": storm, "edits": edits, "stall": stall, "flood": flood, "noise": noise, "silent": silent}[KIND]()
