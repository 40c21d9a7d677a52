#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""VectorEnv and Env against a simrun, and the checker of vector environments against planted faults."""

import importlib.util
import os
import signal
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is not installed")
    sys.exit(77)

import ispace
from ispace import filters
from ispace.vector import AutoresetMode, Box

SCENES = os.path.join(os.environ["ISPACE_SOURCE_DIR"], "share", "scenes")
OFFICE = os.path.join(SCENES, "open-office.env")
STEPS = 120


def actions_of(count, steps=STEPS, seed=0):
    random = np.random.default_rng(seed)
    actions = random.uniform(-1, 1, (steps, count, 2)).astype(np.float32)
    actions[..., 0] = np.abs(actions[..., 0])
    return actions


class Worlds(unittest.TestCase):
    def setUp(self):
        self.made = []

    def tearDown(self):
        for env in self.made:
            env.close()

    def make(self, *args, **keys):
        self.made.append(ispace.VectorEnv(*args, **keys))
        return self.made[-1]

    def test_shapes_and_types(self):
        env = self.make(OFFICE, num_envs=5)
        observations, infos = env.reset(seed=3)
        self.assertEqual(env.num_envs, 5)
        self.assertEqual(observations.shape, (5, 181 + 4))
        self.assertEqual(observations.dtype, np.float32)
        self.assertEqual(infos, {})
        self.assertIn(observations, env.observation_space)
        self.assertEqual(env.action_space.shape, (5, 2))
        self.assertEqual(env.single_action_space.low.tolist(), [-1, -1])
        self.assertIs(env.metadata["autoreset_mode"], AutoresetMode.NEXT_STEP)
        for actions in actions_of(5, 30):
            observations, rewards, terminations, truncations, infos = env.step(actions)
            self.assertIn(observations, env.observation_space)
            self.assertEqual((rewards.shape, rewards.dtype), ((5,), np.float64))
            self.assertEqual((terminations.dtype, truncations.dtype), (np.bool_, np.bool_))

    def test_numbers_order_and_threads_do_not_matter(self):
        def tale(env, rows):
            told = [env.reset(seed=[row + 50 for row in rows])[0]]
            for actions in actions_of(40):
                told.append(np.column_stack([np.column_stack(env.step(actions[rows])[:2])]))
            return told

        some = [7, 3, 30]
        alone = tale(self.make(OFFICE, num_envs=3, people=4), some)
        every = tale(self.make(OFFICE, num_envs=40, people=4, j=2), list(range(40)))
        for one, other in zip(alone, every):
            np.testing.assert_array_equal(one, other[some])

    def test_modes(self):
        task = {"ends": [], "truncations": [{"signal": "steps", "above": 9}]}
        same = self.make(OFFICE, num_envs=2, task=task, autoreset_mode="SAME_STEP")
        following = self.make(OFFICE, num_envs=2, task=task)
        waiting = self.make(OFFICE, num_envs=2, task=task, autoreset_mode=AutoresetMode.DISABLED)
        for env in self.made:
            env.reset(seed=1)
        for actions in actions_of(2, 10):
            of_same, of_following = same.step(actions), following.step(actions)
            of_waiting = waiting.step(actions)
        for given in (of_same, of_following, of_waiting):
            self.assertEqual(given[3].tolist(), [True, True])
            self.assertEqual(given[4]["_success"].tolist(), [True, True])
            self.assertEqual(given[4]["episode"]["l"].tolist(), [10, 10])
        np.testing.assert_array_equal(of_same[4]["final_obs"], of_following[0])
        self.assertEqual(of_same[4]["_final_obs"].tolist(), [True, True])
        begun = following.step(actions)
        np.testing.assert_array_equal(begun[0], of_same[0])
        self.assertEqual(begun[1].tolist(), [0, 0])
        with self.assertRaises(ispace.Error):
            waiting.step(actions)
        after, _ = waiting.reset(options={"reset_mask": np.array([True, False])})
        np.testing.assert_array_equal(after[0], begun[0][0])
        np.testing.assert_array_equal(after[1], of_waiting[0][1])

    def test_shared_arrays(self):
        env = self.make(OFFICE, num_envs=4, copy=False)
        first, _ = env.reset(seed=1)
        was = first.copy()
        env.actions[:] = 0.5
        second = env.step(env.actions)[0]
        np.testing.assert_array_equal(first, was)  # two halves take turns
        self.assertTrue(np.shares_memory(second, env.observations))
        np.testing.assert_array_equal(np.from_dlpack(env.observations), second)

    def test_several_rooms_and_robots(self):
        rooms = [OFFICE, os.path.join(SCENES, "office.yaml")]
        env = self.make(rooms, num_envs=12, robots=2, people=2)
        self.assertEqual(env.num_envs, 24)
        env.reset(seed=1)
        for actions in actions_of(24, 50):
            observations, _, terminations, truncations, _ = env.step(actions)
            self.assertIn(observations, env.observation_space)
            ended = (terminations | truncations).reshape(12, 2)
            self.assertTrue(np.all(ended.any(1) == ended.all(1)))  # a world ends for all of its robots

    def test_bad_input(self):
        with self.assertRaisesRegex(ispace.ToolError, "nowhere.env"):
            ispace.VectorEnv("nowhere.env")
        with self.assertRaisesRegex(ispace.ToolError, "task.yaml:1"):
            ispace.VectorEnv(OFFICE, task={"pepole": 3})
        for count in (0, -1, 1_000_001):
            with self.assertRaisesRegex(ispace.ToolError, "whole number from 1"):
                ispace.VectorEnv(OFFICE, num_envs=count)
        for count in (None, 2.5, "2"):
            with self.assertRaises(TypeError):
                ispace.VectorEnv(OFFICE, num_envs=count)
        env = self.make(OFFICE, num_envs=2)
        with self.assertRaisesRegex(ispace.Error, "reset it before"):
            env.step(np.zeros((2, 2), np.float32))
        env.reset(seed=1)
        with self.assertRaises(ValueError):
            env.step(np.zeros((3, 2), np.float32))
        for kind in (complex, str, object):
            with self.assertRaises(TypeError):
                env.step(np.zeros((2, 2), kind))
        with self.assertRaisesRegex(ispace.Error, "row 1 is not finite"):
            env.step(np.array([[0, 0], [0, np.nan]], np.float32))
        with self.assertRaises(ValueError):
            env.reset(options={"reset_mask": np.array([1, 0])})
        env.step(np.zeros((2, 2)))
        env.close()
        with self.assertRaises(ispace.Error):
            env.step(np.zeros((2, 2)))

    def test_leaves_no_memory_behind(self):
        env = self.make(OFFICE)
        self.assertFalse([name for name in os.listdir("/dev/shm") if name.startswith(f"ispace-{os.getpid()}-")])
        env._worlds._process.kill()
        with self.assertRaises(ispace.ToolError):
            env.reset()

    def test_a_reader_that_goes_leaves_no_memory_behind(self):
        name = f"ispace-test-{os.getpid()}"
        words = [filters.tool("simrun"), OFFICE, "--vector", "2", "--shm", name]
        with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            process.stdout.readline()
            self.assertIn(name, os.listdir("/dev/shm"))
            process.stdout.close()
            process.stdin.write(b"reset\n")
        self.assertNotIn(name, os.listdir("/dev/shm"))

    def test_an_interrupted_wait_mixes_no_replies(self):
        class Interrupt(Exception):
            pass

        def interrupt(*_):
            raise Interrupt

        env, other = (self.make(OFFICE, num_envs=64, people=8) for _ in range(2))
        other.reset(seed=1)
        actions = actions_of(64, 3)
        for step in range(3):
            other.step(actions[step])
        env.reset(seed=1)
        os.kill(env.pid, signal.SIGSTOP)  # so that the wait is long
        before = signal.signal(signal.SIGALRM, interrupt)
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with self.assertRaises(Interrupt):
            env.step(actions[0])
        signal.signal(signal.SIGALRM, before)
        os.kill(env.pid, signal.SIGCONT)
        for step in range(1, 3):
            observations = env.step(actions[step])[0]
        np.testing.assert_array_equal(observations, other.observations)
        self.assertGreater(env.bytes_of_world, 0)

    def test_names_of_folders(self):
        env = self.make(OFFICE)
        env.reset(seed=1)
        with tempfile.TemporaryDirectory() as folder:
            here = os.getcwd()
            os.chdir(folder)  # simrun is in another
            try:
                env.export(0, "a folder")
                env.export(0, b"b")
            finally:
                os.chdir(here)
            self.assertEqual(sorted(os.listdir(folder)), ["a folder", "b"])
            with self.assertRaisesRegex(ValueError, "one line"):
                env.export(0, folder + "/c\nquit")
            self.assertEqual(env.step(np.zeros((1, 2)))[0].shape, (1, 185))

    def test_an_episode_repeats_in_simrun(self):
        env = self.make(OFFICE, num_envs=3, people=5, task={"ends": []})
        env.reset(seed=11)
        for actions in actions_of(3):
            env.step(actions)
        with tempfile.TemporaryDirectory() as folder:
            command = env.export(1, folder).split()
            command[0] = filters.tool("simrun")
            done = subprocess.run([*command, "--record", "run"], cwd=folder, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(os.path.join(folder, "run", "robots.csv"), encoding="utf-8") as file:
                rows = [line.split(",") for line in file if line[0] != "#"]
        last = dict(zip(rows[0], rows[-1]))
        np.testing.assert_allclose([float(last["x"]), float(last["y"])], env.poses[1, :2], atol=1e-5)

    def test_one_world(self):
        with ispace.Env(OFFICE, people=1) as env:
            first, info = env.reset(seed=5)
            self.assertEqual((first.shape, info), ((185,), {}))
            self.assertIn(first, env.observation_space)
            env.action_space.seed(1)
            end = False
            for _ in range(1000):
                observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
                self.assertIsInstance(reward, float)
                if end := terminated or truncated:
                    break
            self.assertTrue(end)
            again, _ = env.reset(seed=5)
            np.testing.assert_array_equal(first, again)

    def test_passes_the_checker(self):
        for mode in AutoresetMode:
            task = {"truncations": [{"signal": "steps", "above": 29}]}
            env = self.make(OFFICE, num_envs=4, people=2, task=task, autoreset_mode=mode)
            self.assertEqual(ispace.check_vector_env(env, steps=60), [])

    @unittest.skipUnless(importlib.util.find_spec("gymnasium"), "gymnasium is not installed")
    def test_passes_the_checks_of_gymnasium(self):
        from gymnasium.utils.env_checker import check_env
        from gymnasium.utils.env_match import check_environments_match

        with ispace.Env(OFFICE) as env, ispace.Env(OFFICE) as other:
            check_env(env, skip_render_check=True)
            check_environments_match(env, other, num_steps=50)


class Corridor:
    """A vector environment of points on a line, with the contract of Gymnasium, or one fault of it."""

    def __init__(self, mode="NEXT_STEP", fault="", count=4):
        self.num_envs, self.mode, self.fault = count, mode, fault
        self.single_observation_space = Box(np.array([-2, 0]), np.array([2, 1]), dtype=np.float32)
        self.single_action_space = Box(-1, 1, (1,), np.float32)
        self.observation_space = Box(np.tile([-2, 0], (count, 1)), np.tile([2, 1], (count, 1)), dtype=np.float32)
        self.action_space = Box(-1, 1, (count, 1), np.float32)
        self.metadata = {} if fault == "no mode" else {"autoreset_mode": mode}
        self.random = [np.random.default_rng() for _ in range(count)]
        self.place, self.steps = np.zeros(count), np.zeros(count, int)
        self.over = np.zeros(count, bool)
        self.buffer = np.zeros((count, 2), np.float32)

    def begin(self, i):
        self.place[i], self.steps[i], self.over[i] = self.random[i].uniform(-0.5, 0.5), 0, False

    def seen(self):
        observations = np.column_stack([self.place, self.steps / 40]).astype(np.float32)
        if self.fault == "type":
            return observations.astype(float)
        if self.fault == "shape":
            return observations[:, :1]
        if self.fault == "bounds":
            observations[:, 1] *= 100
        if self.fault == "nan" and self.steps[0] == 5:
            observations[0, 0] = np.nan
        if self.fault == "overwritten":
            self.buffer[:] = observations
            return self.buffer
        return observations

    def reset(self, *, seed=None, options=None):
        mask = (options or {}).get("reset_mask", np.ones(self.num_envs, bool))
        if self.fault == "mask ignored":
            mask = np.ones(self.num_envs, bool)
        for i in range(self.num_envs):
            own = seed[i] if isinstance(seed, (list, tuple)) else None if seed is None else seed + i
            if self.fault == "one seed" and isinstance(seed, int):
                own = seed
            if self.fault == "list of seeds" and isinstance(seed, (list, tuple)):
                own = seed[0] + 3 * i
            if self.fault == "no seed" and own is None:
                own = 0
            if own is not None and self.fault != "unseeded" and mask[i]:
                self.random[i] = np.random.default_rng(own)
            if mask[i]:
                self.begin(i)
        return self.seen(), {"start": self.place.copy()} if self.fault == "no info mask" else {}

    def step(self, actions):
        assert self.mode != "DISABLED" or not self.over.any()
        rewards, infos = np.zeros(self.num_envs), {}
        terminations = np.zeros(self.num_envs, bool)
        truncations = np.zeros(self.num_envs, bool)
        if self.fault == "rolled actions":
            actions = np.roll(actions, 1, 0)
        if self.fault == "shared random":
            self.random = [self.random[0]] * self.num_envs
        for i in range(self.num_envs):
            if self.over[i] and self.fault != "late reset":
                self.begin(i)
                if self.fault == "reward of reset":
                    rewards[i] = 1
                if self.fault == "heeds actions":
                    self.place[i] += 0.1 * actions[i, 0]
                continue
            if self.fault == "coupled":
                self.place[i] += 0.01 * actions[0, 0]
            if self.fault == "drift by row":
                self.place[i] += 0.001 * i
            drift = 0.02 * self.random[i].normal()
            self.place[i] = np.clip(self.place[i] + 0.2 * actions[i, 0] + drift, -1.5, 1.5)
            if self.fault == "unrepeatable":
                self.place[i] += 1e-4 * np.random.default_rng().random()
            self.steps[i] += 1
            rewards[i] = self.place[i]
            terminations[i] = abs(self.place[i]) > 1
            truncations[i] = self.steps[i] >= 40
            self.over[i] = terminations[i] or truncations[i]
        final = self.seen()
        if self.mode == "SAME_STEP" and self.over.any():
            ended = self.over.copy()
            for i in np.flatnonzero(ended):
                self.begin(i)
            if self.fault == "final is new":
                final = self.seen()
            if self.fault != "no final":
                infos = {"final_obs": final, "_final_obs": ended}
            if self.fault == "final mask":
                infos["_final_obs"] = ~ended
        observations = final if self.fault == "old observation" else self.seen()
        if self.fault == "rewards":
            rewards = rewards[:, None]
        if self.fault == "infinite reward":
            rewards[0] = np.inf
        if self.fault == "flags":
            terminations = terminations.astype(int)
        if self.fault == "no info mask":
            infos["place"] = self.place.copy()
        if self.fault == "short infos":
            infos["place"], infos["_place"] = self.place[:1].copy(), np.ones(self.num_envs, bool)
        return observations, rewards, terminations, truncations, infos


class Checker(unittest.TestCase):
    def test_a_good_environment_has_no_faults(self):
        for mode in ("NEXT_STEP", "SAME_STEP", "DISABLED"):
            self.assertEqual(ispace.check_vector_env(Corridor(mode)), [], mode)

    def test_finds_planted_faults(self):
        faults = {
            "NEXT_STEP": {
                "no mode": "autoreset_mode",
                "type": "float64",
                "shape": "shape",
                "bounds": "outside of their space",
                "nan": "NaN",
                "overwritten": "overwrites",
                "one seed": "same episode",
                "list of seeds": r"\[s, s \+ 1",
                "no seed": "without a seed",
                "unseeded": "same seed",
                "unrepeatable": "another run",
                "rolled actions": "others",
                "coupled": "others",
                "drift by row": "order",
                "shared random": "another run|others|order",
                "rewards": "rewards",
                "infinite reward": "not finite",
                "flags": "terminations",
                "no info mask": "mask",
                "short infos": "row for each",
                "reward of reset": "reward",
                "heeds actions": "heeds",
                "late reset": "should only reset",
            },
            "SAME_STEP": {
                "no final": "lack final_obs",
                "final is new": "not that of a reset",
                "old observation": "not that of a reset",
                "final mask": "_final_obs",
            },
            "DISABLED": {"mask ignored": "does not select"},
        }
        for mode, of_mode in faults.items():
            for fault, words in of_mode.items():
                with self.subTest(mode=mode, fault=fault):
                    with self.assertRaisesRegex(AssertionError, words):
                        ispace.check_vector_env(Corridor(mode, fault))
                    self.assertTrue(ispace.check_vector_env(Corridor(mode, fault), raises=False))


if __name__ == "__main__":
    unittest.main()
