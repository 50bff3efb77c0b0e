"""Closed-loop control: commands for a robot from measured effectors and a model that runs in parallel.

    loop = sinew.control.ClosedLoop(model, {"tip": [0.03, 0.0, 0.18]}, sensors={"tip": plant.sensor("camera")})
    commands = loop.step(time=plant.time)              # {"long_0": 0.012, ...}: loop.quantities gives the quantities
    loop.send(plant, commands)                         # or to the motors of a robot
    loop.status, loop.errors, loop.least_eigenvalue

`PredictiveController` has the same interface and predicts over a horizon. docs/closed_loop.md has the equations, the
condition of convergence and measured results. SI units everywhere.
"""

from .closed_loop import ClosedLoop
from .estimator import JacobianEstimator
from .gains import Gains, Schedule, delay_limit
from .jacobian import jacobian
from .predictive import PredictiveController

__all__ = ["ClosedLoop", "Gains", "JacobianEstimator", "PredictiveController", "Schedule", "delay_limit", "jacobian"]
