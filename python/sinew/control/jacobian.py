"""How effectors follow from commands at equilibrium: the robot's Jacobian."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from .robot import Robot

__all__ = ["condensed", "jacobian"]


def condensed(w_ea: np.ndarray, w_aa: np.ndarray, by_motion: np.ndarray, slack: np.ndarray) -> np.ndarray:
    """J (rows, actuators) of the effectors by commands, from W_ea and W_aa.

    Motions s of the actuators M that are commanded a motion, and efforts of the others F, give
        lambda_M = W_MM^+ (s - W_MF lambda_F),   J_M = W_eM W_MM^+,   J_F = W_eF - J_M W_MF.
    A slack cable moves nothing: its column is zero. W_MM is scaled to a diagonal of one, and directions whose
    eigenvalue is below 1e-9 of the largest are left out of W_MM^+: two cables on one line have one motion.

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
    """How effectors of a simulation follow from commands to its actuators at equilibrium, near its present state.

    Inertia has no part in it (Simulation.response(statics=True)). Contact points and cables at guides keep sticking
    or sliding. In a twin test this is the exact Jacobian of the plant.

    Parameters
    ----------
    sim : Simulation
    effectors : list of str
    actuators : list of str, optional
        All by default.
    command : 'motion', 'effort' or dict, optional
        What they are commanded, see ClosedLoop.

    Returns
    -------
    (rows, actuators) ndarray
        Rows: directions of the effectors, one after the other. m/m for cables commanded a displacement, m/N for those
        commanded a tension, and so on.

    Raises
    ------
    Error
        unknown-name, unknown-choice, no-effectors. RunError: singular-matrix.
    """
    if isinstance(effectors, str) or not len(effectors):
        raise Error("no-effectors", "jacobian(effectors)", f"{effectors!r} names none", "give a list such as ['tip']")
    robot = Robot(sim, list(effectors), actuators, command, "jacobian")
    return robot.response().jacobian
