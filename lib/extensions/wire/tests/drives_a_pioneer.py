# SPDX-License-Identifier: GPL-3.0-or-later
"""A drive over the packets of Pioneers: around a square, with sonars and laser, into a wall and off."""
import math
import os
import pathlib
import socket
import struct

from device_run import Run, check, scratch
from pioneer import (CLOSE, CONFIG, CONFIGURED, ENABLE, HEAD, LONG_SCAN, MOVE, OPEN, RVEL, SIM_STAT,
                     SIMULATION, STATUS, VEL,
                     Pioneer)

ROOM = "#env 1\nispace size=6,6\n"
LAYOUT = "#3dm 1\nrobot id=r1 model=pioneer-3dx at=-1,-1\nlaser id=l1 on=r1 at=0.1,0,0.3 range=0.02,10\n"


def near(found, wanted, most, what):
    check(abs(found - wanted) <= most, f"{what} is {found}, not {wanted}")


def to_wall(x, y, angle):
    """Millimetres from a point of the room to its wall."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    walls = [((3 if d > 0 else -3) - p) / d for p, d in ((x, c), (y, s)) if abs(d) > 1e-12]
    return 1000 * min(walls)


class World:
    """The true poses, by the Simulator TCP Protocol."""

    def __init__(self, where):
        self.stream = socket.create_connection(where, timeout=30).makefile("rw", newline="\n")
        self.stream.readline()
        self.ask("WORLD")

    def ask(self, request):
        self.stream.write(request + "\n")
        self.stream.flush()
        answer = self.stream.readline()
        check(answer.startswith("OK"), request + ": " + answer)
        return dict(word.split("=") for word in answer.split() if "=" in word)

    def pose(self):
        return [float(v) for v in self.ask("POSES")["poses"].split(",")[1:]]


def connect(where):
    robot = Pioneer(where)
    check(robot.names == [b"r1", b"Pioneer", b"p3dx-sh"], f"it calls itself {robot.names}")
    robot.send(OPEN, 1)
    robot.send(CONFIG, 1)
    strings = robot.wait(CONFIGURED).split(b"\0")
    check(strings[:3] == [b"Pioneer", b"p3dx-sh", b"SIM"], f"its configuration is of {strings[:3]}")
    return robot


def drive_square(robot):
    for corner in range(4):
        robot.send(MOVE, 2000)
        robot.rests()
        robot.send(HEAD, (90 * (corner + 1) + 180) % 360 - 180)
        status = robot.rests()
        print(f"corner {corner + 1}: {status.x} {status.y} {status.heading:.1f}")
    for value in (status.x, status.y):
        near((value + 32768) % 65536 - 32768, 0, 1, "the end of the square")
    near(status.heading, 0, 0.1, "its heading")


def look_about(robot):
    x, y = -1, -1
    status = robot.until(lambda s: True)
    check(len(status.sonars) == 16, f"{len(status.sonars)} sonars")
    # The sonar of the left side looks straight at the wall; that of the front right, 10 degrees off
    # the axis, hears it at the edge of its cone of 15 degrees.
    near(status.sonars[0], to_wall(x + 0.069, y + 0.136, 90), 1, "the left sonar")
    near(status.sonars[7], to_wall(x + 0.069, y - 0.136, -90), 1, "the right sonar")
    for number, value in ((36, -90), (37, 90), (38, 100), (35, 2)):
        robot.send(number, value)
    robot.wait(LONG_SCAN)
    while robot.scan is None:
        robot.read()
    check(len(robot.scan) == 181, f"{len(robot.scan)} readings")
    for k, found in enumerate(robot.scan):
        near(found, to_wall(x + 0.1, y, k - 90), 1, f"reading {k}")
    before = robot.statuses, robot.scans
    robot.until(lambda s: robot.statuses == before[0] + 20)
    check(robot.scans >= before[1] + 19, "not a scan with every status")


def hit_the_wall(robot):
    robot.send(VEL, 400)
    stalled = robot.until(lambda s: s.is_stalled)
    near(stalled.x, 4000 - 250, 10, "where it hits the wall")
    check(stalled.stall & 0x3E00 and not stalled.stall & 0xFE, f"bumpers {stalled.stall:x}")
    for _ in range(20):
        robot.wait(STATUS)
        check(robot.status.is_stalled, "it pushes, and is not stalled")
    robot.send(VEL, -200)
    robot.until(lambda s: not s.stall and s.left == -200)
    robot.send(RVEL, 30)
    robot.until(lambda s: s.rotspeed == 30)
    robot.send(VEL, 0)
    robot.send(RVEL, 0)
    robot.until(lambda s: not s.left and not s.right)


def compare(robot, world):
    robot.send(SIM_STAT, 1)
    x, y, _, heading = struct.unpack_from("<iiii", robot.wait(SIMULATION), 12)
    status = robot.until(lambda s: True)
    true_x, true_y, true_heading = world.pose()
    near(x, 1000 * true_x, 1, "SIM_STAT's x")
    near(y, 1000 * true_y, 1, "SIM_STAT's y")
    near(heading, true_heading, 1, "SIM_STAT's heading")
    near((status.x + 32768) % 65536 - 32768, 1000 * (true_x + 1), 1, "x by odometry")
    near((status.y + 32768) % 65536 - 32768, 1000 * (true_y + 1), 1, "y by odometry")
    near(status.heading, true_heading, 0.1, "the heading by odometry")
    print(f"ends at {true_x} {true_y} {true_heading}")


def leave(robot):
    robot.send(ENABLE, 0)
    robot.send(CLOSE, 1)
    try:
        while True:
            robot.read()
    except EOFError:
        return


def main():
    pathlib.Path("room.env").write_text(ROOM)
    pathlib.Path("robots.3dm").write_text(LAYOUT)
    with Run("room.env", "robots.3dm", "--clock", "real:20", "--p2os", "r1=0") as run:
        where = run.ports["p2os"]["r1"]
        world = World(run.listen)
        robot = connect(where)
        try:
            Pioneer(where)
            check(False, "a second client is served")
        except (EOFError, ConnectionError):
            pass
        robot.send(VEL, 300)
        robot.until(lambda s: robot.statuses > 5)
        check(robot.status.x == 0 and not robot.status.flags & 1, "it moves with its motors off")
        robot.send(ENABLE, 1)
        robot.until(lambda s: s.flags & 1)
        drive_square(robot)
        look_about(robot)
        hit_the_wall(robot)
        compare(robot, world)
        leave(robot)
        again = connect(where)
        status = again.until(lambda s: True)
        check((status.x, status.y, status.heading) == (0, 0, 0), "odometry goes on in the next session")
        leave(again)


if __name__ == "__main__":
    with scratch() as folder:
        os.chdir(folder)
        main()
