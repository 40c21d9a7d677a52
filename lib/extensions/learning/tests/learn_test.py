#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The example of learning: its rooms are rooms, a policy drives a robot over TCP and ROS, and training learns."""

import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not installed")
    sys.exit(77)

from ispace import filters

SOURCE = os.environ["ISPACE_SOURCE_DIR"]
EXAMPLE = os.path.join(SOURCE, "share", "examples", "learn")
OFFICE = os.path.join(SOURCE, "share", "scenes", "open-office.env")
sys.path.insert(0, EXAMPLE)

from policy import Features, Policy  # noqa: E402
from rooms import office, write  # noqa: E402


def steer_policy(file):
    """A policy that turns to the goal and goes there: of the last six features."""
    size = Features(1).size
    weights = np.zeros((2, size), np.float32)
    bias = np.array([-0.5, 0], np.float32)
    weights[0, -6] = 1.5  # cosine of the bearing
    weights[1, -5] = 1.5  # its sine
    np.savez(file, w0=weights, b0=bias)


class Learn(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_example(self, program, *words, timeout=120):
        command = [sys.executable, os.path.join(EXAMPLE, program), *words]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=timeout)

    def serve(self, *options):
        """A simrun of the example's robot, and a port of it."""
        command = [filters.tool("simrun"), OFFICE, os.path.join(EXAMPLE, "robot.3dm"), "-q", *options]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return filters.parse(process.stdout.readline())

    def test_rooms_are_rooms(self):
        self.assertEqual(office(5), office(5))
        self.assertNotEqual(office(5), office(6))
        for file in write(os.path.join(self.folder, "rooms"), 1, 8):
            done = subprocess.run([filters.tool("envc"), file, "--check"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_features_remember_scans_of_an_episode(self):
        features = Features(2)
        first = np.full((2, 185), 6, np.float32)
        near = first.copy()
        near[:, :181] = 1
        self.assertTrue(np.all(features(first)[:, : 2 * features.sectors] == 0))
        later = features(near, np.array([False, True]))
        self.assertTrue(np.all(later[0, features.sectors : 2 * features.sectors] < 0))  # it was farther
        self.assertTrue(np.all(later[1, features.sectors : 2 * features.sectors] == 0))  # of a new episode

    def test_a_policy_drives_over_tcp(self):
        steer_policy(os.path.join(self.folder, "policy.npz"))
        served = self.serve("--clock", "step")
        done = self.run_example("drive.py", "policy.npz", "tcp", served.listen, "r1", "l1", "-4.2,1.4")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("reached after", done.stdout)

    def test_a_policy_drives_over_ros(self):
        steer_policy(os.path.join(self.folder, "policy.npz"))
        served = self.serve("--rosbridge", "127.0.0.1:0", "--clock", "real:2")
        address = served.rosbridge.split("//")[1]
        done = self.run_example("drive.py", "policy.npz", "ros", address, "r1", "l1", "1.5,-0.1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("reached after", done.stdout)

    def test_films_a_policy(self):
        steer_policy(os.path.join(self.folder, "policy.npz"))
        rooms = [OFFICE]
        if data := os.environ.get("ISPACE_TEST_DATA"):
            rooms.append(os.path.join(data, "turtlebot3.yaml"))
        for room in rooms:
            done = self.run_example("film.py", "policy.npz", room, "film.gif", "--people", "2", "--fps", "4", "--width", "200")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, "^[1-9][0-9]* of 40 robots reached their goals")
            with open(os.path.join(self.folder, "film.gif"), "rb") as file:
                film = file.read()
            self.assertEqual(film[:6], b"GIF89a")
            self.assertGreater(film.count(b"\x21\xf9\x04"), 8)  # pictures
            os.remove(os.path.join(self.folder, "film.gif"))

    @unittest.skipUnless(importlib.util.find_spec("torch"), "torch is not installed")
    def test_trains_and_tests(self):
        trained = self.run_example("ppo.py", "train", "policy.npz", "--minutes", "0.1", "--rooms", "2")
        self.assertEqual((trained.returncode, trained.stderr), (0, ""))
        with open(os.path.join(self.folder, "policy.csv"), encoding="utf-8") as curve:
            self.assertGreater(len(curve.readlines()), 1)
        tested = self.run_example("ppo.py", "test", "policy.npz", "--episodes", "20")
        self.assertEqual((tested.returncode, tested.stderr), (0, ""))
        self.assertRegex(tested.stdout, "^20 episodes in 40 unseen rooms, 10 people: success [01]")
        self.assertEqual(Policy(os.path.join(self.folder, "policy.npz"))(np.ones((1, 185), np.float32)).shape, (1, 2))


if __name__ == "__main__":
    unittest.main()
