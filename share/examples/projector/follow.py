#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the picture of a projector on the floor before a person that walks: software under test.

    follow.py 127.0.0.1:7001 [--still]

The ultrasonic tag of the person tells its position, and two positions its direction. The projector turns so that its axis
meets the floor a metre ahead of the person, at most 0.3 m from the walls. With --still it stays as it is. Needs the module
ispace, and simrun with --clock step.
"""

import argparse
import math
import re
import sys

import ispace

CYCLE = 0.2  # seconds
END = 60.0
AHEAD, MARGIN = 1.0, 0.3
LEAST_WAY = 0.05  # m between two positions that tell a direction
LEAST_TURN = 0.5  # degrees that are worth a turn


def numbers(record: str, key: str) -> list:
    """The numbers of a key in the text of a record."""
    return [float(number) for number in re.search(rf'\b{key}="?([-0-9.,e]+)', record)[1].split(",")]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", help="of simrun, HOST:PORT")
    parser.add_argument("--still", action="store_true", help="do not turn the projector")
    options = parser.parse_args()
    host, port = options.address.rsplit(":", 1)
    address = (host, int(port))
    with ispace.World(address) as world, ispace.Tag(address, "badge") as badge:
        records = {record.split(" ", 1)[0]: record for record in world.records()}
        lens_x, lens_y = numbers(records["projector"], "at") if " at=" in records["projector"] else (0.0, 0.0)
        height = numbers(records["projector"], "height")[0]
        length, width = numbers(records["ispace"], "size")[:2]
        before, aim = None, (0.0, 0.0)
        pan = tilt = 0.0
        while world.time() < END:
            fix = badge.scan()
            if fix.solved and not options.still:
                x, y = fix.x, fix.y
                if before is None:
                    before = (x, y)
                way = math.hypot(x - before[0], y - before[1])
                if way >= LEAST_WAY:
                    aim = ((x - before[0]) / way * AHEAD, (y - before[1]) / way * AHEAD)
                    before = (x, y)
                to_x = min(max(x + aim[0], MARGIN - length / 2), length / 2 - MARGIN) - lens_x
                to_y = min(max(y + aim[1], MARGIN - width / 2), width / 2 - MARGIN) - lens_y
                wanted = math.degrees(math.atan2(to_y, to_x)), math.degrees(math.atan2(-height, math.hypot(to_x, to_y)))
                if abs(math.remainder(wanted[0] - pan, 360)) > LEAST_TURN:
                    pan = max(-170.0, min(170.0, round(wanted[0], 1)))
                    world.act("p", "pan", pan)
                if abs(wanted[1] - tilt) > LEAST_TURN:
                    tilt = round(wanted[1], 1)
                    world.act("p", "tilt", tilt)
            world.advance(CYCLE)
        world.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
