"""Response of the motions and efforts of rows to forces and commands, with all other laws active."""

from __future__ import annotations

import math
import re
from typing import NamedTuple, Optional

import numpy as np

from .. import _core

__all__ = ["Response"]

_CONTACT = re.compile(r"(?P<name>.+) point (?P<point>\d+) normal$")
_MOTIONS = {"displacement", "angle", "volume_growth"}
_ROW_TYPES = {"cable", "force", "chamber", "torque"}
_CLOSED = 1e-9  # fraction of the largest effort below which a contact or a cable counts as open or slack
_LARGEST = 1e10  # largest entry of the inverse at a unit diagonal; beyond it, rows are linearly dependent
_SLIDES = 1e-6  # relative distance from the friction limit below which a point slides


def has_rows_alone(sim: _core.Simulation) -> bool:
    """Whether all rows obey laws that Response knows: no springs, drives, cable friction or driven joints."""
    actuators = sim.actuators
    if any(a.type not in _ROW_TYPES or a.command[0] in ("gas", "liquid", "power", "phase") for a in actuators.values()):
        return False
    known = set(actuators) | {f"{name}.{axis}" for name in sim.effectors for axis in "xyz"}
    known |= {f"{name}[{k}]" for name in sim.effectors for k in range(3)}
    return all(row in known or re.search(r" point \d+ (normal|tangent [12])$", row) for row in sim.rows)


class Response:
    """Derivatives of a static equilibrium with respect to efforts and held motions, from one linearisation.

    With delta = delta_free + W lambda, rows that hold their motions p (commanded lengths, closed contacts) have the efforts
        dlambda_h = M^-1 (dp - W_hE dlambda_E),    M = W_hh B,
    where E are the rows of given effort. B is the identity except for a sliding contact, whose friction grows with its
    normal force, lambda_t = (lambda_t/lambda_n) lambda_n, in a fixed direction. A slack cable and an open point have no
    effort.

    Parameters
    ----------
    sim : sinew.Simulation
        In equilibrium.
    linear : sinew.Linearisation
        Linearisation of `sim`.
    actuators : list of Drive, optional
        Actuators of the simulation, if they are known already.
    """

    def __init__(self, sim: _core.Simulation, linear: _core.Linearisation, actuators: Optional[list["DrivenActuator"]] = None) -> None:
        self.linear = linear
        self.rows = {name: k for k, name in enumerate(linear.rows)}
        self._compliance, self._effort = linear.W, linear.effort
        self.held: list[int] = []
        self._basis: list[np.ndarray] = []
        self._scale = np.abs(self._effort).max(initial=0.0)
        self._hold_actuators(drives(sim) if actuators is None else actuators)
        self._hold_contacts(sim)
        basis = np.array(self._basis).reshape(-1, len(linear.rows)).T
        self._efforts = basis @ _inverse(self._compliance[self.held] @ basis)  # (rows, held): efforts of all rows per unit held motion
        self._motions = self._compliance @ self._efforts  # (rows, held): motions of all rows

    def _hold(self, row: int, efforts: dict[int, float]) -> None:
        direction = np.zeros(len(self.linear.rows))
        for other, share in efforts.items():
            direction[other] = share
        self.held.append(row)
        self._basis.append(direction)

    def _hold_actuators(self, actuators: list["DrivenActuator"]) -> None:
        least = _CLOSED * max(self._scale, 1e-12)
        for drive in actuators:
            row = self.rows[drive.name]
            slack = drive.pulls_only and self._effort[row] <= least
            if drive.holds_motion and not slack and self._effort[row] < drive.most - least:
                self._hold(row, {row: 1.0})

    def _hold_contacts(self, sim: _core.Simulation) -> None:
        if len(self.rows) == sum(" " not in name for name in self.rows):
            return
        friction = {name: contact.friction for name, contact in sim.contacts.items()}
        for name, row in self.rows.items():
            match = _CONTACT.match(name)
            if match is None or self._effort[row] <= _CLOSED * self._scale:
                continue
            normal, limit = self._effort[row], friction[match["name"]] * self._effort[row]
            tangents = self._effort[row + 1:row + 3]
            if limit == 0.0:
                self._hold(row, {row: 1.0})
            elif np.hypot(*tangents) >= (1.0 - _SLIDES) * limit:
                self._hold(row, {row: 1.0, row + 1: tangents[0] / normal, row + 2: tangents[1] / normal})
            else:
                for k in range(3):
                    self._hold(row + k, {row + k: 1.0})

    def to_columns(self, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Motions and efforts of all rows for loads that by themselves would move the rows by `columns`.

        Parameters
        ----------
        columns : (rows, k) ndarray
            m/N.

        Returns
        -------
        tuple of (rows, k) ndarray
            Motions, and efforts without the loads themselves.
        """
        held = columns[self.held]
        return columns - self._motions @ held, -self._efforts @ held

    def to_efforts(self, rows: list[int]) -> tuple[np.ndarray, np.ndarray]:
        """(rows, k) motions and efforts of all rows for unit efforts of k rows with given efforts."""
        motions, efforts = self.to_columns(self._compliance[:, rows])
        efforts[rows, np.arange(len(rows))] += 1.0
        return motions, efforts

    def to_motions(self, rows: list[int]) -> tuple[np.ndarray, np.ndarray]:
        """The same for unit motions of rows with commanded motions; zero for slack or stalled ones."""
        count = len(self.linear.effort)
        motions, efforts = np.zeros((count, len(rows))), np.zeros((count, len(rows)))
        for k, row in enumerate(rows):
            if row in self.held:
                at = self.held.index(row)
                motions[:, k], efforts[:, k] = self._motions[:, at], self._efforts[:, at]
        return motions, efforts


class DrivenActuator(NamedTuple):
    """Data of an actuator that Response needs."""

    name: str
    pulls_only: bool
    holds_motion: bool  # commanded in motion
    most: float  # N, upper limit of its effort


def drives(sim: _core.Simulation) -> list[DrivenActuator]:
    """All actuators with their present commands."""
    found = []
    for name, actuator in sim.actuators.items():
        most = next((limit.max for quantity, limit in actuator.limits.items() if quantity not in _MOTIONS), math.inf)
        found.append(DrivenActuator(name, actuator.pulls_only, actuator.command[0] in _MOTIONS, most))
    return found


def _inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverse; if rows repeat each other, as for cables on one path, the one that gives minimum-norm efforts."""
    if len(matrix) == 0:
        return matrix
    size = 1.0 / np.sqrt(np.maximum(np.abs(matrix.diagonal()), 1e-300))
    scaled = size[:, None] * matrix * size
    try:
        inverse = np.linalg.inv(scaled)
        if np.abs(inverse).max() < _LARGEST:
            return size[:, None] * inverse * size
    except np.linalg.LinAlgError:
        pass
    return size[:, None] * np.linalg.pinv(scaled, rcond=1.0 / _LARGEST) * size


class StandingRows:
    """The derivatives of Response for a robot without contacts, whose rows and laws do not change: fast enough for every filter step.

    Parameters
    ----------
    rows : list of str
        Of the simulation.
    actuators : list of DrivenActuator
    by_effort, by_motion : list of (int, str)
        Indices of the inputs with the rows whose effort or motion they are.
    motions, efforts : list of (int, str)
        Indices of the outputs with the rows whose motion or effort they are.
    """

    def __init__(self, rows: list[str], actuators: list[DrivenActuator], by_effort, by_motion, motions, efforts) -> None:
        at = {name: k for k, name in enumerate(rows)}
        self._holds = np.array([at[d.name] for d in actuators if d.holds_motion], int)
        self._cables = np.array([d.pulls_only for d in actuators if d.holds_motion], bool)
        self._most = np.array([d.most for d in actuators if d.holds_motion], float)
        self._effort_inputs, self._effort_rows = [k for k, _ in by_effort], np.array([at[r] for _, r in by_effort], int)
        self._motion_inputs = np.array([k for k, _ in by_motion], int)
        place = {row: k for k, row in enumerate(self._holds.tolist())}
        self._motion_places = np.array([place[at[r]] for _, r in by_motion], int)
        self._motion_outputs, self._motion_rows = [k for k, _ in motions], np.array([at[r] for _, r in motions], int)
        self._effort_outputs, self._told_rows = [k for k, _ in efforts], np.array([at[r] for _, r in efforts], int)
        self._inputs, self._outputs, self._rows = len(by_effort) + len(by_motion), len(motions) + len(efforts), len(rows)

    def __call__(self, linear: _core.Linearisation) -> tuple[np.ndarray, np.ndarray]:
        """(outputs,) readings without noise and (outputs, inputs) their derivative."""
        compliance, effort, delta = linear.W, linear.effort, linear.delta
        own = effort[self._holds]
        least = _CLOSED * max(np.abs(effort).max(), 1e-12)
        is_held = (own < self._most - least) & ~(self._cables & (own <= least))
        held = self._holds[is_held]
        right = np.zeros((len(self._holds), self._inputs))
        right[:, self._effort_inputs] = -compliance[self._holds[:, None], self._effort_rows]
        right[self._motion_places, self._motion_inputs] = 1.0
        to_held = compliance[:, held]
        answer = _inverse(to_held[held]) @ right[is_held]
        efforts = np.zeros((self._rows, self._inputs))
        efforts[held] = answer
        efforts[self._effort_rows, self._effort_inputs] += 1.0
        moved = to_held[self._motion_rows] @ answer
        moved[:, self._effort_inputs] += compliance[self._motion_rows[:, None], self._effort_rows]
        slope, numbers = np.empty((self._outputs, self._inputs)), np.empty(self._outputs)
        slope[self._motion_outputs], slope[self._effort_outputs] = moved, efforts[self._told_rows]
        numbers[self._motion_outputs], numbers[self._effort_outputs] = delta[self._motion_rows], effort[self._told_rows]
        return numbers, slope
