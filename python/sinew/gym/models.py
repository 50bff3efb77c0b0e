"""Models of a task, and simulations of each.

The quantities of domain randomisation (stiffness of a material, payload, friction) are constant within a model. A task
therefore builds a fixed number of models, and an episode draws one of them. A simulation of a model is a clone and costs
`Simulation.memory` bytes. An episode takes a free simulation of its model, or a new clone, and returns it at its end. The
choice does not matter, because a restored state continues bit for bit.
"""

from __future__ import annotations

import tempfile
import threading
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence

import numpy as np

from .._core import Batch, Simulation, State
from ..scene import load

__all__ = ["Models", "Robot", "TaskModel"]


class Robot:
    """A simulation with quick access to its parts.

    Attributes
    ----------
    sim : sinew.Simulation
    actuators : list of sinew.Actuator
        In the order of the actions.
    tip : sinew.Effector or None
        First effector of the scene.
    body : sinew.Body
        First body of the scene.
    """

    def __init__(self, sim: Simulation) -> None:
        self.sim = sim
        self.actuators = list(sim.actuators.values())
        self.tip: Any = next(iter(sim.effectors.values()), None)
        self.body = next(iter(sim.bodies.values()))
        self._alone: Optional[Batch] = None

    def read(self, names: Sequence[str]) -> np.ndarray:
        """Present observables, (1, numbers), in the format of sinew.Batch."""
        if self._alone is None:
            self._alone = Batch([self.sim])
        return self._alone.read(names)


class TaskModel:
    """One model of a task.

    Attributes
    ----------
    drawn : dict of float
        Values of Task.ranges in this model.
    first : Robot
        The simulation of which all others of the model are clones.
    starts : list of sinew.State
        Initial states of episodes.
    rest : dict
        Quantities at rest that the task stores (Task.measure_rest).
    """

    def __init__(self, task: Any, drawn: Mapping[str, float]) -> None:
        self.drawn = dict(drawn)
        overrides = {**task.settings, **task.randomised(**drawn), **task.set}
        with tempfile.TemporaryDirectory() as folder:
            self.first = Robot(load(task.described(Path(folder)), set=overrides, threads=1))
        self.first.sim.follow()
        self.starts: list[State] = task.prepare(self.first)
        self.first.sim.restore(self.starts[0])
        self.rest = task.measure_rest(self.first)
        self._free: list[Robot] = []
        self._lock = threading.Lock()

    @property
    def material_scale(self) -> float:
        """Factor on the stiffness of the material."""
        return self.drawn["material_scale"]

    @property
    def payload(self) -> float:
        """Mass of the payload, kg."""
        return self.drawn["payload"]

    def take(self) -> Robot:
        """Returns an unused simulation of the model, in any state."""
        with self._lock:
            return self._free.pop() if self._free else Robot(self.first.sim.clone())

    def give_back(self, robot: Robot) -> None:
        """Marks a simulation as free."""
        with self._lock:
            self._free.append(robot)


class Models:
    """All models of a task.

    Without randomisation there is one. Otherwise, model k of K has the quantile (k + 1/2) / K of the material scale,
    log-uniform in its range, and for payload and friction the quantiles frac((k + 1/2) golden ratio) and
    frac((k + 1/2) sqrt(2)), uniform in their ranges. These points fill the space evenly and do not depend on a seed.
    """

    _STRIDES = (0.6180339887498949, 0.4142135623730951)

    def __init__(self, task: Any) -> None:
        count = task.models if task.is_randomised else 1
        self.all = []
        for k in range(count):
            drawn: dict[str, float] = {}
            for (name, (low, high)), stride in zip(task.ranges.items(), (None, *self._STRIDES)):
                if stride is None:
                    drawn[name] = low * (high / low) ** ((k + 0.5) / count)
                else:
                    drawn[name] = low + (high - low) * (((k + 0.5) * stride) % 1.0)
            self.all.append(TaskModel(task, drawn))

    def __len__(self) -> int:
        return len(self.all)

    def __getitem__(self, index: int) -> TaskModel:
        return self.all[index]
