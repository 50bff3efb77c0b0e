"""Lifting a soft cup with three soft fingers."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Mapping

import numpy as np

from ..._core import State
from ...errors import Error
from ..models import Robot
from ..scenes import gripper
from .contact import ContactTask

__all__ = ["Grasp"]

_LIFT, _LIFT_RATE = 0.08, 0.06  # m, m/s: largest height of the feet, largest speed
_CLOSE, _CLOSE_RATE = 8e-3, 10e-3  # m, m/s: pull of the script; 10 mm would push the fingertips around the cup
_NEAR, _UPRIGHT, _TOPPLED = 5e-3, math.radians(10.0), math.radians(45.0)  # m, rad, rad
_LIFTED, _DOWN = 10e-3, 2e-3  # m: once higher than _LIFTED, a cup lower than _DOWN counts as dropped


class Grasp(ContactTask):
    """Close three soft fingers on a soft cup and lift it to a height; dynamic (backward Euler), steps of 20 ms, episodes of 3 s.

    The fingers hang around the cup, 195 mm long, each with a cable on its inner side. The rubber cup stands on a table: 79 mm
    high, 54 g, wider at its rim (70 mm) than at its floor (36 mm). Its height is the rise of its centre of mass. Each episode
    asks for a height of 25 to 60 mm; `reset(options={"height": m})` sets one, 10 to 75 mm.

    Action: change of the displacement of each cable (20 mm/s, within 0 to 10 mm), and of the height of the feet (60 mm/s,
    within 0 to 80 mm). `action="displacement"`: the values themselves, with the same rate limits.
    Observation: displacements of the cables (3, unit 10 mm), tensions (3, unit 10 N), height of the feet (unit 50 mm), motion
    of the cup (3, unit 50 mm), its velocity (3, unit 0.1 m/s), x and y of its axis, a unit vector (2), normal force of each
    finger (3, unit 0.5 N), upward force of each finger on the cup (3, unit 0.2 N), goal minus height of the cup (unit 50 mm).
    `observe="state"` appends displacements (unit 50 mm) and velocities (unit 1 m/s) of all nodes, body by body.
    Reward of a step: 1 - |goal - height| / goal - (tilt / 30 degrees)^2, at least -1; -10 if the cup is dropped or toppled.
    The episode then ends: the cup tilts by more than 45 degrees, or it has been higher than 10 mm and either no finger touches
    it or it is back within 2 mm.
    Info: `height` (m), `tilt` (rad), `success` (within 5 mm of the goal, off the table, tilted by less than 10 degrees).
    Randomisation: `material_scale` applies to the cup, `payload` to its floor, `friction` to fingers, cup and table (default
    0.6; below 0.25 this cup slips).

    The mesh is coarse: 133 nodes per finger, 242 for the cup. With its cable pulled in by 8 mm, a finger grips with 0.41 to
    0.42 N; in examples/grasp/grasp.py, with 703 and 472 nodes and steps of 10 ms, it grips with 0.40 to 0.41 N (3 % less). When
    lifted by 60 mm, the cup rises by 62.1 mm here and by 62.5 mm there. Cables pulled in by 10 mm push the fingertips sideways
    around the cup; there, this happens at 9 mm.
    """

    name = "grasp"
    summary = "lift a soft cup with three soft fingers"
    actions = ("displacement-increment", "displacement")
    default_time_limit = 3.0
    default_friction = 0.6
    options = {"height": 0}

    def described(self, folder: Path) -> dict[str, Any]:
        """The scene with the smallest friction; `randomised` sets the friction of a model."""
        return gripper.scene(folder, self.friction[0])

    def randomised(self, material_scale: float, payload: float, friction: float) -> dict[str, Any]:
        """Young's modulus of the cup, a point mass in its floor, friction."""
        contacts = ["table", *(f"grip_{k}" for k in range(gripper.FINGERS))]
        changed: dict[str, Any] = {f"contacts.{name}.friction": friction for name in contacts}
        changed["bodies.cup.material.young_modulus"] = gripper.CUP_MODULUS * material_scale
        if payload > 0.0:
            changed["masses"] = {"payload": {"body": "cup", "point": [0.0, 0.0, 0.5 * gripper.CUP_FLOOR], "mass": payload}}
        return changed

    def limits(self, robot: Robot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Limits of the cables, then of the feet."""
        least, greatest, rates = super().limits(robot)
        return np.append(least, 0.0), np.append(greatest, _LIFT), np.append(rates, _LIFT_RATE)

    def prepare(self, robot: Robot) -> list[State]:
        """The fingers hang and the cup stands, both at rest."""
        robot.sim.step(20)
        return [robot.sim.state()]

    def measure_rest(self, robot: Robot) -> dict[str, Any]:
        """Nodal masses of the cup relative to its mass, its lowest and highest nodes, centre of mass (m), all nodes (m)."""
        cup = robot.sim.body("cup")
        height, shares = np.array(cup.rest_positions)[:, 2], np.array(cup.node_masses) / np.sum(cup.node_masses)
        return {"shares": shares, "floor": np.flatnonzero(height < 1e-6), "rim": np.flatnonzero(height > gripper.CUP_HEIGHT - 1e-6),
                "centre": shares @ cup.positions, "positions": [np.array(b.positions) for b in robot.sim.bodies.values()]}  # fmt: skip

    def commanded(self, robot: Robot) -> np.ndarray:
        """The feet start at their rest height."""
        return np.append(super().commanded(robot), 0.0)

    def commands(self, episode: Any, action: np.ndarray) -> np.ndarray:
        """Displacements of the cables (m), height of the feet (m)."""
        wanted = super().commands(episode, action)
        last, most = episode.commands[3], self.increment[3]
        wanted[3] = min(max(wanted[3], last - most), last + most)
        return wanted

    def apply(self, episode: Any) -> None:
        """Commands cables and feet."""
        super().apply(episode)
        sim, lifted = episode.robot.sim, [0.0, 0.0, float(episode.commands[3])]
        for k in range(gripper.FINGERS):
            sim.body(f"finger_{k}").move_base(lifted)

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draws the goal height."""
        height = episode.random.uniform(0.025, 0.060)
        if "height" in options:
            given = options["height"]
            if np.ndim(given) or not isinstance(given, (int, float, np.number)) or not 0.010 <= given <= 0.075:
                raise Error("out-of-range", "reset(options)", f"the height is {given!r}", "give 0.01 to 0.075 m")
            height = float(given)
        episode.goal = episode.model.rest["centre"] + [0.0, 0.0, height]
        episode.memory.update(height=height, highest=0.0)

    def risen(self, episode: Any) -> np.ndarray:
        """Motion of the cup's centre of mass, (3,) m."""
        return episode.model.rest["shares"] @ episode.robot.body.positions - episode.model.rest["centre"]

    def axis(self, episode: Any) -> np.ndarray:
        """Unit vector (3,) from the middle of the cup's floor to the middle of its rim."""
        positions, rest = episode.robot.body.positions, episode.model.rest
        along = positions[rest["rim"]].mean(axis=0) - positions[rest["floor"]].mean(axis=0)
        return along / math.sqrt(along @ along)

    def grips(self, episode: Any) -> list[Any]:
        """The contacts of the fingers with the cup."""
        return [episode.robot.sim.contact(f"grip_{k}") for k in range(gripper.FINGERS)]

    def observation_names(self, robot: Robot) -> list[str]:
        """Name of every number of an observation."""
        cables = list(robot.sim.actuators)
        names = [f"{cable} displacement / 10 mm" for cable in cables] + [f"{cable} tension / 10 N" for cable in cables]
        names += ["feet height / 50 mm"] + [f"cup {axis} / 50 mm" for axis in "xyz"] + [f"cup velocity {axis} / 0.1 m/s" for axis in "xyz"]
        names += ["cup axis x", "cup axis y"] + [f"finger {k} normal force / 0.5 N" for k in range(gripper.FINGERS)]
        names += [f"finger {k} upward force / 0.2 N" for k in range(gripper.FINGERS)] + ["goal - height / 50 mm"]
        if self.observe == "state":
            nodes = [f"{name} node {k}" for name, body in robot.sim.bodies.items() for k in range(len(body.positions))]
            names += [f"{node} {axis} / 50 mm" for node in nodes for axis in "xyz"]
            names += [f"{node} velocity {axis} / 1 m/s" for node in nodes for axis in "xyz"]
        return names

    def sense(self, episode: Any, out: np.ndarray) -> None:
        """Writes an observation."""
        robot, rest, grips, moved = episode.robot, episode.model.rest, self.grips(episode), self.risen(episode)
        out[0:3] = [actuator.displacement / 0.010 for actuator in robot.actuators]
        out[3:6] = [actuator.tension / 10.0 for actuator in robot.actuators]
        out[6] = episode.commands[3] / 0.05
        out[7:10] = moved / 0.05
        out[10:13] = rest["shares"] @ robot.body.velocities / 0.1
        out[13:15] = self.axis(episode)[:2]
        out[15:18] = [grip.normal_force / 0.5 for grip in grips]
        out[18:21] = [-grip.force[2] / 0.2 for grip in grips]  # `force` acts on the finger
        out[21] = (episode.memory["height"] - moved[2]) / 0.05
        if self.observe == "state":
            bodies = list(robot.sim.bodies.values())
            shifts = [((body.positions - at) / 0.05).ravel() for body, at in zip(bodies, rest["positions"])]
            out[22:] = np.concatenate([*shifts, *(np.ravel(body.velocities) for body in bodies)])

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Fraction of the goal height, minus a penalty on tilt."""
        memory, height = episode.memory, float(self.risen(episode)[2])
        goal, tilt = memory["height"], math.acos(min(1.0, float(self.axis(episode)[2])))
        memory["highest"] = max(memory["highest"], height)
        free = all(grip.normal_force == 0.0 for grip in self.grips(episode))
        over = tilt > _TOPPLED or (memory["highest"] > _LIFTED and (free or height < _DOWN))
        success = not over and abs(goal - height) < _NEAR and tilt < _UPRIGHT and episode.robot.sim.contact("table").normal_force == 0.0
        reward = -10.0 if over else max(-1.0, 1.0 - abs(goal - height) / goal - (tilt / math.radians(30.0)) ** 2)
        return reward, over, {"height": height, "tilt": tilt, "success": success}

    def scripted(self, episode: Any) -> np.ndarray:
        """Pulls every cable in by 8 mm within 0.8 s, then moves the feet by the missing height of the cup."""
        cables, feet = episode.commands[:3], 0.0
        if cables.min() > _CLOSE - 1e-9:
            feet = (episode.memory["height"] - self.risen(episode)[2]) / self.increment[3]
        close = np.minimum(_CLOSE - cables, _CLOSE_RATE * self.time_step) / self.increment[:3]
        return np.clip(np.append(close, feet), -1.0, 1.0)
