# SPDX-License-Identifier: GPL-3.0-or-later
"""A policy from observations to actions, and what it reads of them: numpy alone."""

import numpy as np

POOL = 4  # beams of a sector: 45 sectors of 4 degrees
BACK = (3,)  # earlier scans beside the present one, steps ago: people move


class Features:
    """Turns observations of N rows into numbers near 1, with a memory of the last steps."""

    def __init__(self, count, beams=181, max_range=6.0):
        self.sectors, self.beams, self.max_range = beams // POOL, beams, max_range
        self.past = np.zeros((max(BACK) + 1, count, self.sectors), np.float32)
        self.size = self.sectors * (1 + len(BACK)) + 6

    def __call__(self, observations, fresh=None):
        """``fresh`` selects rows of which this is the first observation of an episode; all if None."""
        ranges = observations[:, : self.sectors * POOL].reshape(-1, self.sectors, POOL).min(2)
        near = 0.5 / (0.25 + ranges) - 0.5 / (0.25 + self.max_range)
        self.past = np.roll(self.past, 1, 0)
        self.past[0] = near
        if fresh is None:
            self.past[:] = near
        elif fresh.any():
            self.past[:, fresh] = near[fresh]
        return self.joined(near, observations)

    def last(self, observations):
        """Those of an observation that follows, without remembering it."""
        ranges = observations[:, : self.sectors * POOL].reshape(-1, self.sectors, POOL).min(2)
        return self.joined(0.5 / (0.25 + ranges) - 0.5 / (0.25 + self.max_range), observations, 1)

    def joined(self, near, observations, later=0):
        distance, bearing, speed, turn = observations[:, self.beams : self.beams + 4].T
        motion = np.column_stack(
            [np.cos(bearing), np.sin(bearing), np.tanh(distance / 4), np.minimum(distance, 1), speed, turn / 2]
        )
        earlier = [self.past[back - later] - near for back in BACK]
        return np.concatenate([near, *earlier, motion], 1, dtype=np.float32)


class Policy:
    """The mean action of a trained network, from the file that ppo.py writes."""

    def __init__(self, file, count=1):
        with np.load(file) as data:
            self.layers = [(data[f"w{i}"], data[f"b{i}"]) for i in range(len(data.files) // 2)]
        self.features, self.is_first = Features(count), True

    def reset(self):
        self.is_first = True

    def __call__(self, observations, fresh=None):
        x = self.features(observations, None if self.is_first else np.zeros(len(observations), bool) if fresh is None else fresh)
        self.is_first = False
        for i, (weights, bias) in enumerate(self.layers):
            x = x @ weights.T + bias
            if i + 1 < len(self.layers):
                x = np.tanh(x)
        return np.clip(x, -1, 1)
