"""How motions and efforts of rows answer to forces and commands, everything else obeying its law."""

from __future__ import annotations

import re

import numpy as np

from .. import _core

__all__ = ["Response"]

_CONTACT = re.compile(r"(?P<name>.+) point (?P<point>\d+) normal$")
_MOTIONS = {"displacement", "angle", "volume_growth"}
_ROW_TYPES = {"cable", "force", "pressure"}
_CLOSED = 1e-9  # of the largest effort: a contact or a cable below it has no force
_SLIDES = 1e-6  # of friction's limit: nearer to it a point slides


def has_rows_alone(sim: _core.Simulation) -> bool:
    """Whether rows obey laws that Response knows: no springs, drives, friction of cables, joints that are driven."""
    actuators = sim.actuators
    if any(a.type not in _ROW_TYPES or a.command[0] in ("gas", "liquid", "power", "phase") for a in actuators.values()):
        return False
    known = set(actuators) | {f"{name}.{axis}" for name in sim.effectors for axis in "xyz"}
    known |= {f"{name}[{k}]" for name in sim.effectors for k in range(3)}
    return all(row in known or re.search(r" point \d+ (normal|tangent [12])$", row) for row in sim.rows)


class Response:
    """Derivatives of a static equilibrium by efforts and held motions, from one linearisation.

    With delta = delta_free + W lambda, rows that hold their motions p (commanded lengths, closed contacts) take
    the efforts
        dlambda_h = M^-1 (dp - W_hE dlambda_E),    M = W_hh B,
    where E are rows of given effort and B is the identity, but for a sliding contact, whose friction grows with its
    normal force, lambda_t = (lambda_t/lambda_n) lambda_n. A slack cable and an open point have no effort. The direction of
    sliding is held.

    Parameters
    ----------
    sim : sinew.Simulation
        In equilibrium.
    linear : sinew.Linearisation
        Of it.
    """

    def __init__(self, sim: _core.Simulation, linear: _core.Linearisation) -> None:
        self.linear = linear
        self.rows = {name: k for k, name in enumerate(linear.rows)}
        self._compliance, self._effort = linear.W, linear.effort
        self.held: list[int] = []
        self._basis: list[np.ndarray] = []
        self._scale = np.abs(self._effort).max(initial=0.0)
        self._hold_actuators(sim)
        self._hold_contacts(sim)
        basis = np.array(self._basis).reshape(-1, len(linear.rows)).T
        own = self._compliance[self.held] @ basis
        size = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(own)), 1e-300))
        # Cables on one path repeat each other: the efforts of least norm.
        inverse = size[:, None] * np.linalg.pinv(size[:, None] * own * size, rcond=1e-12) * size
        self._efforts = basis @ inverse  # (rows, held): efforts of all rows for held motions
        self._motions = self._compliance @ self._efforts  # (rows, held): their motions

    def _hold(self, row: int, efforts: dict[int, float]) -> None:
        direction = np.zeros(len(self.linear.rows))
        for other, share in efforts.items():
            direction[other] = share
        self.held.append(row)
        self._basis.append(direction)

    def _hold_actuators(self, sim: _core.Simulation) -> None:
        for name, actuator in sim.actuators.items():
            row, (kind, _) = self.rows[name], actuator.command
            if kind not in _MOTIONS:
                continue
            effort = next((limit for quantity, limit in actuator.limits.items() if quantity not in _MOTIONS), None)
            free = _CLOSED * max(self._scale, 1e-12)
            low = actuator.type == "cable" and self._effort[row] <= free
            high = effort is not None and np.isfinite(effort.max) and self._effort[row] >= effort.max - free
            if not (low or high):
                self._hold(row, {row: 1.0})

    def _hold_contacts(self, sim: _core.Simulation) -> None:
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
        """Of all rows' motions and efforts for loads which alone would move the rows by `columns`.

        Parameters
        ----------
        columns : (rows, k) ndarray
            m/N.

        Returns
        -------
        tuple of (rows, k) ndarray
            Motions, and efforts apart from the loads themselves.
        """
        held = columns[self.held]
        return columns - self._motions @ held, -self._efforts @ held

    def to_effort(self, row: int) -> tuple[np.ndarray, np.ndarray]:
        """(rows,) motions and efforts of all rows for a unit effort of a row that is given."""
        motions, efforts = self.to_columns(self._compliance[:, [row]])
        efforts[row] += 1.0
        return motions[:, 0], efforts[:, 0]

    def to_motion(self, row: int) -> tuple[np.ndarray, np.ndarray]:
        """The same for a unit motion of a row whose motion is commanded; zero where it is slack or stalled."""
        if row not in self.held:
            return np.zeros(len(self.rows)), np.zeros(len(self.rows))
        at = self.held.index(row)
        return self._motions[:, at], self._efforts[:, at]
