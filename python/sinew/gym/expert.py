"""Expert policies, based on the inverse controller or on a script."""

from __future__ import annotations

from typing import Any, Union

import numpy as np

from .._core import InverseController
from ..errors import Error
from .env import Env
from .models import Robot
from .registry import _TASKS
from .task import Task
from .tasks import TrunkFollow, TrunkHold, TrunkReach
from .vector_env import VectorEnv

__all__ = ["Expert", "expert"]

_CONTROLLED = (TrunkReach, TrunkFollow, TrunkHold)
_CORRECTION = 0.5  # fraction of a change of the offset between the tips that is taken up per step


def _has_script(task: type[Task]) -> bool:
    return task.scripted is not Task.scripted


class _Twin:
    """A copy of the nominal robot under an inverse controller, for one environment."""

    def __init__(self, episode: Any) -> None:
        self.episode = episode
        self.robot = Robot(episode.model.first.sim.clone())
        self.controller: Any = None
        self.count = 0

    def action(self) -> np.ndarray:
        """Tension increments of the twin, in [-1, 1]."""
        episode, robot = self.episode, self.robot
        if self.count != episode.count:
            self.count, self.missed = episode.count, np.zeros(3)
            robot.sim.restore(episode.model.starts[0])
        else:
            self.missed += _CORRECTION * (robot.tip.position - episode.robot.tip.position - self.missed)
        goal = episode.task.goal_at(episode, (episode.steps + 1) * episode.task.time_step) if self.moving else episode.goal
        target = (goal + self.missed).tolist()
        if self.controller is None:
            self.controller = InverseController(robot.sim, targets={next(iter(robot.sim.effectors)): target})
        else:
            self.controller.targets["tip"] = target
        self.controller.step()
        wanted = np.array([actuator.tension for actuator in robot.actuators])
        return np.clip((wanted - episode.commands) / episode.task.increment, -1.0, 1.0)

    @property
    def moving(self) -> bool:
        """Whether the goal moves."""
        return isinstance(self.episode.task, TrunkFollow)


class _Script:
    """The task's own scripted policy, for one environment."""

    def __init__(self, episode: Any) -> None:
        self.episode = episode

    def action(self) -> np.ndarray:
        """Returns the action of Task.scripted."""
        return self.episode.task.scripted(self.episode)


class Expert:
    """Policy by the inverse controller or by a script; created by `expert`.

    **Trunks.** Every environment has a twin, a simulation of its robot without pushes and delays, whose inverse controller moves
    the tip to the goal. The action is the change of tensions of the twin. The twin's target is the goal plus the offset of its
    tip from that of the environment, which is filtered: every step takes up half of a change. The policy therefore responds to
    pushes, which the twin does not feel.

    **Grasp.** The script pulls every cable in by 8 mm within 0.8 s, then moves the feet by the missing height of the cup.

    **Crawl.** The script is the open-loop gait, sinew.gym.tasks.crawl.gait: front legs, trunk and rear legs fill one after the
    other and empty in the same order, in 2 s.

    **Damp.** The script pulls a cable while it lengthens, in proportion to its rate.

    **Swing-up.** All torques follow the angular rate of the whole arm, so each swing gains energy.
    """

    def __init__(self, env: Union[Env, VectorEnv]) -> None:
        self._single = isinstance(env, Env)
        episodes = [env.episode] if self._single else env.episodes
        kind = _Script if _has_script(type(env.task)) else _Twin
        self._each = [kind(episode) for episode in episodes]

    def __call__(self, observation: Any = None) -> np.ndarray:
        """Actions for the present state of the environment.

        Parameters
        ----------
        observation : array, optional
            Not used: the expert reads the environment itself.

        Returns
        -------
        (actions,) or (num_envs, actions) float32 in [-1, 1]
        """
        actions = np.array([each.action() for each in self._each], dtype=np.float32)
        return actions[0] if self._single else actions


def expert(env: Union[Env, VectorEnv]) -> Expert:
    """A policy that solves a task by the inverse controller or by a script.

    Parameters
    ----------
    env : Env or VectorEnv
        An environment of trunk-reach, trunk-follow or trunk-hold, with the action "tension-increment" and without randomised
        models; or of trunk-damp, arm-swing-up, grasp, crawl or any task that overrides Task.scripted, with the task's first
        action.

    Returns
    -------
    Expert

    Raises
    ------
    Error
        bad-argument for another task or action, or for randomised models.

    Examples
    --------
    >>> env = sinew.gym.make("trunk-reach")
    >>> observation, info = env.reset(seed=1)
    >>> policy = sinew.gym.expert(env)
    >>> observation, reward, terminated, truncated, info = env.step(policy(observation))
    """
    env = env.unwrapped
    task = env.task
    if not isinstance(task, _CONTROLLED) and not _has_script(type(task)):
        known = ", ".join(each.name for each in _TASKS.values() if issubclass(each, _CONTROLLED) or _has_script(each))
        raise Error("bad-argument", "expert(env)", f"there is no expert for {task.name}",
                    f"give one of: {known}; or a task of your own that has scripted()")
    if task.action != task.actions[0] or (task.is_randomised and isinstance(task, _CONTROLLED)):
        without = " and without ranges of material_scale and payload" if isinstance(task, _CONTROLLED) else ""
        raise Error("bad-argument", "expert(env)", f"the action is {task.action}, randomised models: {task.is_randomised}",
                    f'make it with action="{task.actions[0]}"{without}')
    return Expert(env)
