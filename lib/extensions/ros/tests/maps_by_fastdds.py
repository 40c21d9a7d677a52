# SPDX-License-Identifier: GPL-3.0-or-later
"""A small mapper over Fast DDS: a robot that circles by cmd_vel in a room with obstacles is mapped from /l1/scan and the
frames of /tf, in cells of 5 cm, and the walls and the free floor are those of /map."""
import collections
import math
import os

from dds_run import Client, free_domain, need_dds
from device_run import Run, check, scratch

ROOM = """#env 1
fence id=f path=-3,-2;3,-2;3,2;1,2;1,3;-3,3 closed=yes
fence id=g path=-2.2,1.5;-1.4,2.2;-1.9,2.6 closed=yes
fence id=h path=1.6,-1.4;2.3,-1.4;2.3,-0.7;1.6,-0.7 closed=yes
"""
LAYOUT = """#3dm 1
robot id=r1 at=-0.6,-0.4 radius=0.2
laser id=l1 on=r1 at=0.1,0,0.3 fov=270 step=0.5 range=12 rate=10
"""
CELL = 0.05


class Mapper:
    """Counts how often a beam ended in a cell, and how often one went through it."""

    def __init__(self):
        self.hits = collections.Counter()
        self.passes = collections.Counter()

    def add(self, scan, pose):
        x, y, heading = pose
        first, _, step = scan["limits"][:3]
        for i, length in enumerate(scan["ranges"]):
            bearing = heading + first + i * step
            cos, sin = math.cos(bearing), math.sin(bearing)
            reach = min(length, 12)
            for k in range(int((reach - CELL) / CELL)):
                at = k * CELL
                self.passes[math.floor((x + at * cos) / CELL), math.floor((y + at * sin) / CELL)] += 1
            if math.isfinite(length):
                self.hits[math.floor((x + length * cos) / CELL), math.floor((y + length * sin) / CELL)] += 1

    def walls(self):
        return {cell for cell, count in self.hits.items() if count >= 3}

    def floor(self):
        return {cell for cell, count in self.passes.items() if count >= 3 and cell not in self.hits}


def chain(frames, *children):
    """The pose on the floor of the last child: x, y, heading."""
    x = y = heading = 0.0
    for child in children:
        pose = frames[child]["pose"]
        x += pose[0] * math.cos(heading) - pose[1] * math.sin(heading)
        y += pose[0] * math.sin(heading) + pose[1] * math.cos(heading)
        heading += 2 * math.atan2(pose[5], pose[6])
    return x, y, heading


def near(cell, cells):
    return any((cell[0] + i, cell[1] + j) in cells for i in (-1, 0, 1) for j in (-1, 0, 1))


def main():
    need_dds()
    with scratch() as folder:
        os.chdir(folder)
        for name, text in (("room.env", ROOM), ("layout.3dm", LAYOUT)):
            with open(name, "w", encoding="ascii") as file:
                file.write(text)
        domain = free_domain()
        with Run("room.env", "layout.3dm", "-q", f"--ros2={domain}"), \
                Client(domain, "rt/l1/scan", "rt/tf", "rt/tf_static", "rt/map", "rt/r1/odom") as client:
            fixed = {one["child"]: one for one in client.newest("rt/tf_static")["transforms"]}
            grid = client.newest("rt/map")
            # A circle of half a metre, once around.
            client.wait(lambda: len(client.seen["rt/l1/scan"]) > 140, "scans", "twist rt/r1/cmd_vel 0.25 0.5")
            moved = client.newest("rt/r1/odom")["pose"]
            scans, moving = list(client.seen["rt/l1/scan"]), list(client.seen["rt/tf"])
        frames = {message["transforms"][0]["t"]: {one["child"]: one for one in message["transforms"]}
                  for message in moving}
        mapper, used = Mapper(), 0
        for scan in scans:
            if scan["t"] in frames:
                mapper.add(scan, chain({**fixed, **frames[scan["t"]]}, "r1_odom", "r1", "l1"))
                used += 1
        check(used > 60, f"few scans have frames: {used}")
        check(math.hypot(*moved[:2]) < 1.2 and abs(moved[5]) > 1e-3, f"the robot does not circle: {moved}")

        corner = [round(value / CELL) for value in grid["origin"][:2]]
        known = {(corner[0] + i % grid["width"], corner[1] + i // grid["width"]): value
                 for i, value in enumerate(grid["cells"])}
        walls = {cell for cell, value in known.items() if value == 100}
        floor = {cell for cell, value in known.items() if value == 0}
        edges = {cell for cell in walls if near(cell, floor)}
        found, free = mapper.walls(), mapper.floor()
        wrong = [cell for cell in found if not near(cell, walls)]
        blocked = [cell for cell in free if cell not in floor and not near(cell, floor)]
        share = sum(near(cell, found) for cell in edges) / len(edges)
        print(f"{used} scans, {len(found)} cells of walls, {len(wrong)} of them wrong, {share:.0%} of the walls; "
              f"{len(free)} free cells, {len(blocked)} of them wrong")
        check(not wrong and not blocked, f"walls or floor in other places: {wrong[:5]} {blocked[:5]}")
        check(share > 0.7, "walls are missing")
        check(len(free) > 0.7 * len(floor), "floor is missing")


main()
