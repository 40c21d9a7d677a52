# SPDX-License-Identifier: GPL-3.0-or-later
"""Plugs that meter appliances: the client of the role METER against a kitchen."""

import os
import tempfile
import unittest

import ispace

ROOM = "#env 1\nispace size=6,4\n"
LAYOUT = """#3dm 1
appliance id=kettle kind=kettle at=1,1
appliance id=tv kind=tv at=-1,1
plug id=p of=kettle count=0.001
plug id=q of=tv
"""


class MetersOfARoom(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        files = []
        for name, text in (("room.env", ROOM), ("room.3dm", LAYOUT)):
            files.append(os.path.join(folder.name, name))
            with open(files[-1], "w", encoding="utf-8") as file:
                file.write(text)
        self.server = ispace.simrun(*files, clock="step", dt=0.1)
        self.addCleanup(self.server.close)

    def test_a_kettle_boils(self):
        with self.server.meter() as meter, self.server.meter("q") as tv, self.server.world() as world:
            self.assertEqual((meter.plugs, tv.plugs), (["p", "q"], ["q"]))
            self.assertEqual(meter.read("p").power, 0)
            self.assertEqual(meter.read("q").power, 0.4)
            meter.watch()
            world.act("kettle", "on", True)
            world.advance(200)
            readings = []
            while (reading := meter.next_reading(0.2)) is not None:
                readings.append(reading)
            powers = [reading.power for reading in readings if reading.plug == "p"]
            self.assertEqual((powers[0], powers[-1]), (2200, 0))
            # 175 s at 2200 W.
            self.assertAlmostEqual(meter.read("p").energy, 2200 * 175 / 3.6e6, delta=1e-4)
            self.assertEqual(world.states()["kettle.state"], "standby")
            world.act("q", "on", False)
            world.advance(1)
            self.assertEqual((tv.read("q").on, tv.read("q").power), (False, 0))
            self.assertEqual(world.states()["tv.state"], "off")
            meter.unwatch()
            with self.assertRaisesRegex(ispace.Refused, "no plug `p`"):
                tv.read("p")


if __name__ == "__main__":
    unittest.main()
