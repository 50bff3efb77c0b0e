"""Damping of a vibration."""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np

from .trunk import TrunkTask

__all__ = ["TrunkDamp"]


class TrunkDamp(TrunkTask):
    """Bring a struck trunk to rest; dynamic (generalized-alpha), steps of 10 ms, episodes of 1 s.

    A lateral blow of 0.2 to 0.4 N in a random direction acts on the end of the trunk during the first 60 ms. The passive trunk
    swings at about 4 Hz and loses half of its energy in 0.1 s (stiffness damping, 2 ms). The default action is the tension
    itself: an action of -1 is a slack cable.

    Observation: the sensors of the trunk, then rates of the cables (8, unit 0.1 m/s).
    Reward of a step: -E / 1 mJ, where E is the sum of kinetic, strain and gravity energy minus its value at rest. Cables that
    are pulled unnecessarily store energy, too. The task never terminates.
    Info: `energy` (J).
    """

    name = "trunk-damp"
    summary = "bring a struck trunk to rest"
    dynamic = True
    actions = ("tension", "tension-increment", "displacement", "displacement-increment")
    settings = {"integrator": {"type": "generalized-alpha", "spectral_radius": 0.8}, "solver": {"tolerance": 1e-4},
                "bodies.trunk.damping": {"stiffness": 0.002}}  # fmt: skip
    BLOW = 0.06  # s
    RATE, GAIN = 0.1, 15.0  # m/s, unit of the observed rates; N s/m, gain of the scripted expert

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draws the blow."""
        random = episode.random
        turn, size = random.uniform(0.0, 2.0 * np.pi), random.uniform(0.2, 0.4)
        self.push(episode, size * np.array([np.cos(turn), np.sin(turn), 0.0]))
        episode.memory.update(displacements=None)

    def disturb(self, episode: Any) -> None:
        """Ends the blow."""
        if episode.steps == round(self.BLOW / self.time_step):
            self.push(episode, np.zeros(3))

    def scripted(self, episode: Any) -> np.ndarray:
        """Tensions that resist the motion: GAIN times the rate at which a cable lengthens, minus that of the opposite cable.

        A tension T takes the power T dl/dt out of the trunk, where l is the length of the cable inside it. A cable damps while it
        lengthens and returns energy while it shortens. The script therefore pulls it in the first case and slackens it in the second.
        The difference cancels motion that lengthens both cables.
        """
        rates = self.RATE * episode.memory["rates"].reshape(2, 4)  # m/s, positive for shortening; long cables, then short ones
        tensions = self.GAIN * np.maximum(np.roll(rates, 2, axis=1) - rates, 0.0).ravel()
        return np.clip(2.0 * (tensions - self.low) / (self.high - self.low) - 1.0, -1.0, 1.0)

    def further_names(self, cables: list[str]) -> list[str]:
        """Rates of the cables."""
        return [f"{cable} rate / 0.1 m/s" for cable in cables]

    def sense_further(self, episode: Any) -> np.ndarray:
        """Rates of the cables."""
        return self.cable_rates(episode)

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Minus the energy in mJ."""
        body = episode.robot.body
        energy = body.kinetic_energy + body.strain_energy + body.gravity_energy - episode.model.rest["energy"]
        return -1e3 * energy, False, {"energy": energy}
