"""State of one environment: its generator, its robot and the progress of its episode."""

from __future__ import annotations

from collections import deque
from typing import Any, Mapping, Optional

import numpy as np

from ..errors import Error, RunError
from .models import Models, Robot, TaskModel
from .task import Task, unknown

__all__ = ["Episode"]


class Episode:
    """One environment of a task, from reset to reset.

    All random numbers come from its own generator, so results depend neither on other environments nor on threads.

    Attributes
    ----------
    task : Task
    random : numpy.random.Generator
    model : TaskModel
        Model of the current episode.
    robot : Robot
        The simulation, a clone of the model's.
    goal : (3,) m or None
        Goal of the tip.
    steps : int
        Actions since the reset.
    commands : (actions,)
        Commands of the last step, in the unit of the task's action.
    action : (actions,)
        Last action that took effect, in [-1, 1].
    count : int
        Number of episodes started.
    """

    def __init__(self, task: Task, models: Models) -> None:
        self.task, self._models = task, models
        self.random: Optional[np.random.Generator] = None
        self.model: TaskModel = models[0]
        self.robot: Optional[Robot] = None
        self.goal: Optional[np.ndarray] = None
        self.memory: dict[str, Any] = {}  # data of the task
        self.steps = self.count = 0
        self.commands = self.action = np.zeros(len(task.low))
        self._late: deque[np.ndarray] = deque()

    def reset(self, seed: Optional[int], options: Mapping[str, Any]) -> dict[str, Any]:
        """Starts an episode and returns its info.

        Parameters
        ----------
        seed : int or None
            Seeds the generator. Without it, the generator continues, or is seeded from the operating system.
        options : dict
            Names of Task.options with their values.
        """
        if seed is not None or self.random is None:
            self.random = np.random.default_rng(seed)
        for name in options:
            if name not in self.task.options:
                raise unknown("reset(options)", f"option of {self.task.name}", name, list(self.task.options) or ["reset_mask"])
        model = self._models[int(self.random.integers(len(self._models)))] if len(self._models) > 1 else self._models[0]
        self._put(model)
        starts = model.starts
        robot = self.robot
        robot.sim.restore(starts[int(self.random.integers(len(starts)))] if len(starts) > 1 else starts[0])
        low, high = self.task.action_delay
        delay = int(self.random.integers(low, high + 1)) if high > low else low
        self.steps, self.count = 0, self.count + 1
        self.commands = self.task.commanded(robot)
        self.action = np.zeros(len(self.commands))
        self._late = deque([None] * delay)
        self.task.begin(self, options)
        return dict(model.drawn) if self.task.is_randomised else {}

    def step(self, action: np.ndarray) -> tuple[float, bool, bool, dict[str, Any]]:
        """Performs an action and returns reward, terminated, truncated and info."""
        task, robot = self.task, self.robot
        acting = self.late(action)
        if acting is not None:
            self.action = acting
            self.commands = task.commands(self, acting)
        task.apply(self)
        task.disturb(self)
        self.steps += 1
        try:
            robot.sim.step(task.substeps)
        except RunError as error:
            return task.failure_reward, False, True, {"failure": str(error)}
        reward, over, info = task.reward(self)
        report = robot.sim.report
        if report.flagged:
            info["flagged"] = report.status
        return reward, over, self.steps >= task.episode_steps, info

    def late(self, action: np.ndarray) -> Optional[np.ndarray]:
        """Stores an action and returns the one that takes effect now; None before the first one does."""
        self._late.append(action)
        return self._late.popleft()

    def release(self) -> None:
        """Returns the robot to its model."""
        if self.robot is not None:
            self.model.give_back(self.robot)
            self.robot = None

    def _put(self, model: TaskModel) -> None:
        """Takes a robot of this model."""
        if self.robot is None or model is not self.model:
            self.release()
            self.model, self.robot = model, model.take()


def checked_actions(actions: Any, shape: tuple[int, ...], place: str) -> np.ndarray:
    """Returns the actions as an array of the given shape, clipped to [-1, 1].

    Raises
    ------
    Error
        wrong-type, wrong-shape, or not-finite, which names the first entry that is NaN.
    """
    try:
        given = np.asarray(actions, dtype=float)
    except (TypeError, ValueError):
        raise Error("wrong-type", place, f"{actions!r} are not numbers", f"give an array of shape {shape}") from None
    if given.shape != shape:
        raise Error("wrong-shape", place, f"the actions have shape {given.shape}", f"give an array of shape {shape}, the action space's")
    if np.isnan(given).any():
        at = tuple(int(i) for i in np.argwhere(np.isnan(given))[0])
        raise Error("not-finite", place, f"the action at {list(at)} is NaN", "check the policy that computed it")
    return np.clip(given, -1.0, 1.0)
