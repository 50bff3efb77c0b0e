"""The robots of a task: the models that it draws from, and simulations of each.

What domain randomisation changes in a body (the stiffness of its material, its payload) is constant within a model, so a
task builds a fixed number of models and an episode draws one of them. A simulation of a model is a clone and costs
`Simulation.memory` bytes. An episode takes a simulation of its model that is free, or a new clone, and hands it back at its
end; which one it gets does not matter, as a restored state continues bit for bit.
"""

from __future__ import annotations

import threading
from typing import Any

from .._core import Simulation, State
from ..scene import load

__all__ = ["Model", "Models", "Robot"]


class Robot:
    """A simulation with its parts at hand.

    Attributes
    ----------
    sim : sinew.Simulation
    actuators : list of sinew.Actuator
        In the order of the actions.
    tip : sinew.Effector
    body : sinew.Body
    """

    def __init__(self, sim: Simulation) -> None:
        self.sim = sim
        self.actuators = list(sim.actuators.values())
        self.tip = next(iter(sim.effectors.values()))
        self.body = next(iter(sim.bodies.values()))


class Model:
    """One robot of a task.

    Attributes
    ----------
    material_scale : float
        Factor of the stiffness.
    payload : float
        kg at the tip.
    first : Robot
        Every simulation of the model is a clone of its own.
    starts : list of sinew.State
        The states that episodes begin with.
    rest : dict
        What the task keeps of the model at rest (Task.measure_rest).
    """

    def __init__(self, task: Any, material_scale: float, payload: float) -> None:
        self.material_scale, self.payload = material_scale, payload
        overrides = {**task.settings, **task.randomised(material_scale, payload), **task.set}
        self.first = Robot(load(task.scene, set=overrides, threads=1))
        self.starts: list[State] = task.prepare(self.first)
        self.first.sim.restore(self.starts[0])
        self.rest = task.measure_rest(self.first)
        self._free: list[Robot] = []
        self._lock = threading.Lock()

    def take(self) -> Robot:
        """A free simulation of the model, in any state."""
        with self._lock:
            return self._free.pop() if self._free else Robot(self.first.sim.clone())

    def give_back(self, robot: Robot) -> None:
        """Makes a simulation free again."""
        with self._lock:
            self._free.append(robot)


class Models:
    """All models of a task.

    Without randomisation there is one. With it, model k of K has quantile (k + 1/2) / K of the material scale, log-uniform
    in its range, and of the payload quantile frac((k + 1/2) golden ratio), uniform in its range: points that fill the plane
    evenly and that do not depend on any seed.
    """

    def __init__(self, task: Any) -> None:
        count = task.models if task.is_randomised else 1
        self.all = []
        for k in range(count):
            first, second = (k + 0.5) / count, ((k + 0.5) * 0.6180339887498949) % 1.0
            low, high = task.material_scale
            light, heavy = task.payload
            self.all.append(Model(task, low * (high / low) ** first, light + (heavy - light) * second))

    def __len__(self) -> int:
        return len(self.all)

    def __getitem__(self, index: int) -> Model:
        return self.all[index]
