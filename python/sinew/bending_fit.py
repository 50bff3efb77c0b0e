"""Calibration of bending actuators from recorded tips; sinew.pcc has these names."""

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
    """A recorded motion of an actuator's tip.

    Attributes
    ----------
    time : (n,) ndarray
        s, increasing; may be uneven and have gaps.
    tip : (n, 2) ndarray
        x aside and height, m from the base.
    pressure : (n,) ndarray or None
        Pa; a fit needs it.
    name : str
        For messages.
    """

    time: ArrayLike
    tip: ArrayLike
    pressure: Optional[ArrayLike] = None
    name: str = "record"


@dataclass(frozen=True)
class TipErrors:
    """How far a simulated tip is from a measured one.

    Attributes
    ----------
    mean, largest : float
        Of the distance, m.
    mean_of_length, largest_of_length : float
        Those over the actuator's length.
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
    """What fit_modulus() found.

    Attributes
    ----------
    actuator : BendingActuator
        The one given, with what was fitted in place.
    tips : list of (n, 2) ndarray
        Of each record, simulated, m.
    errors : list of TipErrors
        Of each record.
    cost : float
        Mean squared distance over the squared length, every record weighing the same.
    converged : bool
    at_bound : bool
        A value sits on its bound, which then decides it.
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
        Columns time, x and y (or z, the height), and pressure where there is one, as "time_s",
        "x [mm]", "y_m", "pressure_kPa". Others are ignored.

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
    """Distances between two motions of a tip.

    Parameters
    ----------
    found, measured : (n, 2) array_like
        m.
    length : float
        Of the actuator, m.

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
    """The modulus with which an actuator's tip moves as recorded, by bounded least squares.

    Every record starts at rest, in the equilibrium of its first pressure.

    Parameters
    ----------
    actuator : BendingActuator
        All that is not fitted; its modulus is where the search begins.
    records : TipRecord or iterable of TipRecord
        With pressures.
    degree : int
        Of the polynomial E(P), 0 (a constant) to 5. It is fitted as its values at degree + 1
        pressures and holds for the records' pressures only.
    kind : {'shear', 'young', 'bending'}
        Which modulus is fitted; see BendingModulus.
    bounds : tuple of float
        Of those values, Pa.
    damping : bool
        Whether to fit Rayleigh's beta as well, up to `highest_damping` (s).
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
        missing-key for a record without pressures; out-of-range, contradictory-limits.
    RunError
        not-converged when the start cannot be simulated.
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
