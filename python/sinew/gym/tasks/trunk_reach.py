"""Reaching a point with the tip."""

from __future__ import annotations

import math
from typing import Any, Mapping

import numpy as np

from .trunk import TrunkTask, surface

__all__ = ["TrunkReach"]


def random_goal(random: np.random.Generator, radius: float = 0.06, depth: float = 0.004) -> np.ndarray:
    """A goal that the tip can reach, (3,) m: uniform on a disc across the axis and within +-depth of the tip's surface."""
    turn, part, off = random.random(3).tolist()  # plain floats: a NumPy call takes 1 us, a reset 30 us
    out = radius * math.sqrt(part)
    goal = surface((out * math.cos(2.0 * math.pi * turn), out * math.sin(2.0 * math.pi * turn)))
    goal[2] += depth * (2.0 * off - 1.0)
    return goal


class TrunkReach(TrunkTask):
    """Bring the tip to a goal and keep it there; quasi-static, steps of 10 ms, episodes of 0.5 s.

    Goals: x and y uniform on a disc of 60 mm radius around the axis, z within 4 mm of the surface on which the tip moves. The
    nominal trunk can reach all of them. `reset(options={"goal": (3,) m})` sets a goal.

    Observation: the sensors of the trunk, then the vector from tip to goal (3, unit 0.1 m).
    Reward of a step: -(distance of the tip from the goal) / 50 mm. The task never terminates.
    Info: `distance` (m), `success` (within 5 mm).
    """

    name = "trunk-reach"
    summary = "bring the tip to a random goal"
    default_time_limit = 0.5
    options = {"goal": 1}

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draws the goal."""
        goal = random_goal(episode.random)
        if not self.goal_given(episode, options):
            episode.goal = goal

    def further_names(self, cables: list[str]) -> list[str]:
        """Vector from tip to goal."""
        return [f"goal - tip {axis} / 0.1 m" for axis in "xyz"]

    def sense_further(self, episode: Any) -> np.ndarray:
        """Vector from tip to goal."""
        return self.toward_goal(episode)

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Minus the distance, unit 50 mm."""
        distance = self.distance(episode)
        return -distance / 0.05, False, {"distance": distance, "success": distance < 0.005}
