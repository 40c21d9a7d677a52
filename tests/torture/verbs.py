# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists of requests to a running simrun, and requests to a world of lists: a row for each verb that takes a list, or
that works on all records of a world. A row is a function of a count that returns the records of the layout and the
requests.

As a program: verbs.py SIMRUN ROOM LAYOUT REQUESTS starts simrun, sends the requests and waits for the answer to each.
Its status is 0 if all succeed, 1 if some are refused, as ERR 409 for a world that is full, and 2 if simrun fails.
"""
import json
import os
import socket
import subprocess
import sys
import threading

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))  # which an isolated interpreter leaves out
# pylint: disable=wrong-import-position
from layouts import DEPTH, LONG_BYTES, MOST_BYTES, SMALLEST, STEEPEST, WIDTH, spread  # noqa: E402,F401

# Whether the requests of a row succeed or are refused: the status of the program, as that of the tools.
RESULT, REFUSAL, FAILURE = 0, 1, 2


def lines(text, count):
    return [text.format(x=x, y=y, above=round(y + 0.1, 3), i=i) for i, (x, y) in enumerate(spread(count))]


def requests(text, layout=(), role="WORLD"):
    """A request again and again, to a small world."""
    return lambda count: (list(layout), [role, *lines(text, count)])


def world(record, *asked):
    """A few requests to a world of many records."""
    return lambda count: (lines(record, count), list(asked))


def each(record, text):
    """A request about each of many records."""
    return lambda count: (lines(record, count), ["WORLD", *lines(text, count)])


def path(count):
    """Points of a path, as many as a request has room for."""
    points = [f"{x},{y}" for x, y in spread(count)]
    parts = [points[i:i + 200] for i in range(0, count, 200)]
    return ["robot id=r1 at=-19,-14"], ["ROBOT r1", *("PATH " + ";".join(part) for part in parts)]


def loaded(record):
    """A scene of many records, loaded into the run."""
    return lambda count: (lines(record, count), ["WORLD", "LOAD room.env layout.3dm", "LOAD room.env layout.3dm", "RESET"])


LASER = "laser id=l{i} at={x},{y} range=3"
ROBOT = "robot id=r{i} at={x},{y} radius=0.05"
LAMP = "lamp id=l{i} at={x},{y}"
ROWS = {
    "add_things": (requests("ADD cube at={x},{y} size=0.1"), RESULT),
    "add_walls": (requests("ADD wall from={x},{y} to={x},{above}"), RESULT),
    "add_zones": (requests("ADD zone id=z{i} at={x},{y} size=0.2,0.2"), RESULT),
    "add_lasers": (requests("ADD laser at={x},{y} range=3"), RESULT),
    "add_motes": (requests("ADD mote at={x},{y},1"), RESULT),
    "add_lamps": (requests("ADD lamp at={x},{y}"), RESULT),
    "add_robots": (requests("ADD robot at={x},{y} radius=0.05"), RESULT),
    "add_people": (requests("ADD human at={x},{y} height=0.6"), RESULT),
    "add_heap": (requests("ADD human at=1,1 height=0.6"), REFUSAL),
    "add_unknown": (requests("ADD thing{i} at={x},{y}"), REFUSAL),
    "set_each": (each(LASER, "SET l{i}.range=4"), RESULT),
    "set_glob": (world(LASER, "WORLD", "SET l*.range=4", "SET l*.range=2"), RESULT),
    "set_globs": (world(LASER, "WORLD", *[f"SET l*{i}*.range=4" for i in range(8)]), RESULT),
    "move_robots": (each(ROBOT, "SET r{i}.heading=90"), RESULT),
    "act_each": (each(LAMP, "ACT l{i} on=1"), RESULT),
    "act_one": (requests("ACT l0 level=0.{i}", ["lamp id=l0 at=0,0"]), RESULT),
    "state": (world(LAMP, "WORLD", *["STATE"] * 20), RESULT),
    "delete_each": (each(LASER, "DELETE l{i}"), RESULT),
    "delete_glob": (world(LASER, "WORLD", "DELETE " + " ".join(f"l*{i}" for i in range(8))), RESULT),
    "delete_unknown": (each(LASER, "DELETE m{i}"), REFUSAL),
    "load_lasers": (loaded("laser at={x},{y} range=3"), RESULT),
    "load_robots": (loaded("robot at={x},{y} radius=0.05"), RESULT),
    "load_motes": (loaded("mote at={x},{y},1"), RESULT),
    "load_missing": (requests("LOAD none{i}.env"), REFUSAL),
    "list": (world(LASER, "WORLD", *["LIST"] * 20), RESULT),
    "poses": (world(ROBOT, "WORLD", *["POSES"] * 20), RESULT),
    "steps": (world(ROBOT, "WORLD", "STEP 20"), RESULT),
    "events": (world(ROBOT, "WORLD", "EVENTS", "STEP 20"), RESULT),
    "marks": (requests("MARK lap {i}"), RESULT),
    "path": (path, RESULT),
    "long": (world(ROBOT, "WORLD", "MARK " + "x" * 5000), REFUSAL),
    "roles": (each(ROBOT, "ROBOT r{i}"), REFUSAL),
    "scans": (requests("SCAN", ["laser id=l1 at=0,0"], "LASER l1"), RESULT),
    "sonars": (requests("SONAR", ["robot id=r1 at=0,0"], "ROBOT r1"), RESULT),
    "motions": (requests("FORWARD 0.{i}", ["robot id=r1 at=0,0"], "ROBOT r1"), RESULT),
    "tracks": (requests("TRACK t{i} {x},{y}"), RESULT),
    "one_track": (requests("TRACK t {x},{y}"), RESULT),
    "told": (world(ROBOT, "WORLD", *[f"TRACK t{i} 0,{0.01 * i:g}" for i in range(100)], "STEP 20"), RESULT),
    "nodes": (each("laser id=l{i} at={x},{y} range=3\nnode id=n{i} sensors=l{i}", "SET l{i}.range=2"), RESULT),
    "sent": (requests("SEND {i}", ["laser id=l1 at=0,0", "node id=n1 sensors=l1 delay=1s", "laser id=l2 at=1,0", "node id=n2 sensors=l2"], "NODE n1"),
             RESULT),
    "goals": (requests("GOTO {x},{y}", ["robot id=r1 at=0,0.1 radius=0.1"], "ROBOT r1"), RESULT),
    "lights": (each("lux at={x},{y},1", "ADD lamp at={x},{y}"), RESULT),
}
FAMILIES = {f"verb_{row}": row for row in ROWS}


def files(family, size):
    """The files of a family at a size in bytes, the operand first."""
    make, _ = ROWS[FAMILIES[family]]
    each_of = 100
    layout, asked = make(each_of)
    count = max(1, size * each_of // len("\n".join([*layout, *asked])))
    layout, asked = make(count)
    return {"room.env": f"#env 1\nispace size={WIDTH:g},{DEPTH:g}\n", "layout.3dm": "\n".join(["#3dm 1", *layout, ""]),
            "requests": "\n".join([*asked, ""])}


def steepest(family):
    del family
    return STEEPEST


def memory_bound(family):
    del family


def is_refused(family):
    return ROWS[FAMILIES[family]][1] == REFUSAL


def command(tools, family, operand):
    del family
    folder = os.path.dirname(operand)
    return [sys.executable, "-IS", os.path.abspath(__file__), f"{tools}/simrun", operand, f"{folder}/layout.3dm",
            f"{folder}/requests"]


def answers(stream, count):
    """The answers to requests, without events; fewer if the server disconnects."""
    found = []
    while len(found) < count:
        line = stream.readline()
        if not line:
            break
        if line.startswith((b"OK", b"ERR", b"SCAN")):
            found.append(line.decode(errors="replace").strip())
    return found


def main():
    simrun, room, layout, path_of_requests = sys.argv[1:]
    with open(path_of_requests, "rb") as file:
        asked = file.read()
    count = asked.count(b"\n")
    with subprocess.Popen([simrun, room, layout, "--clock", "step", "--load", os.path.dirname(room)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE) as child:
        first = child.stdout.readline()
        if not first:
            print(child.stderr.read().decode(errors="replace").strip(), file=sys.stderr)
            sys.exit(FAILURE)
        host, port = json.loads(first)["listen"].rsplit(":", 1)
        client = socket.create_connection((host, int(port)))
        stream = client.makefile("rb")
        stream.readline()
        # The answers are read meanwhile: a server does not read from clients that leave theirs unread.
        threading.Thread(target=client.sendall, args=(asked,), daemon=True).start()
        found = answers(stream, count)
        child.terminate()
        said = child.stderr.read().decode(errors="replace")
        status = child.wait()
    refused = [answer for answer in found if answer.startswith("ERR")]
    if status != 0 or (len(found) < count and not refused):
        print(f"status {status}, {len(found)} answers to {count} requests; {said}", file=sys.stderr)
        sys.exit(FAILURE)
    if refused:
        print(f"verbs.py: error: {len(refused)} of {count} refused: {refused[0]}", file=sys.stderr)
        sys.exit(REFUSAL)


if __name__ == "__main__":
    main()
