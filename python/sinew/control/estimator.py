"""Estimates the error of a model's Jacobian from measured motions."""

from __future__ import annotations

import math
from typing import Sequence

import numpy as np

from ..errors import Error

__all__ = ["JacobianEstimator"]


class JacobianEstimator:
    """Recursive least squares for E in J_real = (I + E) J_model, with a prior and with forgetting towards the prior.

    A motion dx of the model is measured as dy = (I + E) dx + noise. A priori, the entries of E are independent with
    standard deviation `spread`. Row i of E has the information matrix Lambda_i = A_i + I/spread^2 and the vector b_i,

        A_i <- phi A_i + dx dx^T/r_i,    b_i <- phi b_i + dx (dy - dx)_i/r_i,    E_i = Lambda_i^-1 b_i,
        r_i = 2 noise_i^2 + (spread |dx|)^2.

    The first term of r_i appears because dy is a difference of two measurements. The second one appears because E changes
    along the motion (model and robot bend at different places): a single motion, however long, has no more weight than
    the prior. Forgetting leads back to the prior and not to zero information, so Lambda_i stays bounded while the robot
    rests (stabilised forgetting: Kulhavy & Zarrop, Int. J. Control 58 (1993) 905-924). The memory is 1/(1 - phi) updates
    long.

    E is determined only in directions in which the robot moves by much more than the noise.

    Parameters
    ----------
    noise : (rows,) array_like
        Standard deviation of a measurement, m or rad.
    spread : float
        Standard deviation of the relative error of the model's Jacobian.
    forgetting : float
        phi, above 0, at most 1.

    Raises
    ------
    Error
        out-of-range.
    """

    def __init__(self, noise: Sequence[float], *, spread: float = 0.3, forgetting: float = 0.9) -> None:
        self.noise = np.array(noise, dtype=float)
        for name, value, good in (("noise", self.noise, (self.noise > 0.0).all()), ("spread", spread, spread > 0.0),
                                  ("forgetting", forgetting, 0.0 < forgetting <= 1.0)):
            if not (good and np.isfinite(value).all()):
                raise Error("out-of-range", f"JacobianEstimator({name})", f"it is {value}",
                            "give finite noise and spread above 0, forgetting in (0, 1]")
        self.spread, self.forgetting = float(spread), float(forgetting)
        self.updates = 0
        count = len(self.noise)
        self._information = np.zeros((count, count, count))  # A_i
        self._weighted = np.zeros((count, count))  # b_i, one per row

    def clone(self) -> "JacobianEstimator":
        """A copy with the same information."""
        other = JacobianEstimator(self.noise, spread=self.spread, forgetting=self.forgetting)
        other.restore(self.state())
        return other

    def state(self) -> tuple:
        """The information collected so far, as a value."""
        return self.updates, self._information.copy(), self._weighted.copy()

    def restore(self, state: tuple) -> None:
        """Restores a state()."""
        self.updates, self._information, self._weighted = state[0], state[1].copy(), state[2].copy()

    def update(self, modelled: np.ndarray, measured: np.ndarray) -> None:
        """Updates the estimate with one motion.

        Parameters
        ----------
        modelled, measured : (rows,) m or rad
            Motion of the model, and measured motion of the robot, under the same commands.
        """
        weight = 1.0 / (2.0 * self.noise**2 + self.spread**2 * (modelled @ modelled))
        self._information = self.forgetting * self._information + weight[:, None, None] * np.outer(modelled, modelled)
        self._weighted = self.forgetting * self._weighted + np.outer(weight * (measured - modelled), modelled)
        self.updates += 1

    def error(self) -> np.ndarray:
        """Most likely E, (rows, rows)."""
        return np.linalg.solve(self._with_prior(), self._weighted[:, :, None])[:, :, 0]

    def std(self, left: np.ndarray, right: np.ndarray) -> float:
        """Standard deviation of left^T E right.

        Parameters
        ----------
        left, right : (rows,)
        """
        every = np.broadcast_to(right[:, None], (len(left), len(right), 1))
        variances = np.linalg.solve(self._with_prior(), every)[:, :, 0] @ right
        return math.sqrt(max(float(left**2 @ variances), 0.0))

    def _with_prior(self) -> np.ndarray:
        """Information matrices Lambda_i of all rows."""
        return self._information + np.eye(len(self.noise)) / self.spread**2
