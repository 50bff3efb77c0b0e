"""Many environments of a task in one process."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from . import render
from .episode import Episode, checked_actions
from .models import Models
from .spaces import AutoresetMode, VectorEnvBase, batched, mode_named
from .task import Task
from .together import Together

__all__ = ["VectorEnv"]

Arrays = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]


class VectorEnv(VectorEnvBase):
    """Steps many environments of a task in threads; Gymnasium's vector interface.

    The environments share the models of the task (mesh, material, factorisation plan); each has its own simulation. Steps of the
    simulation release the interpreter lock, so threads run in parallel. Each thread has a contiguous block of environments. The
    simulations of a task with `observables` are stepped by one call (Together). Results are the same, bit for bit, for any number
    of threads, and for an environment alone or among others: environment i has its own generator, seeded with s + i.

    Parameters
    ----------
    task : Task
    num_envs : int
        1 or more.
    threads : int
        1 or more.
    autoreset_mode : AutoresetMode or str
        Treatment of an environment whose episode ends in step k.
        NEXT_STEP: step k + 1 resets it instead of performing the action, with reward 0.
        SAME_STEP: step k resets it; the last observation and info are in infos["final_obs"] and infos["final_info"].
        DISABLED: nothing happens; call reset(options={"reset_mask": mask}).
    render_mode : str, optional
        "rgb_array" or "human": see `render`.

    Attributes
    ----------
    num_envs : int
    single_observation_space, single_action_space : Box
        Of one environment, float32.
    observation_space, action_space : Box
        Of all environments, stacked: (num_envs, size).
    metadata : dict
        "render_modes" and "autoreset_mode".

    Raises
    ------
    Error
        out-of-range, unknown-name.
    """

    metadata: dict[str, Any] = {"render_modes": list(render.MODES)}

    def __init__(
        self,
        task: Task,
        num_envs: int = 1,
        *,
        threads: int = 1,
        autoreset_mode: Union[str, Any] = AutoresetMode.NEXT_STEP,
        render_mode: Optional[str] = None,
    ) -> None:
        for item, value in (("num_envs", num_envs), ("threads", threads)):
            if value != int(value) or value < 1:
                raise Error("out-of-range", item, f"it is {value}", "give a whole number, 1 or more")
        self.task, self.num_envs, self.threads = task, int(num_envs), min(int(threads), int(num_envs))
        self.render_mode = render.mode_checked(render_mode)
        self.autoreset_mode = mode_named(autoreset_mode)
        models = Models(task)
        task.bind(models[0].first)
        self.metadata = {"render_modes": list(render.MODES), "render_fps": round(1.0 / task.time_step),
                         "autoreset_mode": self.autoreset_mode}  # fmt: skip
        self.single_observation_space, self.single_action_space = task.observation_space, task.action_space
        self.observation_space, self.action_space = (batched(s, self.num_envs) for s in (task.observation_space, task.action_space))
        self.episodes = [Episode(task, models) for _ in range(self.num_envs)]
        self._together = Together(task, self.episodes, self.threads) if task.observables else None
        edges = np.linspace(0, self.num_envs, self.threads + 1).astype(int)
        self._blocks = [range(first, last) for first, last in zip(edges[:-1], edges[1:])]
        self._executor = ThreadPoolExecutor(self.threads - 1) if self.threads > 1 else None
        self._observations = np.zeros((self.num_envs, *self.single_observation_space.shape), dtype=np.float32)
        self._begun, self._ended = np.zeros(self.num_envs, dtype=bool), np.zeros(self.num_envs, dtype=bool)
        self._picture = render.Picture(self.render_mode)
        self._open = True

    def reset(
        self, *, seed: Union[int, Sequence[Optional[int]], None] = None, options: Optional[Mapping[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts episodes.

        Parameters
        ----------
        seed : int or list of int, optional
            A number s seeds environment i with s + i; a list has a seed, or None, for each. Without a seed, the generators continue.
        options : dict, optional
            "reset_mask": (num_envs,) bool, the environments to reset; all by default. Options of the task, such as "goal": a value
            for all environments, or an array with one more axis, a row for each.

        Returns
        -------
        observations : (num_envs, size) float32
            Of all environments, including those that were not reset.
        infos : dict of arrays

        Raises
        ------
        Error
            wrong-length, wrong-shape, wrong-type, unknown-name, out-of-range.
        """
        self._check_open("reset")
        options = dict(options or {})
        mask = self._mask(options.pop("reset_mask", None))
        seeds = self._seeds(seed)
        infos: list[dict[str, Any]] = [{} for _ in self.episodes]

        def work(i: int) -> None:
            if mask[i]:
                infos[i] = self.episodes[i].reset(seeds[i], self._options_of(i, options))
                self.task.sense(self.episodes[i], self._observations[i])

        self._begun[mask], self._ended[mask] = False, False  # after an error, they count as not reset
        self._each(work)
        self._begun |= mask
        self._picture.after_reset(self.episodes[0])
        return self._observations.copy(), self._gather(infos)

    def step(self, actions: Any) -> Arrays:
        """Performs an action in every environment.

        Parameters
        ----------
        actions : (num_envs, actions) in [-1, 1]
            Values outside are clipped.

        Returns
        -------
        observations : (num_envs, size) float32
        rewards : (num_envs,) float64
        terminations : (num_envs,) bool
            Whether the task has ended.
        truncations : (num_envs,) bool
            Whether the time limit is reached, or the simulation has failed; infos["failure"] then gives the reason, and the
            observation is the previous one.
        infos : dict of arrays
            infos["x"][i] belongs to environment i where infos["_x"][i] is true.

        Raises
        ------
        Error
            wrong-shape, wrong-type, not-finite; not-reset before a reset, and in the mode DISABLED if an episode has ended.
        """
        self._check_open("step")
        actions = checked_actions(actions, self.action_space.shape, "step(actions)")
        self._check_begun()
        take = self._step_each if self._together is None else self._step_together
        rewards, terminations, truncations, infos = take(actions)
        if self.autoreset_mode is not AutoresetMode.SAME_STEP:
            self._ended = terminations | truncations
        self._picture.after_step(self.episodes[0])
        return self._observations.copy(), rewards, terminations, truncations, infos

    def render(self) -> Any:
        """Pictures of all environments, (height, width, 3) uint8 each, if the render mode is "rgb_array"; otherwise None."""
        self._check_open("render")
        self._check_begun(ended=True)
        return tuple(self._picture.frame(episode) for episode in self.episodes) if self.render_mode == "rgb_array" else None

    def close(self, **kwargs: Any) -> None:
        """Ends the threads and releases the simulations. May be called repeatedly."""
        if getattr(self, "_open", False):
            self._open = False
            if self._executor is not None:
                self._executor.shutdown()
            self._picture.close()
            self.episodes = []
        self.closed = True

    @property
    def memory(self) -> int:
        """Memory of an environment's simulation between steps without the shared model, bytes. Call `reset` first."""
        self._check_begun(ended=True)
        return self.episodes[0].robot.sim.memory

    def __repr__(self) -> str:
        return f"VectorEnv({self.task.name!r}, num_envs={self.num_envs}, threads={self.threads}, {self.autoreset_mode.name})"

    def _step_each(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Steps the environments of each thread one after the other."""
        count = self.num_envs
        rewards, terminations, truncations = np.zeros(count), np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
        infos: list[dict[str, Any]] = [{} for _ in range(count)]
        same_step, sense = self.autoreset_mode is AutoresetMode.SAME_STEP, self.task.sense

        def work(i: int) -> None:
            episode, seen = self.episodes[i], self._observations[i]
            if self._ended[i]:  # only in the mode NEXT_STEP
                infos[i] = episode.reset(None, {})
                sense(episode, seen)
                return
            rewards[i], terminations[i], truncations[i], infos[i] = episode.step(actions[i])
            if "failure" not in infos[i]:
                sense(episode, seen)
            if same_step and (terminations[i] or truncations[i]):
                last = {"final_obs": seen.copy(), "final_info": infos[i]}
                infos[i] = {**last, **episode.reset(None, {})}
                sense(episode, seen)

        self._each(work)
        return rewards, terminations, truncations, self._gather(infos)

    def _step_together(self, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Steps all simulations at once; resets them one after the other, which takes microseconds each."""
        rewards, terminations, truncations, infos = self._together.step(actions, ~self._ended, self._observations)
        same_step = self.autoreset_mode is AutoresetMode.SAME_STEP
        ended = np.flatnonzero(terminations | truncations if same_step else self._ended).tolist()
        last: list[dict[str, Any]] = [{} for _ in ended]
        if same_step:
            last = [{"final_obs": self._observations[i].copy(), "final_info": self._taken(infos, i)} for i in ended]
        for i, final in zip(ended, last):
            self._add(infos, {**final, **self.episodes[i].reset(None, {})}, i)
            self.task.sense(self.episodes[i], self._observations[i])
        return rewards, terminations, truncations, infos

    @staticmethod
    def _taken(infos: dict[str, Any], i: int) -> dict[str, Any]:
        """Removes the info of one environment from the infos of all, with keys that no other environment has."""
        taken: dict[str, Any] = {}
        for key in [key for key in infos if f"_{key}" in infos and infos[f"_{key}"][i]]:
            values, mask = infos[key], infos[f"_{key}"]
            taken[key] = values[i] if values.dtype == object else values[i].item()
            values[i], mask[i] = None if values.dtype == object else 0, False
            if not mask.any():
                del infos[key], infos[f"_{key}"]
        return taken

    def _each(self, work: Callable[[int], None]) -> None:
        """Calls work(i) for every environment, one block per thread; the first block in this thread."""

        def block(indices: range) -> None:
            for i in indices:
                work(i)

        others = [self._executor.submit(block, indices) for indices in self._blocks[1:]] if self._executor else []
        try:
            block(self._blocks[0])
        finally:  # waits for all threads, also if this one raises
            raised = [future.exception() for future in others]
        for error in raised:
            if error is not None:
                raise error

    def _gather(self, infos: list[dict[str, Any]]) -> dict[str, Any]:
        """Infos of the environments as a dict of arrays, with a mask "_x" for every "x"."""
        gathered: dict[str, Any] = {}
        for i, info in enumerate(infos):
            self._add(gathered, info, i)
        return gathered

    def _add(self, gathered: dict[str, Any], info: Mapping[str, Any], i: int) -> None:
        for key, value in info.items():
            if f"_{key}" not in gathered:
                gathered[key], gathered[f"_{key}"] = self._empty(key, value), np.zeros(self.num_envs, dtype=bool)
            if isinstance(value, dict):
                self._add(gathered[key], value, i)
            else:
                gathered[key][i] = value
            gathered[f"_{key}"][i] = True

    def _empty(self, key: str, value: Any) -> Any:
        """Storage for the values of all environments, as in Gymnasium: numbers in arrays, arrays stacked, everything else as objects."""
        if isinstance(value, dict):
            return {}
        if isinstance(value, np.ndarray) and key != "final_obs":
            return np.zeros((self.num_envs, *value.shape), dtype=value.dtype)
        if isinstance(value, (bool, int, float, np.number)):
            return np.zeros(self.num_envs, dtype=type(value))
        return np.full(self.num_envs, None, dtype=object)

    def _seeds(self, seed: Any) -> list[Optional[int]]:
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, (int, np.integer)):
            seeds: list[Any] = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise Error("wrong-length", "reset(seed)", f"{len(seeds)} seeds for {self.num_envs} environments",
                        "give one for each, or one integer")
        for one in seeds:
            if one is not None and (not isinstance(one, (int, np.integer)) or one < 0):
                raise Error("out-of-range", "reset(seed)", f"{one!r} is not a seed", "give integers, 0 or more, or None")
        return [None if one is None else int(one) for one in seeds]

    def _mask(self, mask: Any) -> np.ndarray:
        if mask is None:
            return np.ones(self.num_envs, dtype=bool)
        given = np.asarray(mask)
        if given.dtype != bool or given.shape != (self.num_envs,):
            raise Error("wrong-shape", "reset(options)", f"the reset_mask has shape {given.shape} and type {given.dtype}",
                        f"give an array of {self.num_envs} bools")
        if not given.any():
            raise Error("out-of-range", "reset(options)", "the reset_mask chooses no environment", "give at least one True")
        return given

    def _options_of(self, i: int, options: Mapping[str, Any]) -> dict[str, Any]:
        """Options of one environment: rows of arrays that have one more axis than a value; other values unchanged."""
        rows = {}
        for name, value in options.items():
            if np.ndim(value) == self.task.options.get(name, np.inf) + 1:
                if len(value) != self.num_envs:
                    raise Error("wrong-length", "reset(options)", f"{name} has {len(value)} rows for {self.num_envs} environments",
                                "give a row for each")
                value = value[i]
            rows[name] = value
        return rows

    def _check_open(self, what: str) -> None:
        if not self._open:
            raise Error("closed", what, "the environment is closed", "make a new one")

    def _check_begun(self, ended: bool = False) -> None:
        """Raises not-reset if an environment was not reset, or, in the mode DISABLED, if its episode has ended."""
        waiting = ~self._begun
        if self.autoreset_mode is AutoresetMode.DISABLED and not ended:
            waiting = waiting | self._ended
        if waiting.any():
            which = np.flatnonzero(waiting)
            shown = ", ".join(str(i) for i in which[:8]) + (", ..." if len(which) > 8 else "")
            raise Error("not-reset", "step", f"these environments have not begun an episode: {shown}",
                        'call reset(), or reset(options={"reset_mask": mask}) for these')
