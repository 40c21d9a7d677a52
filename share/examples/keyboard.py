#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives a robot of a running simrun by the keys of the terminal, and shows what its laser sees.

    simrun ispace.env ispace.3dm --listen 127.0.0.1:7001 &
    keyboard.py 127.0.0.1:7001 r1

Arrows: up and down change the speed, left and right the rotation. Space: stop. q: quit. A laser that rides on
the robot is found by itself, or named behind the robot. The picture shows the room around the robot, which
looks up; `#` is what the laser has hit.
"""

import argparse
import contextlib
import curses
import math
import sys

import ispace

SPEED_STEP = 0.1  # m/s
TURN_STEP = 15.0  # degrees/s


def picture(scan, columns, rows, reach):
    """The scan as lines of text, the robot in the middle looking up; `reach` m to each side."""
    cells = [[" "] * columns for _ in range(rows)]
    # A cell of a terminal is twice as high as wide.
    scale = min(columns / 2, rows) / 2 / reach
    for k, distance in enumerate(scan.ranges):
        if not math.isfinite(distance):
            continue
        angle = math.radians(scan.angle(k))
        row = round(rows / 2 - math.cos(angle) * distance * scale)
        column = round(columns / 2 - math.sin(angle) * distance * scale * 2)
        if 0 <= row < rows and 0 <= column < columns:
            cells[row][column] = "#"
    cells[rows // 2][columns // 2] = "A"
    return ["".join(line).rstrip() for line in cells]


class Wheel:
    """The speeds that the keys ask for."""

    def __init__(self, robot):
        self.robot = robot
        self.speed = self.turn = 0.0
        self.note = ""

    def press(self, key):
        """Obeys one key; False: the end."""
        self.note = ""
        if key in (ord("q"), 27):
            return False
        if key == ord(" "):
            self.speed = self.turn = 0.0
            self.robot.stop()
        elif key in (curses.KEY_UP, curses.KEY_DOWN):
            self.try_speed(self.speed + (SPEED_STEP if key == curses.KEY_UP else -SPEED_STEP))
        elif key in (curses.KEY_LEFT, curses.KEY_RIGHT):
            self.try_turn(self.turn + (TURN_STEP if key == curses.KEY_LEFT else -TURN_STEP))
        return True

    def try_speed(self, speed):
        try:
            self.speed = self.within(round(speed, 3), self.robot.limits.max_speed, "m/s")
            self.robot.speed(self.speed)
        except ispace.Refused as refused:
            self.note = str(refused)

    def try_turn(self, turn):
        try:
            self.turn = self.within(turn, self.robot.limits.max_rotspeed, "degrees/s")
            self.robot.rotspeed(self.turn)
        except ispace.Refused as refused:
            self.note = str(refused)

    def within(self, value, most, unit):
        if abs(value) > most:
            self.note = f"{self.robot.id} does at most {most:g} {unit}"
        return max(-most, min(most, value))


def find_laser(address, robot, wanted):
    """Returns the requested laser, or else the first on the robot; None without one."""
    if wanted:
        return wanted
    with ispace.World(address) as world:
        lasers = world.list().get("lasers", [])
    for laser in lasers:
        try:
            robot.scan(laser)
            return laser
        except ispace.Refused:
            continue
    return None


def show(screen, robot, laser, wheel, reach):
    status = robot.status()
    height, width = screen.getmaxyx()
    lines = [
        f"{robot.id}  t {status.time:8.2f} s   at {status.pose.x:7.3f} {status.pose.y:7.3f} m,"
        f" heading {status.pose.heading:6.1f}",
        f"speed {status.speed:6.3f} m/s (wanted {wheel.speed:g})   rotation {status.rotspeed:6.1f}"
        f" degrees/s (wanted {wheel.turn:g})",
        "STALLED: space, and back" if status.stall else wheel.note,
    ]
    if laser is None:
        lines.append("no laser rides on it")
    elif height > len(lines) + 1:
        lines += picture(robot.scan(laser), width - 1, height - len(lines) - 1, reach)
    lines = lines[: height - 1] + ["arrows: drive   space: stop   q: quit"]
    screen.erase()
    for row, line in enumerate(lines):
        screen.addnstr(row, 0, line, width - 1)
    screen.refresh()


def drive(screen, robot, laser, reach):
    with contextlib.suppress(curses.error):  # not every terminal can
        curses.curs_set(0)
    screen.timeout(100)  # a picture ten times a second
    wheel = Wheel(robot)
    while wheel.press(screen.getch()):
        show(screen, robot, laser, wheel, reach)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("address", help="HOST:PORT of simrun")
    parser.add_argument("robot", help="id of the robot")
    parser.add_argument("laser", nargs="?", help="id of a laser that rides on it")
    parser.add_argument("--reach", type=float, default=4, metavar="M", help="how far the picture goes (4 m)")
    options = parser.parse_args()
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        parser.error("it needs a terminal to read keys from and to draw on")
    try:
        with ispace.Robot(options.address, options.robot) as robot:
            laser = find_laser(options.address, robot, options.laser)
            curses.wrapper(drive, robot, laser, options.reach)
    except ispace.Error as error:
        sys.exit(f"keyboard.py: {error}")


if __name__ == "__main__":
    main()
