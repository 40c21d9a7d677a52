# SPDX-License-Identifier: GPL-3.0-or-later
"""Many worlds of a room for a learner, stepped together: VectorEnv, and Env for one world.

They run ``simrun --vector N --shm NAME`` and share its memory: actions in and observations out are not copied, and a
step is one line through a pipe each way. They have the interface of Gymnasium 1.x, and are its classes where gymnasium
is installed; numpy is enough.
"""

from __future__ import annotations

import contextlib
import enum
import importlib
import json
import math
import mmap
import operator
import os
import secrets
import subprocess
import tempfile
from typing import IO, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from .errors import Error, ToolError
from .filters import Option, Placed, Room, arguments_of, last_line, operands, tool

np: Any = importlib.import_module("numpy")
Array = Any  #: numpy.ndarray
gymnasium: Any
try:
    gymnasium = importlib.import_module("gymnasium")
    importlib.import_module("gymnasium.vector")
except ImportError:
    gymnasium = None


class _PlainMode(enum.Enum):
    """When a world begins its next episode: the values of gymnasium.vector.AutoresetMode."""

    NEXT_STEP = "NextStep"
    SAME_STEP = "SameStep"
    DISABLED = "Disabled"


class _PlainBox:
    """An interval for each number of an array: as much of gymnasium.spaces.Box as learners use."""

    def __init__(self, low: Any, high: Any, shape: Optional[Tuple[int, ...]] = None, dtype: Any = np.float32) -> None:
        self.dtype = np.dtype(dtype)
        self.shape: Tuple[int, ...] = tuple(shape) if shape is not None else np.shape(low)
        self.low: Array = np.broadcast_to(np.asarray(low, self.dtype), self.shape).copy()
        self.high: Array = np.broadcast_to(np.asarray(high, self.dtype), self.shape).copy()
        self._random = np.random.default_rng()

    def seed(self, seed: Optional[int] = None) -> Optional[int]:
        self._random = np.random.default_rng(seed)
        return seed

    def sample(self, mask: None = None, probability: None = None) -> Array:
        return self._random.uniform(self.low, self.high, self.shape).astype(self.dtype)

    def is_bounded(self, manner: str = "both") -> bool:
        below, above = bool(np.all(np.isfinite(self.low))), bool(np.all(np.isfinite(self.high)))
        return {"both": below and above, "below": below, "above": above}[manner]

    def contains(self, x: Any) -> bool:
        x = np.asarray(x)
        if not np.can_cast(x.dtype, self.dtype) or x.shape != self.shape:
            return False
        return bool(np.all(x >= self.low) and np.all(x <= self.high))

    __contains__ = contains

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, _PlainBox) or self.shape != other.shape or self.dtype != other.dtype:
            return False
        return bool(np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high))

    def __repr__(self) -> str:
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"


class _Interface:
    """The attributes that gymnasium's base classes have."""

    metadata: Dict[str, Any] = {"render_modes": []}
    spec = None
    render_mode = None
    _np_random: Any = None
    _np_random_seed: Optional[int] = None

    @property
    def unwrapped(self) -> Any:
        return self

    @property
    def np_random(self) -> Any:
        if self._np_random is None:
            self._np_random = np.random.default_rng()
        return self._np_random

    @property
    def np_random_seed(self) -> Optional[int]:
        return self._np_random_seed

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        raise NotImplementedError


def _plain_batch(space: Any, n: int = 1) -> Any:
    return _PlainBox(np.repeat(space.low[None], n, 0), np.repeat(space.high[None], n, 0), dtype=space.dtype)


_has = gymnasium is not None
AutoresetMode: Any = gymnasium.vector.AutoresetMode if _has else _PlainMode
Box: Any = gymnasium.spaces.Box if _has else _PlainBox
_VectorBase: Any = gymnasium.vector.VectorEnv if _has else _Interface
_EnvBase: Any = gymnasium.Env if _has else _Interface
_batch_space: Any = gymnasium.vector.utils.batch_space if _has else _plain_batch
Task = Union[None, str, "os.PathLike[str]", Mapping[str, Any]]
Rooms = Union[Room, Sequence[Room]]
_WORDS = {"NEXT_STEP": "next_step", "SAME_STEP": "same_step", "DISABLED": "disabled"}


def _mode(mode: Any) -> Any:
    """The AutoresetMode that a word or a value of gymnasium names."""
    text = str(getattr(mode, "name", mode)).replace("-", "").replace("_", "").lower()
    for one in AutoresetMode:
        if one.name.replace("_", "").lower() == text:
            return one
    raise ValueError(f"`{mode}` is no mode of autoreset, wanted one of NEXT_STEP, SAME_STEP and DISABLED")


class _Worlds:
    """A simrun with worlds, and the memory shared with it."""

    def __init__(
        self,
        rooms: Rooms,
        worlds: int,
        layout: Placed,
        task: Task,
        mode: Any,
        options: Mapping[str, Option],
    ) -> None:
        self._process: Optional[subprocess.Popen[bytes]] = None
        self._errors: IO[bytes] = tempfile.TemporaryFile()
        self._context = contextlib.ExitStack()
        name = f"ispace-{os.getpid()}-{secrets.token_hex(8)}"
        try:
            several = [rooms] if isinstance(rooms, (str, os.PathLike)) else list(rooms)
            if not several:
                raise ValueError("VectorEnv wants a room, or a list of rooms")
            words = self._context.enter_context(operands(several[0], layout))
            words += arguments_of({"vector": operator.index(worlds), "shm": name, "autoreset": _WORDS[mode.name]})
            words += arguments_of({"room": several[1:], "task": self._task_file(task), **options})
            self._process = subprocess.Popen(
                [tool("simrun"), *words],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                start_new_session=True,  # Ctrl-C is for the program; this ends it then
                bufsize=0,
            )
            self._rest = b""
            self._owed = False  # a reply
            self.facts: Dict[str, Any] = json.loads(self._line())
            path = f"/dev/shm/{name}"
            file = os.open(path, os.O_RDWR)
            try:
                self._memory = mmap.mmap(file, 0)
            finally:
                os.close(file)
                os.unlink(path)  # both have it; no end of either leaves it behind
            for key, array in self.facts["arrays"].items():
                view: Array = np.ndarray(array["shape"], array["type"], self._memory, array["offset"])
                setattr(self, key, view)
        except BaseException:
            self.close()
            raise

    actions: Array
    observations: Array
    final_observations: Array
    rewards: Array
    terminations: Array
    truncations: Array
    successes: Array
    collisions: Array
    returns: Array
    lengths: Array
    poses: Array
    goals: Array
    seeds: Array
    masks: Array

    def _task_file(self, task: Task) -> Union[None, str, "os.PathLike[str]"]:
        if not isinstance(task, Mapping):
            return task
        folder = self._context.enter_context(tempfile.TemporaryDirectory(prefix="ispace."))
        path = os.path.join(folder, "task.yaml")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(task, file)  # JSON is YAML
        return path

    def _line(self) -> str:
        assert self._process is not None and self._process.stdout is not None
        out = self._process.stdout.fileno()
        while b"\n" not in self._rest:
            more = os.read(out, 65536)
            if not more:
                status = self._process.wait()
                text = os.pread(self._errors.fileno(), 1 << 20, 0).decode(errors="replace")
                raise ToolError(last_line(text), status)
            self._rest += more
        line, _, self._rest = self._rest.partition(b"\n")
        return line.decode()

    def finish(self) -> None:
        """Waits for the reply of a request if an exception, of a signal, ended the wait for it."""
        if self._process is not None and self._owed:
            self._line()
            self._owed = False

    def ask(self, request: str) -> str:
        """Sends a request, and waits for what follows ``ok`` of its reply."""
        self.finish()
        if self._process is None or self._process.stdin is None:
            raise Error("the environment is closed")
        if "\n" in request:
            raise ValueError(f"a request is one line, not {request!r}")
        try:
            os.write(self._process.stdin.fileno(), os.fsencode(request) + b"\n")
        except BrokenPipeError:
            pass  # its last words say why
        self._owed = True
        line = self._line()
        self._owed = False
        if line.startswith("ok"):
            return line[3:]
        raise Error(line[len("error ") :] if line.startswith("error ") else line)

    def close(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    pipe.close()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self._errors.close()
        self._context.close()


def _spaces(facts: Mapping[str, Any]) -> Tuple[Any, Any]:
    """The spaces of one observation and one action."""
    beams, width = facts["beams"], facts["observation"]
    low = np.zeros(width, np.float32)
    high = np.full(width, facts["max_range"], np.float32)
    tail = [(0, facts["max_distance"]), (-math.pi, math.pi)]
    tail += [(-facts["max_speed"], facts["max_speed"]), (-facts["max_turn"], facts["max_turn"])]
    tail += [(-math.pi, math.pi)] * (width - beams - len(tail))
    for i, (least, most) in enumerate(tail):
        low[beams + i], high[beams + i] = least, most
    return Box(low, high, dtype=np.float32), Box(-1, 1, (2,), np.float32)


def _with(task: Task, key: str, value: Optional[int]) -> Task:
    if value is None:
        return task
    if task is not None and not isinstance(task, Mapping):
        raise ValueError(f"give {key} in the task file, or the task as a dict")
    return {**(task or {}), key: value}


class VectorEnv(_VectorBase):  # type: ignore[misc]
    """Worlds of a room, or of several, as one batch.

    ::

        env = ispace.VectorEnv("office.env", num_envs=256, people=10)
        observations, infos = env.reset(seed=1)
        for _ in range(1000):
            observations, rewards, terminations, truncations, infos = env.step(policy(observations))

    An observation is the ranges of the laser in metres (the maximum range without a return), distance (m) and bearing
    (rad) of the goal, speed (m/s) and rate of turning (rad/s); an action is speed and rate of turning in [-1, 1] of
    the robot's maximum. ``num_envs`` counts worlds; each robot of a world has its row, and the attribute of that name
    counts rows. ``task`` is a file or a dict, see simrun(1).

    An episode depends on its seed and its actions alone: neither on the number of worlds, nor on their order, nor on
    threads.

    What reset and step return are copies, unless ``copy`` is False: then observations are views of shared memory,
    valid until the step after the next one, and all else until the next. ``env.actions`` and ``env.observations`` are
    the shared arrays themselves: a program may write the ones in place, and wrap them by DLPack for torch.
    """

    def __init__(
        self,
        room: Rooms,
        num_envs: int = 1,
        *,
        layout: Placed = None,
        task: Task = None,
        people: Optional[int] = None,
        robots: Optional[int] = None,
        autoreset_mode: Any = "NEXT_STEP",
        copy: bool = True,
        **options: Option,
    ) -> None:
        mode = _mode(autoreset_mode)
        self._worlds = _Worlds(
            room, num_envs, layout, _with(task, "robots", robots), mode, {"people": people, **options}
        )
        facts = self._worlds.facts
        self.copy = copy
        self.closed = False
        self.num_envs: int = facts["num_envs"]
        self.dt: float = facts["dt"]  #: seconds of a step
        self.robots: int = facts["robots"]  #: of a world
        self.metadata = {"render_modes": [], "autoreset_mode": mode}
        self.single_observation_space, self.single_action_space = _spaces(facts)
        self.observation_space = _batch_space(self.single_observation_space, self.num_envs)
        self.action_space = _batch_space(self.single_action_space, self.num_envs)
        self._half = 0
        self._is_seeded = False
        self._same_step = mode.name == "SAME_STEP"

    @property
    def actions(self) -> Array:
        """The shared actions, (num_envs, 2)."""
        return self._worlds.actions

    @property
    def observations(self) -> Array:
        """The shared observations of the last step."""
        return self._worlds.observations[self._half]

    @property
    def poses(self) -> Array:
        """The true poses of the robots: x, y, heading (rad)."""
        return self._worlds.poses

    @property
    def goals(self) -> Array:
        """The goals of the robots: x, y."""
        return self._worlds.goals

    @property
    def pid(self) -> Optional[int]:
        """The process of simrun; None once it has ended."""
        process = self._worlds._process
        return process.pid if process is not None else None

    @property
    def bytes_of_world(self) -> int:
        """Memory of a world besides what all share, on average."""
        return int(self._worlds.ask("memory"))

    def reset(
        self,
        *,
        seed: Union[None, int, Sequence[Optional[int]]] = None,
        options: Optional[Dict[str, Any]] = None,
    ) -> Tuple[Array, Dict[str, Any]]:
        """Begins episodes: with a seed those of seed, seed + 1, ..., without one the next ones.

        ``options={"reset_mask": mask}`` selects rows; worlds reset as a whole.
        """
        count = self.num_envs // self.robots
        seeds: List[Optional[int]]
        if seed is None and not self._is_seeded:
            seed = secrets.randbits(32)
        if seed is None:
            seeds = [None] * count
        elif isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + i for i in range(count)]
        else:
            seeds = [None if one is None else int(one) for one in seed]
            if len(seeds) == self.num_envs:
                seeds = seeds[:: self.robots]
            if len(seeds) != count:
                raise ValueError(f"{len(seeds)} seeds for {count} worlds")
        first = next((one for one in seeds if one is not None), None)
        if first is not None:
            self._np_random = np.random.default_rng(first % 2**64)
            self._np_random_seed = first
        self._is_seeded = True
        worlds = self._worlds
        worlds.finish()
        worlds.masks[:] = [1 if one is None else 2 for one in seeds]
        worlds.seeds[:] = np.array([(one or 0) % 2**64 for one in seeds], np.uint64)
        mask = (options or {}).get("reset_mask")
        if mask is not None:
            mask = np.asarray(mask)
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_:
                raise ValueError(f"reset_mask is an array of {self.num_envs} bools")
            if not mask.any():
                raise ValueError("reset_mask selects no row")
            worlds.masks[~mask.reshape(count, self.robots).any(1)] = 0
        self._half = int(worlds.ask("reset"))
        return self._given(self.observations), {}

    def step(
        self, actions: Any
    ) -> Tuple[Array, Array, Array, Array, Dict[str, Any]]:
        """Steps all worlds; what follows an end is up to ``autoreset_mode``."""
        worlds = self._worlds
        worlds.finish()
        if actions is not worlds.actions:
            given = np.asarray(actions)
            if given.shape != worlds.actions.shape:
                raise ValueError(f"actions have the shape {given.shape}, not {worlds.actions.shape}")
            np.copyto(worlds.actions, given, casting="same_kind")
        self._half = int(worlds.ask("step"))
        return (
            self._given(self.observations),
            self._given(worlds.rewards),
            self._given(worlds.terminations),
            self._given(worlds.truncations),
            self._infos(),
        )

    def _given(self, array: Array) -> Array:
        return array.copy() if self.copy else array

    def _infos(self) -> Dict[str, Any]:
        worlds = self._worlds
        ended = worlds.terminations | worlds.truncations
        if not ended.any():
            return {}
        infos: Dict[str, Any] = {}
        for key, values in (("success", worlds.successes), ("collision", worlds.collisions)):
            infos[key], infos["_" + key] = values & ended, ended.copy()
        returns, lengths = np.where(ended, worlds.returns, 0), np.where(ended, worlds.lengths, 0)
        infos["episode"] = {"r": returns, "_r": ended.copy(), "l": lengths, "_l": ended.copy()}
        infos["_episode"] = ended.copy()
        if self._same_step:
            infos["final_info"] = dict(infos)
            infos["_final_info"] = ended.copy()
            infos["final_obs"] = np.where(ended[:, None], worlds.final_observations, np.float32(0))
            infos["_final_obs"] = ended.copy()
        return infos

    def export(self, row: int, folder: Union[str, "os.PathLike[str]"]) -> str:
        """Writes the present episode of a row's world, up to now, as room, layout and script into a folder.

        Returns the command of simrun that repeats it there, to which ``--record`` adds a record.
        """
        return self._worlds.ask(f"export {int(row)} {os.path.abspath(os.fsdecode(folder))}")

    def render(self) -> None:
        """No picture: export() an episode and film it."""
        return None

    def close(self, **_: Any) -> None:
        """Ends simrun."""
        self.closed = True
        self._worlds.close()

    def close_extras(self, **_: Any) -> None:
        """As close(), which gymnasium's base class calls."""
        self.close()

    def __del__(self) -> None:
        if "_worlds" in self.__dict__:
            self._worlds.close()

    def __repr__(self) -> str:
        return f"{type(self).__name__}(num_envs={self.num_envs})"


class Env(_EnvBase):  # type: ignore[misc]
    """One world of one robot: VectorEnv's observations and actions, without the leading dimension."""

    metadata: Dict[str, Any] = {"render_modes": []}

    def __init__(self, room: Rooms, **options: Any) -> None:
        self._batch = VectorEnv(room, 1, autoreset_mode="DISABLED", copy=False, **options)
        if self._batch.num_envs != 1:
            self._batch.close()
            raise ValueError("Env has one robot; VectorEnv has worlds of several")
        self.observation_space = self._batch.single_observation_space
        self.action_space = self._batch.single_action_space
        self.dt = self._batch.dt
        self.render_mode = None

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[Array, Dict[str, Any]]:
        """Begins an episode: the first of the seed, or without one the next."""
        if gymnasium is not None:
            super().reset(seed=seed)
        elif seed is not None:
            self._np_random, self._np_random_seed = np.random.default_rng(seed), seed
        observations, _ = self._batch.reset(seed=seed)
        return observations[0].copy(), {}

    def step(self, action: Any) -> Tuple[Array, float, bool, bool, Dict[str, Any]]:
        """Steps the world; after an end it waits for reset()."""
        observations, rewards, terminations, truncations, _ = self._batch.step(np.asarray(action)[None])
        worlds = self._batch._worlds
        info = {"success": bool(worlds.successes[0]), "collision": bool(worlds.collisions[0])}
        return observations[0].copy(), float(rewards[0]), bool(terminations[0]), bool(truncations[0]), info

    def export(self, folder: Union[str, "os.PathLike[str]"]) -> str:
        """As VectorEnv.export()."""
        return self._batch.export(0, folder)

    def render(self) -> None:
        """No picture: export() an episode and film it."""
        return None

    def close(self) -> None:
        """Ends simrun."""
        self._batch.close()
