# SPDX-License-Identifier: GPL-3.0-or-later
"""Doors with locks: the client of the role LOCK against two rooms."""

import os
import tempfile
import unittest

import ispace

ROOM = """#env 1
fence id=f path=0,0;8,0;8,4;0,4 closed=yes
wall id=w from=4,0 to=4,4
inside at=1,1
inside at=7,1
door id=d wall=w offset=2 locked=yes access=42
human id=ann at=1,1 tag=42
"""


class DoorsWithLocks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        room = os.path.join(folder.name, "room.env")
        with open(room, "w", encoding="utf-8") as file:
            file.write(ROOM)
        self.server = ispace.simrun(room, clock="step", dt=0.1)
        self.addCleanup(self.server.close)

    def test_a_card_opens(self):
        with self.server.locks() as locks, self.server.world() as world:
            self.assertEqual(locks.doors, ["d"])
            self.assertFalse(locks.show("d", "7"))
            self.assertTrue(locks.show("d", "42"))
            world.advance(1)
            self.assertEqual(locks.read("d"), ispace.LockReading("d", 1, True, False, False))
            world.advance(5)
            self.assertEqual(locks.read("d"), ispace.LockReading("d", 6, False, True, False))
            with self.assertRaisesRegex(ispace.Refused, "no door .* is `x`"):
                locks.read("x")

    def test_programs_lock(self):
        with self.server.world() as world:
            with self.assertRaisesRegex(ispace.Refused, "an open door cannot be locked"):
                world.act("d", "open", True)
            world.act("d", "locked", False)
            world.act("d", "open", True)
            self.assertEqual(world.states()["d.open"], "1")
            self.assertEqual(world.states()["d.locked"], "0")


if __name__ == "__main__":
    unittest.main()
