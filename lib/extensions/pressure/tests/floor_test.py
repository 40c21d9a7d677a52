# SPDX-License-Identifier: GPL-3.0-or-later
"""Floors and beds that feel weights: the client of the role FLOOR against the room SELF, in which a patient goes to bed."""

import os
import unittest

import ispace

SCENES = os.path.join(os.environ["ISPACE_SOURCE_DIR"], "share", "scenes")


class FloorOfARoom(unittest.TestCase):
    def setUp(self):
        files = [os.path.join(SCENES, name) for name in ("self.env", "self.3dm")]
        self.server = ispace.simrun(*files, clock="step")
        self.addCleanup(self.server.close)

    def test_a_patient_walks_and_lies_down(self):
        with self.server.floor() as floor, self.server.world() as world, self.server.person("patient") as patient:
            self.assertEqual(floor.sensors, ["bed-sensor", "chair-sensor", "floor"])
            before = floor.read("floor")
            self.assertAlmostEqual(before.weight, 58 + 23 * 1.7**2 + 144 * 0.3**2, delta=0.01)
            self.assertEqual((before.columns, before.rows), (24, 18))
            self.assertAlmostEqual(sum(map(sum, before.grid())), before.weight * 9.80665, delta=1)
            self.assertFalse(floor.read("bed-sensor").occupied)
            floor.watch(every=5)
            patient.path([(0, 0.3), (1.5, 0.4)])
            world.advance(12)
            readings = [floor.next_reading(5) for _ in range(72)]
            self.assertIsNone(floor.next_reading())
            numbers = [reading.number for reading in readings if reading.sensor == "floor"]
            self.assertEqual(numbers, list(range(5, 125, 5)))
            floor.unwatch()
            bed = floor.read("bed-sensor")
            self.assertTrue(bed.occupied)
            self.assertEqual((bed.weight, bed.columns, bed.cells), (58.0, 0, {}))
            states = world.states()
            self.assertEqual((states["bed-sensor.occupied"], states["bed-sensor.weight"]), ("1", "58"))
            self.assertEqual(states["chair-sensor.occupied"], "0")
            self.assertAlmostEqual(floor.read("floor").weight, before.weight - 58, delta=0.01)
            with self.assertRaisesRegex(ispace.Refused, "did you mean `bed-sensor`"):
                floor.read("bad-sensor")
            with self.assertRaisesRegex(ispace.Refused, "wanted every=k"):
                floor.watch(every=0)


if __name__ == "__main__":
    unittest.main()
