"""Estimates over recorded readings."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional

import numpy as np

from .. import _core
from ..errors import Error, Location, RunError
from ..scene import load
from .files import Record
from .filters import ExtendedKalman, Filter, MovingHorizon, Reading, UnscentedKalman
from .models import TwinModel
from .quantities import Measured, Parameter
from .static import Estimate, solve
from .twin import Twin

__all__ = ["FILTERS", "filtered", "measured_of", "settled"]

FILTERS: dict[str, type[Filter]] = {"extended": ExtendedKalman, "unscented": UnscentedKalman, "horizon": MovingHorizon}
_QUANTITIES = ("displacement", "tension", "force", "pressure", "volume_growth", "angle", "torque")


def measured_of(record: Record, stds: Mapping[str, float], actuators: Sequence[str]) -> tuple[list[Measured], dict[str, str]]:
    """Sensors for the columns of a record, and the commanded quantities of its actuators.

    A motion column of an actuator is its command; so is an effort column if there is no motion column. With a standard
    deviation it is a measured command, without one it is exact. All other columns are used only if they have a standard
    deviation.

    Parameters
    ----------
    record : Record
    stds : dict of str to float
        SI, by names of columns or patterns ("tip.*", "*.tension"); the last match counts.
    actuators : list of str
        Of the scene.

    Raises
    ------
    Error
        unknown-name: a pattern matches no column.
    """
    std_of: dict[str, float] = {}
    for pattern, std in stds.items():
        owner, _, quantity = pattern.rpartition(".")
        pattern = f"{owner}.[xyz]" if quantity in ("position", "rotation") else pattern
        matched = fnmatch.filter(record.columns, pattern)
        if not matched:
            raise Error("unknown-name", Location(record.path, item="--std"), f"no column matches '{pattern}'",
                        f"there are {', '.join(record.columns)}")
        std_of.update(dict.fromkeys(matched, std))
    commanded: dict[str, str] = {}
    for wanted in (("displacement", "angle", "volume_growth"), ("tension", "force", "pressure", "torque")):
        for name in record.columns:
            owner, _, quantity = name.rpartition(".")
            if owner in actuators and quantity in wanted:
                commanded.setdefault(owner, quantity)
    sensors = [Measured(name, std) for name, std in std_of.items()]
    return sensors, commanded


def _commands(record: Record, commanded: Mapping[str, str]) -> Callable[[float], dict[str, float]]:
    """Function of time that returns the commands: the last readings that are not NaN, or 0 before the first."""
    columns = {owner: record.columns[f"{owner}.{quantity}"] for owner, quantity in commanded.items()}
    filled = {}
    for owner, values in columns.items():
        good = np.flatnonzero(np.isfinite(values))
        last = np.searchsorted(good, np.arange(len(values)), side="right") - 1
        filled[owner] = np.where(last >= 0, values[good[np.maximum(last, 0)]] if len(good) else 0.0, 0.0)

    def at(time: float) -> dict[str, float]:
        row = max(int(np.searchsorted(record.time, time + 1e-9, side="right")) - 1, 0)
        return {owner: float(values[row]) for owner, values in filled.items()}
    return at


def settled(twin: Twin, record: Record, commanded: Mapping[str, str],
            progress: Optional[Callable[[int, int], object]] = None) -> tuple[dict[str, np.ndarray], list[Optional[Estimate]]]:
    """Estimates every row separately, assuming that the robot is at rest in each.

    Returns
    -------
    tuple of dict of str to (n,) ndarray, list of Estimate
        "time [s]", each unknown and its ".std", "chi_squared", "probability", "status" ("converged", "iteration-limit",
        "stalled", "no-readings", "not-converged"); NaN without an estimate.
    """
    commands, names = _commands(record, commanded), twin.inputs[:twin.asked]
    rows: list[Optional[Estimate]] = []
    status = []
    start = None
    for k, time in enumerate(record.time):
        for owner, value in commands(time).items():
            setattr(twin.sim.actuator(owner), commanded[owner], value)
        known = {*twin.outputs, *[m.name for m in twin.measured]}
        readings = {name: value for name, value in record.at(k).items() if name in known}
        try:
            rows.append(solve(twin, readings, start=start))
            status.append(rows[-1].status)
            start = rows[-1].unknowns
        except RunError:
            rows.append(None)
            status.append("not-converged")
        except Error as error:
            if error.kind != "no-sensors":
                raise
            rows.append(None)
            status.append("no-readings")
        if progress is not None:
            progress(k + 1, len(record.time))

    def column(get: Callable[[Estimate], float]) -> np.ndarray:
        return np.array([math.nan if e is None else get(e) for e in rows])
    table = {"time [s]": record.time}
    for name in names:
        table[name] = column(lambda e, name=name: e.values[name])
        table[f"{name}.std"] = column(lambda e, name=name: e.std[name])
    table["chi_squared"] = column(lambda e: e.chi_squared)
    table["probability"] = column(lambda e: e.probability)
    table["status"] = np.array(status)
    return table, rows


def filtered(twin: Twin, record: Record, commanded: Mapping[str, str], *, kind: str = "extended", step: Optional[float] = None,
             progress: Optional[Callable[[int, int], object]] = None, **options: Any) -> dict[str, np.ndarray]:
    """Estimates at every row of a record by a filter over equilibria.

    Parameters
    ----------
    twin : Twin
    record : Record
    commanded : dict of str to str
    kind : {"extended", "unscented", "horizon"}
    step : float, optional
        s; by default the median step of the record.
    progress : callable, optional
    options
        Of the filter.

    Returns
    -------
    dict of str to (n,) ndarray
        "time [s]", each unknown and its ".std", "lost": names of silent sensors.
    """
    model = TwinModel(twin, _commands(record, commanded))
    span = float(np.median(np.diff(record.time))) if len(record.time) > 1 else 0.01
    begin = record.time[0] - span
    for owner, value in _commands(record, commanded)(record.time[0]).items():
        setattr(twin.sim.actuator(owner), commanded[owner], value)
    run = FILTERS[kind](model, span if step is None else step, time=begin, **options)
    names, means, stds, lost = twin.inputs[:twin.asked], [], [], []
    outputs = [[o for o, s in zip(twin.outputs, twin.sensors) if s.name == sensor.name] for sensor in model.sensors]
    for k, time in enumerate(record.time):
        readings = [Reading(float(time), s, np.array([record.columns[o][k] for o in of])) for s, of in enumerate(outputs)]
        run.update(float(time), readings)
        means.append(run.mean[:len(names)])
        stds.append(run.std[:len(names)])
        lost.append(" ".join(run.lost))
        if progress is not None:
            progress(k + 1, len(record.time))
    table = {"time [s]": record.time}
    for k, name in enumerate(names):
        table[name] = np.array(means)[:, k]
        table[f"{name}.std"] = np.array(stds)[:, k]
    table["lost"] = np.array(lost)
    return table


def twin_of(scene: Any, record: Record, stds: Mapping[str, float], unknowns: Sequence[Any], *,
            markers: Optional[Mapping[str, tuple[str, Sequence[float]]]] = None, set: Any = None,
            folder: str = "") -> tuple[Twin, dict[str, str]]:
    """The model of a scene for a record, and the commanded quantities of its actuators."""
    sim = scene if isinstance(scene, _core.Simulation) else load(scene, set=set, folder=folder)
    sensors, commanded = measured_of(record, stds, list(sim.actuators))
    return Twin(sim, sensors, unknowns, markers=markers, commanded=commanded), commanded


def has_parameters(twin: Twin) -> bool:
    """Whether parameters of the scene are unknown."""
    return any(isinstance(u, Parameter) for u in twin.unknowns)
