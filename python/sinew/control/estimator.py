"""The error of a model's Jacobian, estimated from measured motions."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np

from ..errors import Error

__all__ = ["JacobianEstimator"]


class JacobianEstimator:
    """Recursive least squares for E in J_real = (I + E) J_model, with a prior and with forgetting towards it.

    A motion dx that the model makes is measured as (I + E) dx + noise. Before anything is measured, the entries of E are
    independent with standard deviation `spread`. Row i of E has the information matrix Lambda_i and the vector b_i:

        S <- phi S + dx dx^T,   Lambda_i = S/r_i + I/spread^2,   b_i <- phi b_i + dx (dy - dx)_i/r_i,   E_i = Lambda_i^-1 b_i,

    r_i = 2 noise_i^2 (dy is a difference of two measurements). Forgetting goes to the prior and not to no knowledge at all,
    so that Lambda_i stays bounded while the robot rests (stabilised forgetting: Kulhavy & Zarrop, Int. J. Control 58 (1993)
    905-924). The memory lasts 1/(1 - phi) updates.

    Only what the robot does shows: E is known in the directions in which it moves, by much more than noise.

    Parameters
    ----------
    noise : (rows,) array_like
        m or rad, standard deviation of a measurement.
    spread : float
        Standard deviation of the relative error of the model's Jacobian.
    forgetting : float
        phi, above 0, at most 1.

    Raises
    ------
    Error
        out-of-range.
    """

    def __init__(self, noise: Sequence[float], *, spread: float = 0.3, forgetting: float = 0.98) -> None:
        self.noise = np.array(noise, dtype=float)
        for name, value, good in (("noise", self.noise, (self.noise > 0.0).all()), ("spread", spread, spread > 0.0),
                                  ("forgetting", forgetting, 0.0 < forgetting <= 1.0)):
            if not (good and np.isfinite(value).all()):
                raise Error("out-of-range", f"JacobianEstimator({name})", f"it is {value}",
                            "give finite noise and spread above 0, forgetting in (0, 1]")
        self.spread, self.forgetting = float(spread), float(forgetting)
        self.updates = 0
        count = len(self.noise)
        self._squares = np.zeros((count, count))  # S
        self._weighted = np.zeros((count, count))  # b_i r_i, a column each

    def clone(self) -> "JacobianEstimator":
        """Another one that has learned the same."""
        other = JacobianEstimator(self.noise, spread=self.spread, forgetting=self.forgetting)
        other.restore(self.state())
        return other

    def state(self) -> tuple:
        """What it has learned, as a value."""
        return self.updates, self._squares.copy(), self._weighted.copy()

    def restore(self, state: tuple) -> None:
        """Takes up a state()."""
        self.updates, self._squares, self._weighted = state[0], state[1].copy(), state[2].copy()

    def update(self, modelled: np.ndarray, measured: np.ndarray) -> None:
        """Learns from a motion.

        Parameters
        ----------
        modelled, measured : (rows,) m or rad
            What the model did and what the robot was measured to do at the same commands.
        """
        self._squares = self.forgetting * self._squares + np.outer(modelled, modelled)
        self._weighted = self.forgetting * self._weighted + np.outer(modelled, measured - modelled)
        self.updates += 1

    def error(self) -> np.ndarray:
        """E (rows, rows), the most likely one."""
        rows = []
        for row, noise in enumerate(self.noise):
            rows.append(np.linalg.solve(self._information(noise), self._weighted[:, row] / (2.0 * noise**2)))
        return np.array(rows)

    def std(self, left: np.ndarray, right: np.ndarray) -> float:
        """Standard deviation of left^T E right.

        Parameters
        ----------
        left, right : (rows,)
        """
        variance = sum(float(part**2 * (right @ np.linalg.solve(self._information(noise), right)))
                       for part, noise in zip(left, self.noise))
        return math.sqrt(max(variance, 0.0))

    def _information(self, noise: float) -> np.ndarray:
        """Lambda_i."""
        return self._squares / (2.0 * noise**2) + np.eye(len(self.noise)) / self.spread**2
