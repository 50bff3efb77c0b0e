"""Holding the tip at rest against pushes."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from .trunk import TrunkTask

__all__ = ["TrunkHold"]

GROWTH = 0.1  # s, transition time to a new push


class TrunkHold(TrunkTask):
    """Hold the tip at its rest position while it is pushed; quasi-static, steps of 10 ms, episodes of 1 s.

    Lateral pushes of up to `push` N in random directions act on the end of the trunk. Each changes from the previous one within
    0.1 s and then stays for 0.1 to 0.3 s. The policy does not sense them.

    Observation: the sensors of the trunk, rates of the cables (8, unit 0.1 m/s), then the vector from tip to goal (3, unit
    0.1 m).
    Reward of a step: -(distance of the tip from its rest position) / 10 mm. The task never terminates.
    Info: `distance` (m), `success` (within 5 mm).

    Parameters
    ----------
    push : float
        Largest push, N, 0 to 1.
    """

    name = "trunk-hold"
    summary = "hold the tip against random pushes"

    def __init__(self, *, push: float = 0.3, **options: Any) -> None:
        super().__init__(**options)
        self.greatest_push = self.bounded("push", push, 0.0, 1.0, " N")

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Sets the goal to the rest position of the present model."""
        episode.goal = episode.model.rest["tip"].copy()
        episode.memory.update(displacements=None)
        self._draw(episode, np.zeros(3))
        self.push(episode, np.zeros(3))

    def _draw(self, episode: Any, last: np.ndarray) -> None:
        """Draws a push that begins with the next step."""
        random, memory = episode.random, episode.memory
        turn, size = random.uniform(0.0, 2.0 * np.pi), random.uniform(0.0, self.greatest_push)
        memory.update(last=last, next=size * np.array([np.cos(turn), np.sin(turn), 0.0]), since=episode.steps)
        memory["until"] = episode.steps + round((GROWTH + random.uniform(0.1, 0.3)) / self.time_step)

    def disturb(self, episode: Any) -> None:
        """Pushes, and draws the next push when the last one has ended."""
        memory = episode.memory
        if episode.steps >= memory["until"]:
            self._draw(episode, memory["next"])
        share = min((episode.steps + 1 - memory["since"]) * self.time_step / GROWTH, 1.0)
        self.push(episode, memory["last"] + share * (memory["next"] - memory["last"]))

    def further_names(self, cables: list[str]) -> list[str]:
        """Rates of the cables, and vector from tip to goal."""
        return [f"{cable} rate / 0.1 m/s" for cable in cables] + [f"goal - tip {axis} / 0.1 m" for axis in "xyz"]

    def sense_further(self, episode: Any) -> np.ndarray:
        """Rates of the cables, and vector from tip to goal."""
        return np.concatenate([self.cable_rates(episode), self.toward_goal(episode)])

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Minus the distance, unit 10 mm."""
        distance = self.distance(episode)
        return -distance / 0.01, False, {"distance": distance, "success": distance < 0.005}
