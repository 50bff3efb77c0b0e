"""Jacobian of a robot: effectors as a function of commands at equilibrium."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from .robot import Robot

__all__ = ["condensed", "jacobian"]


def condensed(w_ea: np.ndarray, w_aa: np.ndarray, by_motion: np.ndarray, slack: np.ndarray) -> np.ndarray:
    """J (rows, actuators) of the effectors with respect to commands, from W_ea and W_aa.

    With motions s of the actuators M that are commanded in motion, and efforts of the others F,
        lambda_M = W_MM^+ (s - W_MF lambda_F),   J_M = W_eM W_MM^+,   J_F = W_eF - J_M W_MF.
    A slack cable moves nothing, so its column is zero. W_MM is scaled to a unit diagonal, and W_MM^+ omits directions with
    eigenvalues below 1e-9 of the largest one: two cables on one line have one motion.

    Parameters
    ----------
    w_ea : (rows, actuators)
    w_aa : (actuators, actuators)
    by_motion, slack : (actuators,) bool
    """
    result = np.where(slack, 0.0, w_ea)
    held = by_motion & ~slack
    if not held.any():
        return result
    own = w_aa[np.ix_(held, held)]
    scale = 1.0 / np.sqrt(np.maximum(np.diag(own), np.finfo(float).tiny))
    inverse = scale[:, None] * np.linalg.pinv(scale[:, None] * own * scale, rcond=1e-9) * scale
    result[:, held] = w_ea[:, held] @ inverse
    others = ~by_motion & ~slack
    result[:, others] = w_ea[:, others] - result[:, held] @ w_aa[np.ix_(held, others)]
    return result


def jacobian(
    sim: Any,
    effectors: Sequence[str],
    actuators: Optional[Sequence[str]] = None,
    *,
    command: Union[str, Mapping[str, str], None] = None,
) -> np.ndarray:
    """Jacobian of a simulation: motion of effectors per command of actuators, at equilibrium near the present state.

    It contains no inertia (Simulation.response(statics=True)). Contact points and cables at guides keep sticking or
    sliding. In a twin test this is the exact Jacobian of the plant.

    Parameters
    ----------
    sim : Simulation
    effectors : list of str
    actuators : list of str, optional
        All by default.
    command : 'motion', 'effort' or dict, optional
        Commanded quantity of the actuators, see ClosedLoop.

    Returns
    -------
    (rows, actuators) ndarray
        Rows: directions of the effectors, one after the other. m/m for cables commanded in displacement, m/N for those
        commanded in tension, and so on.

    Raises
    ------
    Error
        unknown-name, unknown-choice, no-effectors. RunError: singular-matrix.
    """
    if isinstance(effectors, str) or not len(effectors):
        raise Error("no-effectors", "jacobian(effectors)", f"{effectors!r} names none", "give a list such as ['tip']")
    robot = Robot(sim, list(effectors), actuators, command, "jacobian")
    return robot.response().jacobian
