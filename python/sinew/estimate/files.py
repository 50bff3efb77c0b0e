"""Read measurements from CSV files, write estimates."""

from __future__ import annotations

import csv
import math
import pathlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from .. import _core
from .._whole_files import draft
from ..errors import Error, Location

__all__ = ["Record", "read_readings", "write_table"]

# SI units of the quantities that names end with; others have any.
_UNITS = {"time": "s", "sample_time": "s", **dict.fromkeys(("x", "y", "z", "displacement", "length"), "m"),
          **dict.fromkeys(("rx", "ry", "rz", "angle"), "rad"), **dict.fromkeys(("tension", "force"), "N"),
          "pressure": "Pa", "torque": "N m", "volume_growth": "m^3"}


@dataclass(frozen=True)
class Record:
    """Measurements over time.

    Attributes
    ----------
    time : (n,) ndarray
        s, increasing.
    columns : dict of str to (n,) ndarray
        SI values by name of the component: "tip.x", "long_0.displacement". NaN for a missing reading.
    path : str
    """

    time: np.ndarray
    columns: dict[str, np.ndarray]
    path: str = ""

    def at(self, row: int) -> dict[str, float]:
        """Available readings of one row."""
        return {name: float(values[row]) for name, values in self.columns.items() if math.isfinite(values[row])}

    @property
    def missing(self) -> dict[str, int]:
        """Number of missing readings of each incomplete column."""
        counts = {name: int(np.isnan(values).sum()) for name, values in self.columns.items()}
        return {name: count for name, count in counts.items() if count}

    @property
    def gaps(self) -> list[tuple[float, float]]:
        """Pauses longer than three median steps, as (begin, end) in s."""
        steps = np.diff(self.time)
        if len(steps) < 2:
            return []
        return [(float(self.time[k]), float(self.time[k + 1])) for k in np.flatnonzero(steps > 3.0 * np.median(steps))]


def _factor(name: str, unit: Optional[str], place: Location) -> float:
    """SI value of the unit of a column."""
    if not unit:
        return 1.0
    si = _UNITS.get(name.rpartition(".")[2])
    try:
        factor, dimension = _core._quantity(f"1 {unit}")
    except Error as error:
        raise Error(error.kind, place, f"'{unit}' is not a unit", f"write one such as {si or 'mm, N, kPa or rad'}") from error
    if si is not None and dimension != _core._quantity(f"1 {si}")[1]:
        raise Error("wrong-dimension", place, f"'{unit}' is no unit of {name}", f"write one such as {si}")
    return float(factor)


def read_readings(path: Any, *, wanted: Optional[Sequence[str]] = None) -> Record:
    """Reads measurements from a CSV file with headings such as "time [s]", "tip.x [mm]", "long_0.tension [N]".

    The names are the same as in run.csv: a recorded run can be read as measurements. Units in brackets or parentheses are
    converted; values without a unit are SI. An empty cell, "nan" and "-" mean a missing reading. Text columns are ignored.

    Parameters
    ----------
    path : path-like
    wanted : list of str, optional
        Columns to read; all others are ignored.

    Raises
    ------
    Error
        file-not-found, malformed-file (ragged rows, no time, nothing to read), wrong-type (a word among numbers),
        non-monotonic-time, unknown-name; unknown-unit, wrong-dimension at the heading.
    """
    path = pathlib.Path(path)
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(file) if row]
    except OSError as error:
        raise Error("file-not-found", Location(str(path)), error.strerror or "cannot be read", "check the path") from None
    if len(rows) < 2:
        raise Error("malformed-file", Location(str(path)), "there are no readings", "give a heading and a row for each instant")
    headings = [_core._heading(text) for text in rows[0]]
    names = [name for name, _ in headings]
    if "time" not in names:
        raise Error("malformed-file", Location(str(path), 1), f"no column is 'time': {', '.join(names[:6])}", "add 'time [s]'")
    for name in wanted or ():
        if name not in names:
            raise Error("unknown-name", Location(str(path), 1), f"no column '{name}'", f"there are {', '.join(names)}")
    kept = [k for k, name in enumerate(names) if name == "time" or wanted is None or name in wanted]
    columns = {names[k]: np.empty(len(rows) - 1) for k in kept}
    words: set[str] = set()
    for number, row in enumerate(rows[1:]):
        if len(row) != len(names):
            raise Error("malformed-file", Location(str(path), number + 2), f"{len(row)} cells where the heading has {len(names)}",
                        "give every row as many")
        for k in kept:
            columns[names[k]][number] = _number(row[k], names[k], wanted, words, Location(str(path), number + 2, k + 1, names[k]))
    for k in kept:
        columns[names[k]] *= _factor(*headings[k], Location(str(path), 1, k + 1, names[k]))
    time = columns.pop("time")
    _check_time(time, path)
    return Record(time, {name: values for name, values in columns.items() if name not in words}, str(path))


def _number(text: str, name: str, wanted, words: set, place: Location) -> float:
    text = text.strip()
    if text.lower() in ("", "nan", "-"):
        return math.nan
    try:
        value = float(text)
    except ValueError:
        if name == "time" or wanted is not None:
            raise Error("wrong-type", place, f"'{text}' is not a number", "leave the cell empty where there is no reading") from None
        words.add(name)
        return math.nan
    if math.isinf(value):
        raise Error("not-finite", place, f"'{text}' is not finite", "leave the cell empty where there is no reading")
    return value


def _check_time(time: np.ndarray, path: pathlib.Path) -> None:
    if np.isnan(time).any():
        row = int(np.flatnonzero(np.isnan(time))[0])
        raise Error("not-finite", Location(str(path), row + 2, item="time"), "the row has no time", "give the instant of every row")
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        row = int(back[0]) + 1
        raise Error("non-monotonic-time", Location(str(path), row + 2, item="time"), f"{time[row]:g} s follows {time[row - 1]:g} s",
                    "sort the rows by time, each instant once")


def write_table(path: Any, columns: Mapping[str, np.ndarray]) -> None:
    """Writes columns with headings such as "time [s]" as CSV. Raises Error (file-unwritable, recording-failed)."""
    with draft(path) as beside, open(beside, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        cells = [[v if isinstance(v, str) else repr(float(v)) for v in values] for values in columns.values()]
        writer.writerows(zip(*cells))
