"""Base of the trunk tasks."""

from __future__ import annotations

import math
from typing import Any, Mapping, Sequence

import numpy as np

from ...errors import Error
from ..models import Robot
from ..task import SCENES, Task

__all__ = ["TrunkTask", "surface"]

_LENGTH = 0.01  # m, unit of cable displacements
_PLACE = 0.1  # m, unit of positions
_RATE = 0.1  # m/s, unit of cable rates
_SPEED = 1.0  # m/s, unit of nodal velocities


def surface(across: Sequence[float]) -> np.ndarray:
    """Point of the surface on which the tip moves, at a position across the axis.

    The tip of the trunk moves near a cap, z = 187 mm - 7.00 r^2/m + 177.5 r^4/m^3, fitted to 400 equilibria under random
    tensions. The equilibria lie within 12 mm of it.

    Parameters
    ----------
    across : two numbers, m
        x and y, up to 0.07 m from the axis.

    Returns
    -------
    (3,) m
    """
    square = float(across[0] ** 2 + across[1] ** 2)
    return np.array([across[0], across[1], 0.18723 + square * (-7.00346 + 177.506 * square)])


class TrunkTask(Task):
    """A trunk with eight cables that hangs from its thick end.

    Sensors, at least 19 numbers: displacement of every cable (8, unit 10 mm), tension of every cable (8, relative to its limit
    of 8 N), position of the tip relative to rest (3, unit 0.1 m). The cables are ordered long_0 to long_3, short_0 to short_3.
    `observe="state"` appends the displacements of all nodes (unit 0.1 m) and, in dynamic tasks, their velocities (unit 1 m/s).
    """

    scene = SCENES / "trunk.yaml"
    actions = ("tension-increment", "tension", "displacement-increment", "displacement")
    dynamic = False

    def randomised(self, material_scale: float, payload: float) -> dict[str, Any]:
        """Young's modulus, and a point mass at the tip."""
        changed: dict[str, Any] = {}
        if material_scale != 1.0:
            changed["bodies.trunk.material.young_modulus"] = 450e3 * material_scale
        if payload > 0.0:
            changed["masses"] = {"payload": {"body": "trunk", "point": [0.0, 0.0, 0.195], "mass": payload}}
        return changed

    def measure_rest(self, robot: Robot) -> dict[str, Any]:
        """Tip, nodes, and the sum of strain and gravity energy (J)."""
        body = robot.body
        return {"tip": robot.tip.position, "positions": body.positions.copy(), "top": np.array(body.node_sets["top"]),
                "energy": body.strain_energy + body.gravity_energy}  # fmt: skip

    def goal_given(self, episode: Any, options: Mapping[str, Any]) -> bool:
        """Sets the goal from the options of a reset, if they contain one."""
        if "goal" not in options:
            return False
        goal = np.array(options["goal"], dtype=float)
        if goal.shape != (3,) or not np.isfinite(goal).all():
            raise Error("wrong-shape", "reset(options)", f"the goal is {options['goal']!r}", "give three numbers in m")
        episode.goal = goal
        return True

    def push(self, episode: Any, force: np.ndarray) -> None:
        """Distributes a force (3,) N over the nodes at the tip, until it is changed."""
        top = episode.model.rest["top"]
        episode.robot.body.external_forces[top] = force / len(top)

    def observation_names(self, robot: Robot) -> list[str]:
        """Name of every number of an observation."""
        cables = list(robot.sim.actuators)
        names = [f"{cable} displacement / 10 mm" for cable in cables] + [f"{cable} tension / 8 N" for cable in cables]
        names += [f"tip {axis} / 0.1 m" for axis in "xyz"] + self.further_names(cables)
        if self.observe == "state":
            nodes = len(robot.body.positions)
            names += [f"node {k} {axis} / 0.1 m" for k in range(nodes) for axis in "xyz"]
            if self.dynamic:
                names += [f"node {k} velocity {axis} / 1 m/s" for k in range(nodes) for axis in "xyz"]
        return names

    def further_names(self, cables: list[str]) -> list[str]:
        """Names of the sensors of the task besides cables and tip."""
        return []

    def sense_further(self, episode: Any) -> np.ndarray:
        """The values of `further_names`."""
        return np.zeros(0)

    def sense(self, episode: Any, out: np.ndarray) -> None:
        """Writes an observation."""
        robot, rest = episode.robot, episode.model.rest
        displacements = [actuator.displacement / _LENGTH for actuator in robot.actuators]
        out[:8] = displacements
        out[8:16] = [actuator.tension / 8.0 for actuator in robot.actuators]
        out[16:19] = (robot.tip.position - rest["tip"]) / _PLACE
        further = self.sense_further(episode)
        at = 19 + len(further)
        out[19:at] = further
        if self.observe == "state":
            nodes = rest["positions"].size
            out[at : at + nodes] = ((robot.body.positions - rest["positions"]) / _PLACE).ravel()
            if self.dynamic:
                out[at + nodes :] = (robot.body.velocities / _SPEED).ravel()

    def cable_rates(self, episode: Any) -> np.ndarray:
        """Mean rates of the cables' displacements in the last step, unit 0.1 m/s, (8,); zeros after a reset.

        A simulated sensor that reads the displacements once per step.
        """
        now = np.array([actuator.displacement for actuator in episode.robot.actuators])
        last = episode.memory.get("displacements")
        rates = np.zeros(len(now)) if last is None else (now - last) / (self.time_step * _RATE)
        episode.memory.update(displacements=now, rates=rates)
        return rates

    def toward_goal(self, episode: Any) -> np.ndarray:
        """Vector from the tip to the goal, unit 0.1 m, (3,)."""
        return (episode.goal - episode.robot.tip.position) / _PLACE

    def distance(self, episode: Any) -> float:
        """Distance between tip and goal, m."""
        away = episode.goal - episode.robot.tip.position
        return math.sqrt(away @ away)
