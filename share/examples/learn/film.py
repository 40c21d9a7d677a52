# SPDX-License-Identifier: GPL-3.0-or-later
"""Films a robot that a policy of ppo.py leads among people: of some episodes the longest one with success.

    python3 film.py policy.npz ROOM film.gif [--people 10] [--episodes 40] [--seed 1] [OPTION...]

ROOM is a file of simrun: a room, a map of ROS, a floor plan. OPTIONs are those of films: --fps, --width, --speed and
--from. Needs python3-numpy.
"""

import argparse
import shlex
import subprocess
import tempfile

import numpy as np
from policy import Policy

import ispace
from ispace.filters import tool

TASK = {
    "goal": {"distance": [3, 8], "detour": 1.5, "radius": 0.3},
    "truncations": [{"signal": "steps", "above": 399}],
}


def run(policy, env, seed, folder):
    """Runs an episode of each row, and exports the best one. Returns its command, and how many reached their goals."""
    count = env.num_envs
    running, success = np.ones(count, bool), np.zeros(count, bool)
    best, longest = None, 0
    observations, _ = env.reset(seed=seed)
    while running.any():
        # Rows that have ended wait: their actions begin further episodes, which do not count.
        observations, _, over, cut, infos = env.step(policy(observations))
        ends = (over | cut) & running
        running &= ~ends
        if not ends.any():
            continue
        success |= ends & infos["success"]
        for row in np.flatnonzero(ends):
            # First those with success, then the longer ones.
            score = infos["episode"]["l"][row] + (1000 if success[row] else 0)
            if score > longest:
                longest, best = score, env.export(row, folder)
    return best, int(success.sum())


def film(options, more):
    task = {**TASK, "people": [options.people, options.people]}
    with tempfile.TemporaryDirectory(prefix="ispace.") as folder:
        with ispace.VectorEnv(options.room, options.episodes, task=task) as env:
            command, reached = run(Policy(options.policy, options.episodes), env, options.seed, folder)
        words = [tool("simrun"), *shlex.split(command)[1:], "-q", "--record", "run"]
        subprocess.run(words, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        subprocess.run([tool("simrun"), "--replay", f"{folder}/run", "-o", options.film, *more], check=True)
    print(f"{reached} of {options.episodes} robots reached their goals")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("policy", "room", "film"):
        parser.add_argument(name)
    for name, usual in (("people", 10), ("episodes", 40), ("seed", 1)):
        parser.add_argument(f"--{name}", type=int, default=usual)
    film(*parser.parse_known_args())
