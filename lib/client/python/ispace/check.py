# SPDX-License-Identifier: GPL-3.0-or-later
"""A checker for vector environments, of ispace or others, by the contract of Gymnasium 1.x."""

from __future__ import annotations

import importlib
from typing import Any, Callable, Dict, List, Optional, Tuple

np: Any = importlib.import_module("numpy")
Array = Any  #: numpy.ndarray


class VectorEnvFaults(AssertionError):
    """The faults that check_vector_env() has found."""

    def __init__(self, faults: List[str]) -> None:
        super().__init__("\n".join(faults))
        self.faults = faults


def check_vector_env(env: Any, *, seed: int = 0, steps: int = 300, raises: bool = True) -> List[str]:
    """Checks a vector environment of arrays by the contract of Gymnasium 1.x.

    It looks at spaces, shapes, types and bounds of what reset and step return; that equal seeds and actions give
    equal episodes, whatever the other environments of the batch do and whatever their order; that environments differ;
    that returned arrays are not overwritten by later steps; that infos have their masks; and at the mode of autoreset
    that ``metadata`` names: NEXT_STEP, SAME_STEP or DISABLED with ``reset_mask``. It steps the environment some
    thousand times with random actions; faults of ends are found as far as episodes end within ``steps``.

    Returns the faults, a sentence each. Raises VectorEnvFaults, an AssertionError, if there are some and ``raises``.
    """
    checker = _Checker(env, seed, steps)
    try:
        checker.run()
    except _Stop:
        pass
    if checker.faults and raises:
        raise VectorEnvFaults(checker.faults)
    return checker.faults


class _Stop(Exception):
    """What follows makes no sense after this fault."""


class _Run:
    """What an environment returned, as copies; [0] is of reset."""

    def __init__(self) -> None:
        self.observations: List[Array] = []
        self.rewards: List[Array] = []
        self.terminations: List[Array] = []
        self.truncations: List[Array] = []

    def ended(self, step: int) -> Array:
        return self.terminations[step] | self.truncations[step]


class _Checker:
    def __init__(self, env: Any, seed: int, steps: int) -> None:
        self.env, self.seed, self.steps = env, seed, steps
        self.faults: List[str] = []

    def fault(self, text: str, stop: bool = False) -> None:
        if text not in self.faults:
            self.faults.append(text)
        if stop:
            raise _Stop

    def call(self, what: str, function: Callable[[], Any]) -> Any:
        try:
            return function()
        except Exception as error:
            self.fault(f"{what} raises {type(error).__name__}: {error}", stop=True)

    def run(self) -> None:
        self.check_attributes()
        self.draw_actions()
        first = self.episodes(self.seed, self.actions, check=True)
        self.check_seeds(first)
        self.check_repeats(first)
        if self.count > 1:
            self.check_independence(first)
            self.check_order(first)
        {"NEXT_STEP": self.check_next_step, "SAME_STEP": self.check_same_step, "DISABLED": self.check_disabled}[
            self.mode
        ](first)

    # What the environment says of itself.

    def check_attributes(self) -> None:
        env = self.env
        for name in (
            "num_envs",
            "single_observation_space",
            "single_action_space",
            "observation_space",
            "action_space",
            "metadata",
        ):
            if not hasattr(env, name):
                self.fault(f"the environment has no attribute {name}", stop=True)
        self.count = env.num_envs
        if not isinstance(self.count, (int, np.integer)) or self.count < 1:
            self.fault(f"num_envs is {self.count!r}, not a number of environments", stop=True)
        self.space, self.action_space = env.single_observation_space, env.single_action_space
        shape = getattr(self.space, "shape", None)
        if shape is None or getattr(self.space, "dtype", None) is None:
            self.fault("single_observation_space is no space of arrays; others are not checked", stop=True)
        for name, single, batch in (
            ("observation", self.space, env.observation_space),
            ("action", self.action_space, env.action_space),
        ):
            wanted = (self.count, *single.shape)
            if tuple(getattr(batch, "shape", None) or ()) != wanted:
                self.fault(f"{name}_space has the shape {getattr(batch, 'shape', None)}, not {wanted}")
            if getattr(batch, "dtype", None) != single.dtype:
                self.fault(f"{name}_space and single_{name}_space differ in dtype")
        mode = (env.metadata or {}).get("autoreset_mode")
        word = str(getattr(mode, "name", mode)).replace("-", "").replace("_", "").lower()
        modes = {"nextstep": "NEXT_STEP", "samestep": "SAME_STEP", "disabled": "DISABLED"}
        if word not in modes:
            self.fault(f"metadata names no autoreset_mode, but {mode!r}", stop=True)
        self.mode = modes[word]

    def draw_actions(self) -> None:
        """Actions of all steps, two sets of them, drawn for each environment apart."""
        random = np.random.default_rng(self.seed)
        space = self.action_space
        shape = (2, self.steps, self.count, *space.shape)
        if hasattr(space, "n"):
            drawn = random.integers(0, int(space.n), shape) + int(getattr(space, "start", 0))
        elif hasattr(space, "nvec"):
            drawn = random.integers(0, np.broadcast_to(space.nvec, shape))
        elif np.issubdtype(space.dtype, np.integer):
            drawn = random.integers(space.low, space.high, shape, endpoint=True)
        else:
            low, high = np.maximum(space.low, -1e3), np.minimum(space.high, 1e3)
            drawn = random.uniform(low, high, shape)
        self.actions, self.other_actions = drawn.astype(space.dtype)

    # Episodes, and what they return.

    def reset(self, seed: Any = None, options: Optional[Dict[str, Any]] = None) -> Tuple[Array, Dict[str, Any]]:
        given = self.call("reset", lambda: self.env.reset(seed=seed, options=options))
        if not isinstance(given, tuple) or len(given) != 2:
            self.fault("reset does not return observations and infos", stop=True)
        observations, infos = given
        self.check_observations(observations, "reset")
        self.check_infos(infos, "reset")
        return observations, infos

    def step(self, actions: Array) -> Tuple[Array, Array, Array, Array, Dict[str, Any]]:
        given = self.call("step", lambda: self.env.step(actions))
        if not isinstance(given, tuple) or len(given) != 5:
            self.fault(
                "step does not return observations, rewards, terminations, truncations and infos", stop=True
            )
        observations, rewards, terminations, truncations, infos = given
        self.check_observations(observations, "step")
        rewards = np.asarray(rewards)
        if rewards.shape != (self.count,) or not np.issubdtype(rewards.dtype, np.floating):
            self.fault(f"rewards are {rewards.dtype} of shape {rewards.shape}, not floats of ({self.count},)", True)
        if not np.all(np.isfinite(rewards)):
            self.fault("rewards are not finite")
        for name, flags in (("terminations", terminations), ("truncations", truncations)):
            flags = np.asarray(flags)
            if flags.shape != (self.count,) or flags.dtype != np.bool_:
                self.fault(f"{name} are {flags.dtype} of shape {flags.shape}, not bools of ({self.count},)", True)
        self.check_infos(infos, "step")
        return observations, rewards, np.asarray(terminations), np.asarray(truncations), infos

    def check_observations(self, observations: Any, where: str, rows: Optional[Array] = None) -> None:
        space, wanted = self.space, (self.count, *self.space.shape)
        if not isinstance(observations, np.ndarray) or observations.shape != wanted:
            shape = getattr(observations, "shape", None)
            self.fault(f"observations of {where} have the shape {shape}, not {wanted}", stop=True)
        if observations.dtype != space.dtype:
            self.fault(f"observations of {where} are {observations.dtype}, not {space.dtype} as in their space")
        seen = observations if rows is None else observations[rows]
        if np.issubdtype(seen.dtype, np.floating) and np.any(np.isnan(seen)):
            self.fault(f"observations of {where} are not numbers (NaN)")
        elif hasattr(space, "low") and not (np.all(seen >= space.low) and np.all(seen <= space.high)):
            self.fault(f"observations of {where} are outside of their space")

    def check_infos(self, infos: Any, where: str) -> None:
        if not isinstance(infos, dict):
            self.fault(f"infos of {where} are no dict", stop=True)
        for key, value in infos.items():
            if not isinstance(key, str) or key.startswith("_"):
                continue
            mask = infos.get("_" + key)
            if mask is None:
                self.fault(f"infos of {where} have {key}, but no mask _{key}")
            elif np.shape(mask) != (self.count,) or np.asarray(mask).dtype != np.bool_:
                self.fault(f"the mask _{key} in infos of {where} is no array of {self.count} bools")
            if isinstance(value, dict):
                self.check_infos(value, where)
            elif len(np.shape(value)) < 1 or len(value) != self.count:
                self.fault(f"{key} in infos of {where} has no row for each environment")

    def episodes(
        self, seed: Any, actions: Array, check: bool = False, until: Optional[int] = None, masked: bool = True
    ) -> _Run:
        """Resets with this seed and steps by these actions."""
        run = _Run()
        observations, _ = self.reset(seed)
        nothing = np.zeros(self.count, bool)
        run.observations.append(observations.copy())
        run.rewards.append(np.zeros(self.count))
        run.terminations.append(nothing)
        run.truncations.append(nothing)
        is_copied = getattr(self.env, "copy", True)
        for step in range(len(actions) if until is None else until):
            ended = run.ended(-1)
            if self.mode == "DISABLED" and ended.any():
                if not masked:
                    break
                observations, _ = self.reset(None, {"reset_mask": ended.copy()})
            held, was = observations, observations.copy()
            observations, rewards, terminations, truncations, infos = self.step(actions[step])
            if check and is_copied and not np.array_equal(held, was, equal_nan=True):
                self.fault("a step overwrites the observations that were returned before")
            run.observations.append(observations.copy())
            run.rewards.append(rewards.astype(float))
            run.terminations.append(terminations.copy())
            run.truncations.append(truncations.copy())
            if check and self.mode == "SAME_STEP":
                self.check_final(run, infos)
        return run

    @staticmethod
    def same(one: _Run, other: _Run, rows: Any = slice(None), of_other: Any = None) -> bool:
        of_other = rows if of_other is None else of_other
        return len(one.observations) == len(other.observations) and all(
            np.array_equal(a[rows], b[of_other], equal_nan=True)
            for key in ("observations", "rewards", "terminations", "truncations")
            for a, b in zip(getattr(one, key), getattr(other, key))
        )

    # What they should have in common.

    def check_seeds(self, first: _Run) -> None:
        start = first.observations[0]
        if self.count > 1 and all(np.array_equal(start[0], row) for row in start[1:]):
            self.fault("reset(seed=number) gives all environments the same episode")
        again, _ = self.reset(self.seed)
        if not np.array_equal(again, start):
            self.fault("reset with the same seed gives other observations")
        several, _ = self.reset([self.seed + i for i in range(self.count)])
        if not np.array_equal(several, start):
            self.fault("reset(seed=s) differs from reset(seed=[s, s + 1, ...])")
        free, _ = self.reset()
        free, later = free.copy(), self.reset()[0]
        if any(np.array_equal(a, b) for one in (start, later) for a, b in zip(one, free)):
            self.fault("reset without a seed repeats episodes")

    def check_repeats(self, first: _Run) -> None:
        if not self.same(first, self.episodes(self.seed, self.actions)):
            self.fault("the same seed and actions give another run")

    def check_independence(self, first: _Run) -> None:
        changed = self.actions.copy()
        changed[:, 0] = self.other_actions[:, 0]
        other = self.episodes(self.seed, changed, masked=False)
        # Resets by mask draw from one generator in some environments: compared up to the first of them.
        first = first if self.mode != "DISABLED" else self.episodes(self.seed, self.actions, masked=False)
        length = min(len(first.observations), len(other.observations))
        for run in (first, other):
            for key in ("observations", "rewards", "terminations", "truncations"):
                setattr(run, key, getattr(run, key)[:length])
        if not self.same(first, other, slice(1, None)):
            self.fault("the actions of environment 0 change what happens in others")
        if length > 2 and self.same(first, other, slice(0, 1)):
            self.fault("the actions of environment 0 do not change what happens in it")

    def check_order(self, first: _Run) -> None:
        turned = slice(None, None, -1)
        seeds = [self.seed + i for i in range(self.count)]
        straight = self.episodes(seeds, self.actions, masked=False)
        other = self.episodes(seeds[turned], self.actions[:, turned], masked=False)
        if not self.same(straight, other, slice(None), turned):
            self.fault("episodes depend on the order of the environments, not on their seeds and actions alone")

    # What follows the end of an episode.

    def check_next_step(self, first: _Run) -> None:
        last = None
        for step in range(1, len(first.observations)):
            ended = first.ended(step - 1)
            if not ended.any():
                continue
            last = last or step
            if np.any(first.rewards[step][ended] != 0):
                self.fault("NEXT_STEP: the step after an end has a reward, and should only reset")
            if np.any(first.ended(step)[ended]):
                self.fault("NEXT_STEP: the step after an end ends again, and should only reset")
        if last is None:
            return
        # The step that resets ignores its actions.
        actions = self.actions.copy()
        ended = first.ended(last - 1)
        actions[last - 1][ended] = self.other_actions[last - 1][ended]
        other = self.episodes(self.seed, actions, until=last)
        if not np.array_equal(first.observations[last][ended], other.observations[last][ended], equal_nan=True):
            self.fault("NEXT_STEP: the step after an end heeds its actions, and should only reset")
        if np.array_equal(first.observations[last][ended], first.observations[last - 1][ended]):
            self.fault("NEXT_STEP: the step after an end returns the last observation, not that of a reset")

    def check_final(self, run: _Run, infos: Dict[str, Any]) -> None:
        ended = run.ended(-1)
        if not ended.any():
            return
        if "final_obs" not in infos:
            return self.fault("SAME_STEP: infos lack final_obs at an end")
        mask = np.asarray(infos.get("_final_obs", ended))
        if mask.shape == ended.shape and not np.array_equal(mask, ended):
            self.fault("SAME_STEP: the mask _final_obs does not select the environments that ended")
        for row in np.flatnonzero(ended):
            final = np.asarray(infos["final_obs"][row])
            if final.shape != tuple(self.space.shape):
                return self.fault("SAME_STEP: final_obs does not hold an observation for each end")
            if np.array_equal(final, run.observations[-1][row]):
                self.fault("SAME_STEP: the observation at an end is final_obs, not that of a reset")
            elif len(run.observations) > 1 and np.array_equal(final, run.observations[-2][row]):
                self.fault("SAME_STEP: final_obs is the observation before the last step")

    def check_same_step(self, first: _Run) -> None:
        """Found at each end, see check_final()."""

    def check_disabled(self, first: _Run) -> None:
        run = self.episodes(self.seed, self.actions, masked=False)
        ended = run.ended(-1)
        before = run.observations[-1]
        if not ended.any() or ended.all():
            ended = np.arange(self.count) == 0
        after, _ = self.reset(None, {"reset_mask": ended.copy()})
        if not np.array_equal(after[~ended], before[~ended], equal_nan=True):
            self.fault("DISABLED: reset with reset_mask changes environments that it does not select")
        if np.array_equal(after[ended], before[ended]):
            self.fault("DISABLED: reset with reset_mask does not reset the environments that it selects")
        if self.count == 1:
            return
        seeds: List[Optional[int]] = [self.seed + 7 + i for i in range(self.count)]
        seeded, _ = self.reset(seeds, {"reset_mask": ended.copy()})
        fresh, _ = self.reset(seeds)
        if not np.array_equal(seeded[ended], fresh[ended], equal_nan=True):
            self.fault("DISABLED: reset with reset_mask does not heed its seeds")
