"""Calibration of bending actuators from recorded tip motion; exported by sinew.pcc."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import BendingActuator

__all__ = ["BendingFit", "TipErrors", "TipRecord", "fit_modulus", "read_tip_record", "tip_errors"]


@dataclass(frozen=True)
class TipRecord:
    """Recorded motion of an actuator's tip.

    Attributes
    ----------
    time : (n,) ndarray
        s, increasing; may be uneven and have gaps.
    tip : (n, 2) ndarray
        Lateral position and height relative to the base, m.
    pressure : (n,) ndarray or None
        Pa; required by a fit.
    name : str
        Name used in messages.
    """

    time: ArrayLike
    tip: ArrayLike
    pressure: Optional[ArrayLike] = None
    name: str = "record"


@dataclass(frozen=True)
class TipErrors:
    """Errors of a simulated tip motion.

    Attributes
    ----------
    mean, largest : float
        Distance from the measured tip, m.
    mean_of_length, largest_of_length : float
        The same divided by the length of the actuator.
    mean_absolute, root_mean_square : (2,) ndarray
        MAE and RMSE of x and height, m.
    """

    mean: float
    largest: float
    mean_of_length: float
    largest_of_length: float
    mean_absolute: NDArray[np.float64]
    root_mean_square: NDArray[np.float64]


@dataclass(frozen=True)
class BendingFit:
    """Result of fit_modulus().

    Attributes
    ----------
    actuator : BendingActuator
        The given actuator with the fitted values.
    tips : list of (n, 2) ndarray
        Simulated tip motion of each record, m.
    errors : list of TipErrors
        Errors for each record.
    cost : float
        Mean squared distance divided by the squared length, with equal weights for all records.
    converged : bool
    at_bound : bool
        Whether a value is at its bound.
    """

    actuator: BendingActuator
    tips: list[NDArray[np.float64]] = field(repr=False)
    errors: list[TipErrors]
    cost: float
    converged: bool
    at_bound: bool


def read_tip_record(path: Union[str, os.PathLike[str]]) -> TipRecord:
    """Reads a table (CSV) whose header names columns and units.

    Parameters
    ----------
    path : path-like
        Columns time, x, y (or z, the height) and optionally pressure, such as "time_s", "x [mm]",
        "y_m", "pressure_kPa". Other columns are ignored.

    Returns
    -------
    TipRecord

    Raises
    ------
    Error
        With file and line: wrong-columns, malformed-table, non-monotonic-time, too-few-points.
    """
    return TipRecord(*_core._read_tip_record(os.fspath(path)))


def tip_errors(found: ArrayLike, measured: ArrayLike, length: float) -> TipErrors:
    """Errors between two motions of a tip.

    Parameters
    ----------
    found, measured : (n, 2) array_like
        m.
    length : float
        Length of the actuator, m.

    Returns
    -------
    TipErrors
    """
    return TipErrors(**_core._tip_errors(found, measured, length))


def fit_modulus(
    actuator: BendingActuator,
    records: Union[TipRecord, Iterable[TipRecord]],
    *,
    degree: int = 0,
    kind: str = "bending",
    bounds: tuple[float, float] = (1e3, 1e9),
    damping: bool = False,
    highest_damping: float = 1.0,
    longest_step: float = 5e-3,
    integrator: str = "generalized-alpha",
    spectral_radius: float = 0.8,
) -> BendingFit:
    """Fits the modulus of an actuator to recorded tip motion, by bounded least squares.

    Every record starts at rest, in the equilibrium of its first pressure.

    Parameters
    ----------
    actuator : BendingActuator
        Gives all other parameters and the initial modulus.
    records : TipRecord or iterable of TipRecord
        Records with pressures.
    degree : int
        Degree of the polynomial E(P), 0 (constant) to 5. It is fitted by its values at degree + 1
        pressures and is valid in the pressure range of the records only.
    kind : {'shear', 'young', 'bending'}
        Modulus to fit; see BendingModulus.
    bounds : tuple of float
        Bounds on these values, Pa.
    damping : bool
        Whether to fit the stiffness damping (Rayleigh's beta) too, up to `highest_damping` (s).
    longest_step : float
        s.
    integrator, spectral_radius
        See BendingActuator.simulate().

    Returns
    -------
    BendingFit

    Raises
    ------
    Error
        missing-key for a record without pressures, out-of-range, contradictory-limits.
    RunError
        not-converged if the initial actuator cannot be simulated.
    """
    given = [records] if isinstance(records, TipRecord) else list(records)
    found = _core._fit_modulus(
        actuator, given, degree, kind, bounds, damping, highest_damping, longest_step, integrator,
        spectral_radius,
    )
    errors = [TipErrors(**each) for each in found.pop("errors")]
    return BendingFit(errors=errors, **found)


for _name in __all__:
    globals()[_name].__module__ = "sinew.pcc"
del _name
