# SPDX-License-Identifier: GPL-3.0-or-later
"""Bumpers: the client of the role BUMPER of a robot that drives into a wall."""

import os
import tempfile
import unittest

import ispace

ROOM = """#env 1
ispace id=room size=6,4
robot id=r at=0,0 mass=25 accel=10
bumper id=b of=r stiffness=10000
"""


class Forces(unittest.TestCase):
    def test_a_robot_meets_a_wall(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        room = os.path.join(folder.name, "room.env")
        with open(room, "w", encoding="utf-8") as file:
            file.write(ROOM)
        server = ispace.simrun(room, clock="step", dt=0.01)
        self.addCleanup(server.close)
        with server.bumpers() as bumpers, server.robot("r") as robot, server.world() as world:
            self.assertEqual(bumpers.bumpers, ["b"])
            self.assertEqual(bumpers.force("b"), 0)
            robot.speed(0.6)
            world.advance(6)
            impact = bumpers.next_impact(timeout=10)
            self.assertEqual((impact.robot, impact.into, impact.force, impact.speed), ("r", "room", 300, 0.6))
            self.assertEqual(world.states()["b.force"], "300")
            robot.speed(-0.5)
            world.advance(0.5)
            self.assertEqual(bumpers.force("b"), 0)


if __name__ == "__main__":
    unittest.main()
