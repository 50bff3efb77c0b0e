"""The error of a model's Jacobian, estimated from commands and measured motions."""

from __future__ import annotations

import math

import numpy as np

from ..errors import Error

__all__ = ["JacobianEstimator"]


class JacobianEstimator:
    """Recursive least squares for D = J_real - J_model, with a prior and with forgetting towards it.

    A measured motion dx differs from the one that the model makes at the same commands by D dc + noise. With c scaled
    so that J_model's columns have length `size`, D has independent entries of standard deviation spread * size before
    anything is measured, and every row of D the same information matrix Lambda and its own vector b:

        Lambda <- phi Lambda + (1 - phi) Lambda_0 + dc dc^T/r,    b <- phi b + dc (dx - dx_model)^T/r,    D^T = Lambda^-1 b,

    Lambda_0 = I/(spread size)^2, r = 2 noise^2 (a difference of two measurements). Forgetting goes to the prior and not
    to no knowledge at all, so that Lambda stays bounded while commands rest (stabilised forgetting: Kulhavy & Zarrop, Int.
    J. Control 58 (1993) 905-924). The memory lasts 1/(1 - phi) updates.

    Parameters
    ----------
    rows, commands : int
    spread : float
        Standard deviation of the error of the model's Jacobian, relative to its size.
    noise : float
        m, standard deviation of a measurement.
    forgetting : float
        phi, above 0, at most 1.
    window : int
        Samples from one measured difference to the next: they share no measurement but its ends.
    """

    def __init__(self, rows: int, commands: int, *, spread: float = 0.3, noise: float = 1e-4, forgetting: float = 0.98,
                 window: int = 5) -> None:
        for name, value, good in (("spread", spread, spread > 0.0), ("noise", noise, noise > 0.0),
                                  ("forgetting", forgetting, 0.0 < forgetting <= 1.0), ("window", window, window >= 1)):
            if not (good and math.isfinite(value)):
                raise Error("out-of-range", f"JacobianEstimator({name})", f"it is {value}",
                            "give spread and noise above 0, forgetting in (0, 1], window 1 or more")
        self.spread, self.noise, self.forgetting, self.window = spread, noise, forgetting, int(window)
        self.updates = 0
        self._information = np.zeros((commands, commands))  # without the prior's
        self._weighted = np.zeros((commands, rows))
        self._scale = np.zeros(commands)  # of the commands; set by the first Jacobian

    def clone(self) -> "JacobianEstimator":
        """Another one that has learned the same."""
        other = JacobianEstimator(self._weighted.shape[1], len(self._scale), spread=self.spread, noise=self.noise,
                                  forgetting=self.forgetting, window=self.window)
        other.restore(self.state())
        return other

    def state(self) -> tuple:
        """What it has learned, as a value."""
        return self.updates, self._information.copy(), self._weighted.copy(), self._scale.copy()

    def restore(self, state: tuple) -> None:
        """Takes up a state()."""
        self.updates = state[0]
        self._information, self._weighted, self._scale = (each.copy() for each in state[1:])

    def _prior(self, model: np.ndarray) -> float:
        """Of a scaled entry of D, 1/m^2. The scale of each command is that of the first model seen."""
        columns = np.linalg.norm(model, axis=0)
        size = max(columns.max(initial=0.0), np.finfo(float).tiny)
        if not self._scale.any():
            self._scale = 1.0 / np.maximum(columns, 0.1 * size)
        return 1.0 / self.spread**2

    def update(self, model: np.ndarray, command: np.ndarray, unexplained: np.ndarray) -> None:
        """Learns from a difference of two measurements.

        Parameters
        ----------
        model : (rows, commands)
            J_model.
        command : (commands,)
            Difference of the commands that caused it.
        unexplained : (rows,) m or rad
            Measured difference less that of the model.
        """
        self._prior(model)
        scaled = command / self._scale
        weight = 1.0 / (2.0 * self.noise**2)
        self._information = self.forgetting * self._information + weight * np.outer(scaled, scaled)
        self._weighted = self.forgetting * self._weighted + weight * np.outer(scaled, unexplained)
        self.updates += 1

    def error(self, model: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """D (rows, commands), and the covariance (commands, commands) that each of its rows has.

        Parameters
        ----------
        model : (rows, commands)
            J_model.
        """
        prior = self._prior(model)
        covariance = np.linalg.inv(self._information + prior * np.eye(len(self._scale)))
        error = (covariance @ self._weighted).T
        return error / self._scale, covariance / np.outer(self._scale, self._scale)
