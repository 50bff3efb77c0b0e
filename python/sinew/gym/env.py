"""A single environment."""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np

from ..errors import Error
from . import render
from .episode import Episode, checked_actions
from .models import Models
from .spaces import EnvBase
from .task import Task

__all__ = ["Env"]


class Env(EnvBase):
    """A single environment of a task with Gymnasium's interface.

    It behaves like environment 0 of a VectorEnv, bit for bit. Call `reset` after the end of an episode.

    Parameters
    ----------
    task : Task
    render_mode : str, optional
        "rgb_array" or "human": see `render`.

    Attributes
    ----------
    observation_space, action_space : Box
        (size,) and (actions,) of float32; actions in [-1, 1].
    metadata : dict
        "render_modes", "render_fps".

    Raises
    ------
    Error
        unknown-name.
    """

    metadata: dict[str, Any] = {"render_modes": list(render.MODES)}

    def __init__(self, task: Task, *, render_mode: Optional[str] = None) -> None:
        self.task, self.render_mode = task, render.mode_checked(render_mode)
        models = Models(task)
        task.bind(models[0].first)
        self.metadata = {"render_modes": list(render.MODES), "render_fps": round(1.0 / task.time_step)}
        self.observation_space, self.action_space = task.observation_space, task.action_space
        self.episode = Episode(task, models)
        self._seen = np.zeros(self.observation_space.shape, dtype=np.float32)
        self._picture = render.Picture(self.render_mode)
        self._begun, self._open = False, True

    @property
    def np_random(self) -> np.random.Generator:
        """Random generator of the environment, seeded from the operating system until `reset` gets a seed."""
        if self.episode.random is None:
            self.episode.random = np.random.default_rng()
        return self.episode.random

    @np_random.setter
    def np_random(self, value: np.random.Generator) -> None:
        self.episode.random = value

    @property
    def _np_random(self) -> Optional[np.random.Generator]:
        """The name that Gymnasium's checker uses."""
        return self.episode.random

    def reset(self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts an episode.

        Parameters
        ----------
        seed : int, optional
            Not negative. Without it, the generator continues.
        options : dict, optional
            Options of the task, such as "goal".

        Returns
        -------
        observation : (size,) float32
        info : dict

        Raises
        ------
        Error
            out-of-range, unknown-name, wrong-shape.
        """
        self._check("reset")
        if seed is not None and (not isinstance(seed, (int, np.integer)) or seed < 0):
            raise Error("out-of-range", "reset(seed)", f"{seed!r} is not a seed", "give an integer, 0 or more, or None")
        info = self.episode.reset(None if seed is None else int(seed), dict(options or {}))
        self._begun = True
        self.task.sense(self.episode, self._seen)
        self._picture.after_reset(self.episode)
        return self._seen.copy(), info

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Performs an action.

        Parameters
        ----------
        action : (actions,) in [-1, 1]
            Values outside are clipped.

        Returns
        -------
        observation : (size,) float32
        reward : float
        terminated : bool
            Whether the task has ended.
        truncated : bool
            Whether the time limit is reached, or the simulation has failed; info["failure"] then gives the reason.
        info : dict

        Raises
        ------
        Error
            wrong-shape, wrong-type, not-finite; not-reset before a reset and after the end of an episode.
        """
        self._check("step")
        action = checked_actions(action, self.action_space.shape, "step(action)")
        if not self._begun:
            raise Error("not-reset", "step", "no episode has begun, or the last one has ended", "call reset()")
        reward, terminated, truncated, info = self.episode.step(action)
        self._begun = not (terminated or truncated)
        if "failure" not in info:
            self.task.sense(self.episode, self._seen)
        self._picture.after_step(self.episode)
        return self._seen.copy(), float(reward), terminated, truncated, info

    def render(self) -> Optional[np.ndarray]:
        """A picture, (height, width, 3) uint8, if the render mode is "rgb_array"; otherwise None."""
        self._check("render")
        if self.episode.count == 0:
            raise Error("not-reset", "render", "no episode has begun", "call reset()")
        return self._picture.frame(self.episode) if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Closes the environment. May be called repeatedly."""
        if getattr(self, "_open", False):
            self._open = False
            self._picture.close()

    def __repr__(self) -> str:
        return f"Env({self.task.name!r})"

    def _check(self, what: str) -> None:
        if not self._open:
            raise Error("closed", what, "the environment is closed", "make a new one")
