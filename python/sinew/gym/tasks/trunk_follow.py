"""Following a moving goal with the tip."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from .trunk import TrunkTask, surface

__all__ = ["TrunkFollow"]


class TrunkFollow(TrunkTask):
    """Keep the tip at a moving goal; quasi-static, steps of 10 ms, episodes of 2 s.

    The goal follows a Lissajous curve on the surface on which the tip moves, with amplitudes of 20 to 45 mm in x and y, periods of
    1.5 to 4 s and random phases. It leaves the rest position during the first 0.5 s.

    Observation: the sensors of the trunk, then the vector from tip to goal (3, unit 0.1 m) and the velocity of the goal (3, unit
    0.1 m/s).
    Reward of a step: -(distance of the tip from the goal) / 50 mm. The task never terminates.
    Info: `distance` (m), `success` (within 5 mm).
    """

    name = "trunk-follow"
    summary = "keep the tip at a moving goal"
    default_time_limit = 2.0

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draws the curve."""
        random = episode.random
        episode.memory["curve"] = (random.uniform(0.020, 0.045, 2), random.uniform(1.5, 4.0, 2), random.uniform(0.0, 2.0 * np.pi, 2))
        episode.goal = self.goal_at(episode, 0.0)

    def goal_at(self, episode: Any, time: float) -> np.ndarray:
        """Position of the goal at a time (s) of the episode, (3,) m."""
        amplitude, period, phase = episode.memory["curve"]
        share = min(time / 0.5, 1.0)
        begun = share * share * (3.0 - 2.0 * share)
        return begun * surface(amplitude * np.sin(2.0 * np.pi * time / period + phase)) + (1.0 - begun) * episode.model.rest["tip"]

    def disturb(self, episode: Any) -> None:
        """Moves the goal to its position at the end of the step."""
        episode.goal = self.goal_at(episode, (episode.steps + 1) * self.time_step)

    def further_names(self, cables: list[str]) -> list[str]:
        """Vector from tip to goal, and velocity of the goal."""
        return [f"goal - tip {axis} / 0.1 m" for axis in "xyz"] + [f"goal velocity {axis} / 0.1 m/s" for axis in "xyz"]

    def sense_further(self, episode: Any) -> np.ndarray:
        """Vector from tip to goal, and mean velocity of the goal in the next step."""
        ahead = self.goal_at(episode, (episode.steps + 1) * self.time_step)
        return np.concatenate([self.toward_goal(episode), (ahead - episode.goal) / (0.1 * self.time_step)])

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Minus the distance, unit 50 mm."""
        distance = self.distance(episode)
        return -distance / 0.05, False, {"distance": distance, "success": distance < 0.005}
