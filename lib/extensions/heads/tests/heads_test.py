# SPDX-License-Identifier: GPL-3.0-or-later
"""Heads that turn: the client of the role HEAD against a robot with a laser on a head."""

import os
import tempfile
import unittest

import ispace

ROOM = """#env 1
ispace size=6,4
robot id=r at=0,0
head id=h on=r at=0,0,0.5 pan_range=-90,90 speed=90
laser id=l on=h at=0,0,0 fov=90 beams=3 range=10
"""


class HeadsThatTurn(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        room = os.path.join(folder.name, "neck.env")
        with open(room, "w", encoding="utf-8") as file:
            file.write(ROOM)
        self.server = ispace.simrun(room, clock="step", dt=0.05)
        self.addCleanup(self.server.close)

    def test_a_head_turns_its_laser(self):
        with self.server.heads() as heads, self.server.world() as world, self.server.laser("l") as laser:
            self.assertEqual(heads.heads, ["h"])
            self.assertAlmostEqual(laser.scan().ranges[1], 3, places=3)
            self.assertEqual(heads.turn("h", 90), 1)
            world.advance(0.5)
            reading = heads.read("h")
            self.assertTrue(reading.moving)
            self.assertAlmostEqual(reading.pan, 45, delta=5)
            world.advance(0.7)
            heads.wait("h", timeout=10)
            self.assertEqual(heads.read("h"), ispace.HeadReading("h", 1.2, 90, 0, False))
            world.advance(0.2)
            self.assertAlmostEqual(laser.scan().ranges[1], 2, places=3)
            with self.assertRaisesRegex(ispace.Refused, "pan goes from -90 to 90"):
                heads.turn("h", 100)

    def test_wait_is_for_the_last_turn(self):
        with self.server.heads() as heads, self.server.world() as world:
            heads.turn("h", 90)
            world.advance(1.5)
            heads.turn("h", 0)
            with self.assertRaises(ispace.Timeout):
                heads.wait("h", timeout=0.3)
            world.advance(1.5)
            heads.wait("h", timeout=10)

    def test_programs_set_its_angles(self):
        with self.server.world() as world:
            world.act("h", "pan", 30)
            self.assertEqual(world.states("h"), {"h.pan": "30", "h.tilt": "0"})
            with self.assertRaisesRegex(ispace.Refused, "beyond the pan_range"):
                world.act("h", "pan", 91)


if __name__ == "__main__":
    unittest.main()
