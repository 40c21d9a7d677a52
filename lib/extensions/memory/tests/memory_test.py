# SPDX-License-Identifier: GPL-3.0-or-later
"""Contents at places: the client of the role MEMORY against a running world, in which a hand passes one."""

import os
import tempfile
import unittest

import ispace

ROOM = "#env 1\nfence path=-4,-3;4,-3;4,3;-4,3 closed=yes height=2.8\ninside at=0,0\n"
LAYOUT = """#3dm 1
human id=ann at=-2,0 path=3,0 speed=1
tag id=hand on=ann at=0.3,0,1.3 locate=simple
volume id=news at=0,0,1.3 radius=0.25 dwell=0.3 content="today's headline"
"""


class MemoryOfARoom(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        files = [os.path.join(folder.name, name) for name in ("room.env", "room.3dm")]
        for file, text in zip(files, (ROOM, LAYOUT)):
            with open(file, "w", encoding="utf-8") as out:
                out.write(text)
        self.record = os.path.join(folder.name, "run")
        self.server = ispace.simrun(*files, clock="step", record=self.record)
        self.addCleanup(self.server.close)

    def test_a_hand_touches_a_content_stays_and_leaves(self):
        with self.server.memory() as memory, self.server.memory("no*") as deaf, self.server.world() as world:
            self.assertEqual(memory.tags, ["hand"])
            self.assertEqual(deaf.tags, [])
            world.step(400)
            self.assertEqual(memory.tags_at("news"), ["hand"])
            self.assertEqual(world.states("news"), {"news.touched": "1"})
            world.step(300)
            touches = [memory.next_touch(5) for _ in range(3)]
            self.assertEqual([touch.kind for touch in touches], ["touch", "dwell", "leave"])
            for touch in touches:
                self.assertEqual((touch.volume, touch.tag, touch.content), ("news", "hand", "today's headline"))
            self.assertAlmostEqual(touches[0].time, 1.6, delta=0.3)
            self.assertAlmostEqual(touches[2].lasted, 0.5, delta=0.12)
            self.assertIsNone(deaf.next_touch())
            self.assertEqual(memory.tags_at("news"), [])
        self.server.close()
        with open(os.path.join(self.record, "states.csv"), encoding="utf-8") as states:
            rows = [line.strip().split(",")[1:] for line in states if ",news," in line]
        self.assertEqual([row[-1] for row in rows], ["1", "0"])

    def test_contents_are_kept_and_found(self):
        with self.server.memory() as memory:
            memory.store("mail", 1, -0.5, 1.3, "two letters", radius=0.2)
            self.assertEqual(memory.recall("mail"), "two letters")
            self.assertEqual(memory.find("LETTERS"), ["mail"])
            self.assertEqual(memory.at(1.1, -0.5, 1.3), ["mail"])
            self.assertEqual(memory.at(1.1, -0.5, 1.6), [])
            memory.store("mail", 0, 0.1, 1.3)
            self.assertEqual(memory.at(0, 0, 1.3), ["news", "mail"])
            self.assertEqual(memory.recall("mail"), "two letters")
            memory.forget("mail")
            with self.assertRaisesRegex(ispace.Refused, "no volume"):
                memory.recall("mail")


if __name__ == "__main__":
    unittest.main()
