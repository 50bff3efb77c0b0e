"""Episodes whose simulations are stepped by one call."""

from __future__ import annotations

from typing import Any, Optional, Sequence

import numpy as np

from .._core import Batch
from .episode import Episode
from .task import Task

__all__ = ["Together"]

_STATUS = "status"  # status of the last step as a number; 0 is "solved"


class Together:
    """Performs actions in many episodes of a task that names `observables`, with the same bits as Episode.step.

    Native threads step the simulations. Commands, observations and rewards are computed for all episodes at once.

    Parameters
    ----------
    task : Task
    episodes : list of Episode
        Already reset before the first step.
    threads : int
        1 or more.
    """

    def __init__(self, task: Task, episodes: Sequence[Episode], threads: int) -> None:
        self.task, self._episodes, self._threads = task, episodes, threads
        self._names = [*task.observables, _STATUS]
        self._robots: list[Any] = [None] * len(episodes)
        self._batch: Optional[Batch] = None
        self._counts = [0] * len(episodes)  # episodes started, to detect resets
        self._commands, self._actions = np.zeros((2, len(episodes), len(task.low)))

    def step(self, actions: np.ndarray, acts: np.ndarray, observations: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Performs an action in the episodes selected by `acts`.

        Parameters
        ----------
        actions : (n, actions) in [-1, 1]
        acts : (n,) bool
        observations : (n, size) float32
            Overwritten for episodes that act and do not fail.

        Returns
        -------
        rewards, terminations, truncations : (n,)
        infos : dict of arrays (n,) and masks, as in VectorEnv
        """
        task, episodes = self.task, self._episodes
        self._follow_resets()
        self._take(actions, acts)
        self._batch.command(task.kind, self._commands, acts)
        failures = self._batch.step(task.substeps, acts)
        acting = np.flatnonzero(acts).tolist()
        for i in acting:
            episodes[i].steps += 1
        rewards, terminations, truncations = np.zeros(len(episodes)), np.zeros(len(episodes), dtype=bool), np.zeros(len(episodes), dtype=bool)
        infos: dict[str, Any] = {}
        failed = [i for i in acting if failures[i] is not None]
        if failed:
            rewards[failed], truncations[failed] = task.failure_reward, True
            self._tell(infos, "failure", failed, [str(failures[i]) for i in failed], object)
        done = [i for i in acting if failures[i] is None]
        if done:
            read = self._batch.read(self._names)[done]
            chosen = [episodes[i] for i in done]
            observations[done] = self._sensed(chosen, read[:, :-1], observations.dtype)
            rewards[done], terminations[done], told = task.reward_rows(chosen, read[:, :-1], self._actions[done])
            truncations[done] = [episode.steps >= task.episode_steps for episode in chosen]
            for key, values in told.items():
                self._tell(infos, key, done, values, values.dtype)
            reports = [(i, episodes[i].robot.sim.report) for i, status in zip(done, read[:, -1]) if status != 0.0]
            flagged = [(i, report.status) for i, report in reports if report.flagged]
            if flagged:
                self._tell(infos, "flagged", [i for i, _ in flagged], [status for _, status in flagged], object)
        return rewards, terminations, truncations, infos

    def _sensed(self, episodes: Sequence[Episode], read: np.ndarray, kind: Any) -> np.ndarray:
        out = np.empty((len(episodes), *self.task.observation_space.shape), dtype=kind)
        self.task.sense_rows(episodes, read, out)
        return out

    def _tell(self, infos: dict[str, Any], key: str, which: list[int], values: Any, kind: Any) -> None:
        count = len(self._episodes)
        infos[key] = np.full(count, None, dtype=object) if kind is object else np.zeros(count, dtype=kind)
        infos[f"_{key}"] = np.zeros(count, dtype=bool)
        infos[key][which], infos[f"_{key}"][which] = values, True

    def _follow_resets(self) -> None:
        """Takes over the robots and commands of reset episodes, whose commands and actions then become rows of the shared arrays."""
        episodes = self._episodes
        for i, episode in enumerate(episodes):
            if self._counts[i] != episode.count:
                self._counts[i] = episode.count
                self._commands[i], self._actions[i] = episode.commands, episode.action
                episode.commands, episode.action = self._commands[i], self._actions[i]
        robots = [episode.robot for episode in episodes]
        if robots != self._robots:
            self._robots, self._batch = robots, Batch([robot.sim for robot in robots], threads=self._threads)

    def _take(self, actions: np.ndarray, acts: np.ndarray) -> None:
        """Computes the commands of the actions that take effect now."""
        told = acts
        if self.task.action_delay[1] > 0:
            late = [episode.late(action.copy()) if act else None for episode, action, act in zip(self._episodes, actions, acts)]
            told = np.array([action is not None for action in late])
            actions = np.array([self._actions[i] if action is None else action for i, action in enumerate(late)])
        np.copyto(self._actions, actions, where=told[:, None])
        np.copyto(self._commands, self.task.next_commands(self._commands, actions), where=told[:, None])
