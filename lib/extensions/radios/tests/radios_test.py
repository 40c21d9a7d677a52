# SPDX-License-Identifier: GPL-3.0-or-later
"""Radios: the client of the role RADIO between a base and a robot, with a wall between at the end."""

import os
import tempfile
import unittest

import ispace

ROOM = """#env 1
ispace size=20,6
wall id=w from=0,-3 to=0,1
robot id=r at=-6,0
radio id=base at=-9,0,1 range=12
radio id=rover on=r at=0,0,1 range=12
"""


class Messages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        room = os.path.join(folder.name, "room.env")
        with open(room, "w", encoding="utf-8") as file:
            file.write(ROOM)
        self.server = ispace.simrun(room, clock="step", dt=0.1)
        self.addCleanup(self.server.close)

    def test_messages_go_both_ways(self):
        with self.server.radios("base") as base, self.server.radios("rover") as rover, self.server.world() as world:
            self.assertEqual((base.radios, rover.radios), (["base"], ["rover"]))
            base.send("base", "go  to 3,4")
            world.advance(0.1)
            message = rover.next_message(timeout=10)
            self.assertEqual((message.radio, message.sender, message.text), ("rover", "base", "go  to 3,4"))
            self.assertAlmostEqual(message.margin, 12.0, places=1)  # a quarter of the range
            rover.send("rover", "done")
            world.advance(0.1)
            self.assertEqual(base.next_message(timeout=10).text, "done")
            self.assertEqual((base.heard("base"), rover.heard("rover")), (1, 1))
            self.assertEqual(world.states()["rover.heard"], "1")

    def test_a_wall_halves_the_range(self):
        with self.server.radios("*") as radios, self.server.world() as world:
            world.set("r", "at", "2,-1")  # 11 m away, behind the wall
            radios.send("base", "lost")
            self.assertEqual(radios.heard("rover"), 0)
            world.set("r", "at", "2,2")
            radios.send("base", "beside the wall")
            self.assertEqual(radios.heard("rover"), 1)
            world.act("rover", "channel", 2)
            radios.send("base", "on another channel")
            self.assertEqual(radios.heard("rover"), 1)


if __name__ == "__main__":
    unittest.main()
