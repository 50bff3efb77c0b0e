"""Jacobian of a robot: effectors as a function of commands at equilibrium."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from .robot import Robot

__all__ = ["jacobian"]


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
