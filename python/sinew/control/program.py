"""Quadratic program of a loop's step: changes of efforts over a horizon, within all limits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import qp
from ..errors import Error, RunError
from .robot import Answer, Robot

__all__ = ["Choice", "Standing", "Weights", "choose"]


class Standing(NamedTuple):
    """Present state of the actuators.

    Attributes
    ----------
    efforts, motions : (actuators,)
        Of the model.
    commands : (actuators,)
        Last commands, motions or efforts.
    slack : (actuators,) bool
    """

    efforts: np.ndarray
    motions: np.ndarray
    commands: np.ndarray
    slack: np.ndarray


class Weights(NamedTuple):
    """Weights of the program. `change` and `relaxation` have no unit: they are relative to how far a unit of the efforts'
    energy moves the effectors.

    Attributes
    ----------
    rows : (rows,)
        Of the squared errors of the effectors.
    change : float
        Of the changes of efforts from step to step, |du|^2 in W_aa.
    relaxation : float
        Of the efforts themselves, |lambda|^2 in W_aa: among efforts that move the effectors equally, they slowly approach
        the smallest.
    """

    rows: np.ndarray
    change: float
    relaxation: float

    @classmethod
    def checked(cls, rows: np.ndarray, change: float, relaxation: float, place: str) -> "Weights":
        """Checked weights. Raises Error: out-of-range."""
        for name, value in (("change", change), ("relaxation", relaxation)):
            if not (np.isfinite(value) and value >= 0.0):
                raise Error("out-of-range", f"{place}({name})", f"it is {value!r}", "give a finite number of 0 or more")
        return cls(rows, float(change), float(relaxation))


class Choice(NamedTuple):
    """Solution of the program.

    Attributes
    ----------
    change : (actuators,)
        Change of the efforts in this step.
    sensitivity : (actuators, rows)
        d change / d (wanted motions, equal over the horizon), while the active limits stay active.
    limited : bool
        Whether a limit is active.
    conflict : bool
        Whether limits contradict each other; the limits of efforts are then relaxed.
    """

    change: np.ndarray
    sensitivity: np.ndarray
    limited: bool
    conflict: bool


def _reachable(limits: np.ndarray, now: np.ndarray, time_step: float) -> tuple[np.ndarray, np.ndarray]:
    """Range within the limits (min, max, rate) after a step from `now`. A value outside returns as fast as the rate allows."""
    reach = limits[2] * time_step
    lower, upper = np.maximum(limits[0], now - reach), np.minimum(limits[1], now + reach)
    nearest = np.where(now > limits[1], lower, upper)
    return np.where(lower > upper, nearest, lower), np.where(lower > upper, nearest, upper)


def _widened(interval: tuple[np.ndarray, np.ndarray], now: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Range widened to contain `now`."""
    return np.minimum(interval[0], now), np.maximum(interval[1], now)


def choose(robot: Robot, answer: Answer, standing: Standing, wanted: np.ndarray, weights: Weights,
           time_step: float) -> Choice:
    """Efforts lambda + z_j after the steps j = 1 .. N, z_0 = 0, that minimise

        sum_j |W_ea z_j - w_j|^2_Q + s change |z_j - z_(j-1)|^2_W_aa + s relaxation |lambda + z_j|^2_W_aa

    within the limits of efforts, motions m + W_aa z_j and rates. s makes the weights dimensionless: it is the mean over the
    actuators of how far their efforts, each scaled to the same energy, move the effectors.

    Parameters
    ----------
    robot, answer, standing
        Limits, response, and state of the actuators.
    wanted : (steps, rows)
        w_j, wanted motion of the effectors after each step.
    weights : Weights
    time_step : float
        s.
    """
    steps, count = len(wanted), len(standing.efforts)
    own = np.diag(answer.w_aa)
    scale = np.where(own > 0.0, 1.0 / np.sqrt(np.maximum(own, np.finfo(float).tiny)), 1.0)
    w_ea, energy = answer.w_ea * scale, scale[:, None] * 0.5 * (answer.w_aa + answer.w_aa.T) * scale
    weighted = w_ea.T * weights.rows
    reached = weighted @ w_ea
    size = max(np.trace(reached) / count, np.finfo(float).tiny)
    pull, damp = size * weights.relaxation * energy, size * weights.change * energy

    difference = np.eye(steps) - np.eye(steps, k=-1)  # z_j - z_(j-1)
    hessian = np.kron(np.eye(steps), reached + pull + 1e-9 * size * np.eye(count))
    hessian += np.kron(difference.T @ difference, damp)
    sources = np.tile(weighted, (steps, 1))  # d gradient / d wanted, for one motion wanted in all steps
    gradient = -(wanted @ weighted.T).ravel() + np.tile(pull @ (standing.efforts / scale), steps)

    rows, row_lower, row_upper = _motion_rows(robot, answer, standing, steps, time_step)
    rows = rows * np.tile(scale, steps)
    within = np.clip(standing.efforts, robot.effort_limits[0], robot.effort_limits[1])
    first = _reachable(robot.effort_limits, standing.efforts, time_step)
    later = robot.effort_limits[:2]

    def solve(widen: bool) -> qp.QuadraticSolution:
        bounds = []
        for now, then in zip(*((_widened(each, standing.efforts) if widen else each) for each in (first, later))):
            every = np.concatenate([now, np.tile(then, steps - 1)])
            bounds.append((every - np.tile(standing.efforts, steps)) / np.tile(scale, steps))
        return qp.solve_quadratic(hessian, gradient, *bounds, rows, row_lower, row_upper)

    # The motion limits always contain the present state. Efforts beyond their limits return to them if the motion limits permit.
    found = solve(False)
    conflict = found.status == "infeasible" and bool((within != standing.efforts).any())
    if conflict:
        found = solve(True)
    if found.status != "optimal":
        raise RunError("not-converged", "step()", f"the program of this step is {found.status}",
                       "check the limits of the actuators and the weights of the effectors")
    active = np.vstack([np.eye(steps * count)[found.bound_multiplier != 0.0], rows[found.row_multiplier != 0.0]])
    sensitivity = _sensitivity(hessian, sources, active)[:count]
    return Choice(scale * found.x[:count], scale[:, None] * sensitivity, len(active) > 0, conflict)


def _motion_rows(robot: Robot, answer: Answer, standing: Standing, steps: int,
                 time_step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows over (z_1 .. z_N) for the finite limits of motions and of their rates.

    A slack cable may be shorter than its path through the body by any length: it has no lower limits.
    """
    count = len(standing.motions)
    before = np.where(robot.by_motion, standing.commands, standing.motions)
    first_lower, first_upper = _widened(_reachable(robot.motion_limits, before, time_step), standing.motions)
    lowest, highest = _widened(tuple(robot.motion_limits[:2]), standing.motions)
    reach = robot.motion_limits[2] * time_step
    first_lower, lowest = (np.where(standing.slack, -np.inf, each) for each in (first_lower, lowest))
    later = steps - 1
    changes = np.kron(np.eye(steps) - np.eye(steps, k=-1), answer.w_aa)[count:]
    rows = np.vstack([np.kron(np.eye(steps), answer.w_aa), changes])
    least = np.where(standing.slack, -np.inf, -reach)
    lower = np.concatenate([first_lower, np.tile(lowest, later)]) - np.tile(standing.motions, steps)
    upper = np.concatenate([first_upper, np.tile(highest, later)]) - np.tile(standing.motions, steps)
    lower, upper = np.append(lower, np.tile(least, later)), np.append(upper, np.tile(reach, later))
    finite = np.isfinite(lower) | np.isfinite(upper)
    return rows[finite], lower[finite], upper[finite]


def _sensitivity(hessian: np.ndarray, sources: np.ndarray, active: np.ndarray) -> np.ndarray:
    """dz/dw of min 1/2 z^T G z - (B w)^T z with A z = b: by the Schur complement of the active rows."""
    free = np.linalg.solve(hessian, np.hstack([sources, active.T]))
    columns = sources.shape[1]
    if not len(active):
        return free
    own = active @ free[:, columns:]
    return free[:, :columns] - free[:, columns:] @ np.linalg.lstsq(own, active @ free[:, :columns], rcond=1e-12)[0]
