"""A crawling soft quadruped."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Mapping

import numpy as np

from ..._core import State
from ..models import Robot
from ..scenes import crawler
from .contact import ContactTask

__all__ = ["PERIOD", "Crawl", "gait"]

PERIOD = 2.0  # s, period of the gait
_FILL, _FULL, _LAG = 0.2, 0.5, 0.15  # fractions of the period: filling time, start of emptying, lag between groups
_TURN = {"front_left": 0, "front_right": 0, "trunk": 1, "rear_left": 2, "rear_right": 2}  # group of each chamber in the order of the gait
_FAR = 0.030  # m, distance that counts as success


def gait(time: float) -> np.ndarray:
    """Pressures of the open-loop gait at a time as fractions of their limits, (5,) in [0, 1], in the order of the chambers.

    The front legs fill first, then the trunk, then the rear legs; they empty in the same order. In this order the robot moves
    forward; docs/locomotion.md, "Crawling", explains why.

    Parameters
    ----------
    time : float
        Time since the start of the gait, s; the period is 2 s.
    """
    phase = (time / PERIOD) % 1.0
    begun = phase - _LAG * np.array([_TURN[name] for name in crawler.CHAMBERS])
    return np.interp(begun, [0.0, _FILL, _FULL, _FULL + _FILL], [0.0, 1.0, 1.0, 0.0])


class Crawl(ContactTask):
    """Make a silicone quadruped with five air chambers crawl forward, along x; steps of 40 ms, episodes of 6 s.

    Two front legs, a trunk and two rear legs stand on a sole that fabric keeps from stretching, so pressure in a chamber arches
    its part upwards. 57 x 38 x 14 mm, 15 g, 768 nodes; dynamic (backward Euler). Episodes begin at rest, with all chambers empty
    or with pressures of up to half of the limits, drawn from four states.

    Action: change of the pressure in front_left, front_right, trunk, rear_left and rear_right: up to 300 kPa/s within 0 to
    60 kPa in the legs, 200 kPa/s within 0 to 40 kPa in the trunk. `action="pressure"`: the pressures themselves.
    Observation: pressures (5, relative to their limits), volume growth of the chambers (5, relative to the volumes at rest),
    motion of the centre of mass since the start (3, unit 50 mm), heading (unit 1 rad, counter-clockwise), velocity (3, unit
    50 mm/s), normal forces of the feet (4, relative to the weight). `observe="state"` appends displacements (unit 50 mm) and
    velocities (unit 0.1 m/s) of all nodes.
    Reward of a step: (forward motion - half of the growth of |y|) / 1 mm - 0.01 (mean square of the actions). The task never
    terminates.
    Info: `distance` (m, along x since the start), `drift` (m, along y), `heading` (rad), `success` (a distance of 30 mm or more).
    Randomisation: `material_scale` applies to the silicone, `payload` to the sole below the trunk, `friction` to the floor
    (default 0.5). Below a material_scale of 0.95, chambers held at their limits may balloon, and the step then fails; the gait
    does not fail from 0.85 to 1. With a payload of 10 g the gait covers 40 % of its distance, with 50 g nothing.

    The open-loop gait covers 12.1 mm per cycle of 2 s; with steps of 20 ms it covers 12.2 mm, with 10 ms 11.8 mm.
    """

    name = "crawl"
    summary = "make a soft quadruped crawl forward"
    actions = ("pressure-increment", "pressure")
    default_time_limit = 6.0

    def described(self, folder: Path) -> dict[str, Any]:
        """The scene with the smallest friction; `randomised` sets the friction of a model."""
        return crawler.scene(folder, self.friction[0])

    def randomised(self, material_scale: float, payload: float, friction: float) -> dict[str, Any]:
        """Moduli of the silicone, a point mass on the sole, friction."""
        changed: dict[str, Any] = {f"contacts.{name}.friction": friction for name in (*crawler.FEET, "belly")}
        changed["bodies.crawler.material.c10"] = crawler.C10 * material_scale
        changed["bodies.crawler.material.c20"] = crawler.C20 * material_scale
        if payload > 0.0:
            changed["masses"] = {"payload": {"body": "crawler", "point": [0.0, 0.0, 1e-3], "mass": payload}}
        return changed

    def prepare(self, robot: Robot) -> list[State]:
        """Empty chambers, and three states with pressures of up to half of the limits."""
        sim, random = robot.sim, np.random.default_rng(0)
        sim.step(10)
        states = [sim.state()]
        for _ in range(3):
            sim.restore(states[0])
            for actuator in robot.actuators:
                actuator.pressure = 0.5 * float(random.uniform()) * actuator.limits["pressure"].max
            sim.step(10)
            states.append(sim.state())
        for actuator in robot.actuators:
            actuator.pressure = 0.0
        return states

    def measure_rest(self, robot: Robot) -> dict[str, Any]:
        """Nodal masses relative to the total mass, nodes of front and rear legs, volumes (m^3), weight (N), all nodes (m)."""
        body = robot.body
        masses, x = np.array(body.node_masses), np.array(body.rest_positions)[:, 0]
        third = x.max() / 3.0
        return {"shares": masses / masses.sum(), "front": np.flatnonzero(x > third), "rear": np.flatnonzero(x < -third),
                "volumes": np.array([actuator.volume for actuator in robot.actuators]), "weight": 9.81 * body.mass,
                "positions": np.array(body.positions)}  # fmt: skip

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Stores the initial position of the robot."""
        episode.memory.update(start=self.centre(episode), moved=np.zeros(3))
        episode.memory["heading"] = self.direction(episode)

    def centre(self, episode: Any) -> np.ndarray:
        """Centre of mass, (3,) m."""
        return episode.model.rest["shares"] @ episode.robot.body.positions

    def direction(self, episode: Any) -> float:
        """Angle from x to the robot's forward direction (rad)."""
        positions, rest = episode.robot.body.positions, episode.model.rest
        ahead = positions[rest["front"]].mean(axis=0) - positions[rest["rear"]].mean(axis=0)
        return math.atan2(ahead[1], ahead[0])

    def heading(self, episode: Any) -> float:
        """Rotation of the robot since the start (rad), -pi to pi."""
        return math.remainder(self.direction(episode) - episode.memory["heading"], 2.0 * math.pi)

    def observation_names(self, robot: Robot) -> list[str]:
        """Name of every number of an observation."""
        names = [f"{name} pressure / limit" for name in robot.sim.actuators] + [f"{name} volume growth" for name in robot.sim.actuators]
        names += [f"moved {axis} / 50 mm" for axis in "xyz"] + ["heading / 1 rad"] + [f"velocity {axis} / 50 mm/s" for axis in "xyz"]
        names += [f"{foot} normal force / weight" for foot in crawler.FEET]
        if self.observe == "state":
            nodes = range(len(robot.body.positions))
            names += [f"node {k} {axis} / 50 mm" for k in nodes for axis in "xyz"]
            names += [f"node {k} velocity {axis} / 0.1 m/s" for k in nodes for axis in "xyz"]
        return names

    def sense(self, episode: Any, out: np.ndarray) -> None:
        """Writes an observation."""
        robot, rest = episode.robot, episode.model.rest
        out[:5] = [actuator.pressure for actuator in robot.actuators] / self.high
        out[5:10] = [actuator.volume for actuator in robot.actuators] / rest["volumes"] - 1.0
        out[10:13] = (self.centre(episode) - episode.memory["start"]) / 0.05
        out[13] = self.heading(episode)
        out[14:17] = rest["shares"] @ robot.body.velocities / 0.05
        out[17:21] = [robot.sim.contact(foot).normal_force / rest["weight"] for foot in crawler.FEET]
        if self.observe == "state":
            out[21:] = np.concatenate([np.ravel((robot.body.positions - rest["positions"]) / 0.05), np.ravel(robot.body.velocities / 0.1)])

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Forward motion in mm, minus drift and a small penalty on effort."""
        last, moved = episode.memory["moved"], self.centre(episode) - episode.memory["start"]
        episode.memory["moved"] = moved
        gained = moved[0] - last[0] - 0.5 * (abs(moved[1]) - abs(last[1]))
        info = {"distance": float(moved[0]), "drift": float(moved[1]), "heading": self.heading(episode), "success": bool(moved[0] >= _FAR)}
        return float(1e3 * gained - 0.01 * np.mean(episode.action**2)), False, info

    def scripted(self, episode: Any) -> np.ndarray:
        """The open-loop gait."""
        wanted = self.high * gait((episode.steps + 1) * self.time_step)
        return np.clip((wanted - episode.commands) / self.increment, -1.0, 1.0)
