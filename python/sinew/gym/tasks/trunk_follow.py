"""Following a moving goal with the tip."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from .trunk import TrunkTask, surface

__all__ = ["TrunkFollow"]


class TrunkFollow(TrunkTask):
    """Keep the tip at a goal that moves; quasi-static, 10 ms a step, 2 s an episode.

    The goal goes along a Lissajous curve on the surface on which the tip moves: amplitudes of 20 to 45 mm across x and y,
    periods of 1.5 to 4 s and phases at random. It leaves the rest position during the first 0.5 s.

    Observation: the sensors of the trunk, then from tip to goal (3, over 0.1 m), velocity of the goal (3, over 0.1 m/s).
    Reward of a step: -(distance of the tip from the goal) / 50 mm. It never terminates.
    Info: `distance` (m), `success` (within 5 mm).
    """

    name = "trunk-follow"
    summary = "keep the tip at a moving goal"
    default_time_limit = 2.0

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draw the curve."""
        random = episode.random
        episode.memory["curve"] = (random.uniform(0.020, 0.045, 2), random.uniform(1.5, 4.0, 2), random.uniform(0.0, 2.0 * np.pi, 2))
        episode.goal = self.goal_at(episode, 0.0)

    def goal_at(self, episode: Any, time: float) -> np.ndarray:
        """Return the position of the goal, (3,) m, at a time (s) of the episode."""
        amplitude, period, phase = episode.memory["curve"]
        share = min(time / 0.5, 1.0)
        begun = share * share * (3.0 - 2.0 * share)
        return begun * surface(amplitude * np.sin(2.0 * np.pi * time / period + phase)) + (1.0 - begun) * episode.model.rest["tip"]

    def disturb(self, episode: Any) -> None:
        """Move the goal to its position at the end of the step."""
        episode.goal = self.goal_at(episode, (episode.steps + 1) * self.time_step)

    def further_names(self, cables: list[str]) -> list[str]:
        """From tip to goal, and the goal's velocity."""
        return [f"goal - tip {axis} / 0.1 m" for axis in "xyz"] + [f"goal velocity {axis} / 0.1 m/s" for axis in "xyz"]

    def sense_further(self, episode: Any) -> np.ndarray:
        """The velocity is the mean one of the step to come."""
        ahead = self.goal_at(episode, (episode.steps + 1) * self.time_step)
        return np.concatenate([self.toward_goal(episode), (ahead - episode.goal) / (0.1 * self.time_step)])

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Minus the distance over 50 mm."""
        distance = self.distance(episode)
        return -distance / 0.05, False, {"distance": distance, "success": distance < 0.005}
