"""Swing-up of an arm whose torques are too weak to hold it up."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from ..._core import State
from ..models import Robot
from ..task import SCENES, Task

__all__ = ["ArmSwingUp"]

_LENGTHS, _MASSES, _STIFFNESS, _DAMPING = (0.14,) * 4, (0.190, 0.146, 0.090, 0.090), 0.108, 4.2e-3  # m, kg, N m, N m s


class ArmSwingUp(Task):
    """Swing the tip of a hanging constant-curvature arm as high as possible; steps of 2 ms, actions of 20 ms, episodes of 4 s.

    The torques on the lower three of four segments are weak: constant torques at their limits raise the tip less than a swing
    does. Episodes begin with the arm hanging, slightly bent and at rest or moving, drawn from eight states.

    Action: torques, from -limit to limit (0.12, 0.13, 0.18 N m).
    Observation: bending angles of the segments (4, unit 1 rad), their rates (4, unit 10 rad/s), torques (3, relative to their
    limits), position of the tip (x and z, relative to 0.56 m, the length of the arm). There is no hidden state:
    `observe="state"` is the same.
    Reward of a step: (height of the tip above its hanging position) / 0.56 m - 0.01 (mean square of the actions). The task never
    terminates.
    Info: `height` (m), `success` (the tip has reached HIGH in the episode).
    """

    name = "arm-swing-up"
    summary = "swing the tip of a fluidic arm up"
    scene = SCENES / "arm.yaml"
    actions = ("torque",)
    observables = ("arm.coordinates", "arm.rates", "second.torque", "third.torque", "fourth.torque", "tip.position")
    substeps = 10
    default_time_limit = 4.0
    camera = "front"
    HIGH = 0.3  # m above the hanging tip; constant torques at their limits swing it to 0.20 m and hold it at 0.120 m
    RATE = 3.0  # rad/s, above which the scripted expert uses the full torques

    def randomised(self, material_scale: float, payload: float) -> dict[str, Any]:
        """Stiffness of all segments; the payload is added to the mass of the last one."""
        if material_scale == 1.0 and payload == 0.0:
            return {}
        masses = [*_MASSES[:-1], _MASSES[-1] + payload]
        return {"bodies.arm.segments": [
            {"length": length, "mass": mass, "stiffness": _STIFFNESS * material_scale, "damping": _DAMPING}
            for length, mass in zip(_LENGTHS, masses)
        ]}  # fmt: skip

    def picture_points(self, robot: Robot) -> np.ndarray:
        """All points that the tip can reach, seen along the line of sight."""
        reach = sum(_LENGTHS)
        return reach * np.array([[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0]])

    def prepare(self, robot: Robot) -> list[State]:
        """Eight states: at rest, and 0.1 to 0.5 s after torques of up to 30 % of the limits are applied."""
        start, states, random = robot.sim.state(), [robot.sim.state()], np.random.default_rng(0)
        for _ in range(7):
            robot.sim.restore(start)
            for actuator in robot.actuators:
                actuator.torque = float(random.uniform(-0.3, 0.3)) * actuator.limits["torque"].max
            robot.sim.step(int(random.integers(50, 250)))
            states.append(robot.sim.state())
        for actuator in robot.actuators:
            actuator.torque = 0.0
        return states

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draws nothing further."""
        episode.commands = np.zeros(3)
        episode.memory.update(highest=-np.inf)

    def scripted(self, episode: Any) -> np.ndarray:
        """Energy pumping: all torques act in the direction in which the whole arm turns, the sign of the sum of the segments' rates.

        The power of a torque is the torque times the rate of its segment. In the lowest mode all segments turn together, and torques
        in phase with it raise its energy in every half swing, as in the swing-up of a pendulum by energy control (Astrom and Furuta,
        Automatica 36 (2000) 287-295: control by the sign of the rate). Below RATE the torques are proportional to the rate, which
        excites higher modes less. The first action is a push, because an arm at rest has no rate.
        """
        rate = np.sum(episode.robot.body.rates) / self.RATE
        return np.full(3, np.clip(rate, -1.0, 1.0) if episode.steps > 0 else np.copysign(1.0, rate))

    def observation_names(self, robot: Robot) -> list[str]:
        """Name of every number of an observation."""
        return ([f"angle {k} / 1 rad" for k in range(4)] + [f"rate {k} / 10 rad/s" for k in range(4)]
                + [f"{name} torque / limit" for name in robot.sim.actuators] + ["tip x / 0.56 m", "tip z / 0.56 m"])  # fmt: skip

    def sense_rows(self, episodes: Sequence[Any], read: np.ndarray, out: np.ndarray) -> None:
        """Writes observations."""
        out[:, :4] = read[:, :4]
        out[:, 4:8] = read[:, 4:8] / 10.0
        out[:, 8:11] = read[:, 8:11] / self.high
        out[:, 11:] = read[:, 11::2] / 0.56

    def reward_rows(
        self, episodes: Sequence[Any], read: np.ndarray, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Height relative to the length, minus a small penalty on effort."""
        height = read[:, 13] - [episode.model.rest["tip"][2] for episode in episodes]
        effort = np.mean(actions**2, axis=1)
        highest = np.maximum(height, [episode.memory["highest"] for episode in episodes])
        for episode, value in zip(episodes, highest.tolist()):
            episode.memory["highest"] = value
        over = np.zeros(len(episodes), dtype=bool)
        return height / 0.56 - 0.01 * effort, over, {"height": height, "success": highest > self.HIGH}
