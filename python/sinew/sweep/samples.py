"""Parameters of a sweep and their samples."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np

from .. import _core
from ..errors import Error
from .sensitivity import saltelli_points

Value = Union[int, float, str]
METHODS = ("sobol", "halton", "random", "saltelli")
_MAX_SAMPLES = 10_000_000
_BASE_UNITS = ("m", "kg", "s", "K")  # in the order of _core._quantity()
_UNITS = {(-1, 1, -2, 0): "Pa", (1, 1, -2, 0): "N", (2, 1, -2, 0): "J", (2, 1, -3, 0): "W", (-3, 1, 0, 0): "kg/m^3", (1, 0, -1, 0): "m/s"}


@dataclass(frozen=True)
class Axis:
    """One varied key. Its numbers are SI.

    Attributes
    ----------
    key : str
        Such as "bodies.trunk.material.young_modulus".
    values : tuple
        Numbers or text of a grid or a list; empty for a range.
    low, high : float
        Ends of a range.
    unit : str
        SI unit in the spelling of scenes: "Pa"; empty for pure numbers and text.
    kind : str
        "grid", "range" or "list".
    """

    key: str
    kind: str
    values: tuple[Value, ...] = ()
    low: float = 0.0
    high: float = 0.0
    unit: str = ""

    @property
    def is_number(self) -> bool:
        """Whether its values are numbers."""
        return not any(isinstance(value, str) for value in self.values)

    def at(self, share: float) -> Value:
        """Value at a fraction of the range in [0, 1); the values of a list have equal parts of it."""
        if self.kind == "range":
            return self.low + share * (self.high - self.low)
        return self.values[min(int(share * len(self.values)), len(self.values) - 1)]

    def spell(self, value: Value) -> str:
        """A value in the form of a scene override."""
        if isinstance(value, str):
            return value
        return f"{value!r} {self.unit}".rstrip()

    def describe(self) -> dict[str, Any]:
        """Description for the attributes of the table, and to distinguish sweeps."""
        if self.kind == "range":
            return {"key": self.key, "from": self.low, "to": self.high, "unit": self.unit}
        return {"key": self.key, "values": list(self.values), "unit": self.unit}


class Design:
    """Samples of a sweep, each with a value for every axis.

    Parameters
    ----------
    axes : list of Axis
    method : str
        "grid", or one of METHODS.
    count : int
        Number of points; unused for a grid.
    seed : int
        Random seed.

    Raises
    ------
    Error
        size-limit beyond ten million samples.
    """

    def __init__(self, axes: list[Axis], method: str, count: int, seed: int) -> None:
        self.axes, self.method, self.count, self.seed = axes, method, count, seed
        self._shape = tuple(len(axis.values) for axis in axes)
        if method == "grid":
            self.size = math.prod(self._shape)
        else:
            self.size = count * (len(axes) + 2) if method == "saltelli" else count
        if self.size > _MAX_SAMPLES:
            raise Error("size-limit", "sweep", f"these are {self.size} samples, and {_MAX_SAMPLES} are the most", "vary fewer values")
        self._shares = None if method == "grid" else _shares(method, len(axes), count, seed)

    @property
    def keys(self) -> list[str]:
        """The varied keys."""
        return [axis.key for axis in self.axes]

    def values(self, index: int) -> tuple[Value, ...]:
        """Values of a sample in the order of the axes; numbers are SI. The last axis of a grid changes fastest."""
        if self._shares is None:
            return tuple(axis.values[int(k)] for axis, k in zip(self.axes, np.unravel_index(index, self._shape)))
        return tuple(axis.at(float(share)) for axis, share in zip(self.axes, self._shares[index]))

    def describe(self) -> dict[str, Any]:
        """Data that distinguish it from other designs."""
        return {"vary": [axis.describe() for axis in self.axes], "sample": f"{self.method}:{self.count}", "seed": self.seed}


def _shares(method: str, dimensions: int, count: int, seed: int) -> np.ndarray:
    """(samples, dimensions) in [0, 1)."""
    from scipy.stats import qmc

    if method == "saltelli":
        return saltelli_points(dimensions, count, seed).reshape(-1, dimensions)
    if method == "sobol":
        # Generate a power of two, which Sobol points need to be balanced, and use the first `count` points.
        return qmc.Sobol(dimensions, scramble=True, seed=seed).random_base2(max(0, math.ceil(math.log2(count))))[:count]
    if method == "halton":
        return qmc.Halton(dimensions, scramble=True, seed=seed).random(count)
    return np.random.default_rng(seed).random((count, dimensions))


def design(vary: Mapping[str, Any], sample: Optional[str] = None, seed: int = 1) -> Design:
    """Samples for `vary` and `sample`: see sinew.sweep.run().

    Raises
    ------
    Error
        bad-argument, with the key and the remedy: no key, a grid with a sample, a range without one, mixed units.
    """
    if not isinstance(vary, Mapping) or not vary:
        raise Error("bad-argument", "sweep(vary)", "no parameter to vary", 'give {"time_step": ["5 ms", "10 ms"]}, or --vary KEY=FROM:TO:N')
    axes = [_axis(str(key), spec) for key, spec in vary.items()]
    method, count = _method(sample)
    for axis in axes:
        if method == "grid" and axis.kind == "range":
            raise Error("bad-argument", axis.key, "a range needs a number of samples",
                        "write FROM:TO:N for a grid, or add a sample such as sobol:512 (--sample)")
        if method != "grid" and axis.kind == "grid":
            raise Error("bad-argument", axis.key, f"it is varied over a grid, and {sample} is a sample of a range",
                        "write FROM:TO without a count, or leave the sample out")
    return Design(axes, method, count, seed)


def _method(sample: Optional[str]) -> tuple[str, int]:
    if sample is None:
        return "grid", 0
    name, _, count = str(sample).partition(":")
    if name not in METHODS or not re.fullmatch(r"[1-9][0-9]*", count):
        raise Error("bad-argument", "sweep(sample)", f"'{sample}' is not a sample",
                    "write sobol:512, halton:500, random:500 or, for Sobol indices, saltelli:256")
    return name, int(count)


def _axis(key: str, spec: Any) -> Axis:
    if isinstance(spec, str):
        return _axis_of_text(key, spec)
    if isinstance(spec, tuple):
        if len(spec) != 2:
            raise Error("bad-argument", key, f"{spec!r} is not a range", "give (low, high), or a list of values")
        (low, high), unit = _numbers(key, spec)
        return Axis(key, "range", low=low, high=high, unit=unit)
    if hasattr(spec, "tolist"):
        spec = spec.tolist()
    if not isinstance(spec, Iterable) or isinstance(spec, Mapping):
        raise Error("bad-argument", key, f"{spec!r} contains no values", 'give a list, a tuple (low, high), or text such as "1mm:5mm:9"')
    return _list_axis(key, list(spec))


def _split(text: str, separator: str) -> list[str]:
    """Splits at separators outside brackets, braces and quotes, so that values may be YAML maps and lists."""
    parts, depth, quote = [""], 0, ""
    for character in text:
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character in "[{(":
            depth += 1
        elif character in "]})":
            depth -= 1
        elif character == separator and depth == 0:
            parts.append("")
            continue
        parts[-1] += character
    return [part.strip() for part in parts]


def _axis_of_text(key: str, text: str) -> Axis:
    ends = _split(text, ":")
    if len(ends) == 1:
        return _list_axis(key, _split(text, ","))
    if len(ends) > 3 or "" in ends:
        raise Error("bad-argument", key, f"'{text}' contains no values", "write FROM:TO:N, FROM:TO, or A,B,C")
    (low, high), unit = _numbers(key, ends[:2])
    if len(ends) == 2:
        return Axis(key, "range", low=low, high=high, unit=unit)
    if not re.fullmatch(r"[0-9]+", ends[2]) or int(ends[2]) < 2:
        raise Error("bad-argument", key, f"'{ends[2]}' is not a number of values of a grid", "write FROM:TO:N with N of 2 or more")
    if int(ends[2]) > _MAX_SAMPLES:
        raise Error("size-limit", key, f"{ends[2]} values are more than {_MAX_SAMPLES}", "vary fewer values")
    values: list[Value] = [float(value) for value in np.linspace(low, high, int(ends[2]))]
    whole = all(re.fullmatch(r"[+-]?[0-9]+", end) for end in ends[:2]) and all(value.is_integer() for value in values)
    return Axis(key, "grid", tuple(int(value) for value in values) if whole else tuple(values), unit=unit)


def _list_axis(key: str, values: list[Any]) -> Axis:
    if not values or "" in values:
        raise Error("bad-argument", key, "the list of values is empty, or one of them is", "write A,B,C")
    if all(isinstance(value, int) and not isinstance(value, bool) for value in values):
        return Axis(key, "list", tuple(values))
    quantities = [_quantity(value) for value in values]
    if all(isinstance(found, Error) for found in quantities):
        if not all(isinstance(value, str) for value in values):
            raise Error("bad-argument", key, f"{values!r} are neither quantities nor text", "give numbers, or text")
        return Axis(key, "list", tuple(values))
    numbers, unit = _numbers(key, values)
    whole = all(isinstance(value, str) and re.fullmatch(r"[+-]?[0-9]+", value) for value in values)
    return Axis(key, "list", tuple(int(number) for number in numbers) if whole else tuple(numbers), unit=unit)


def _quantity(value: Any) -> Union[tuple[float, str], Error]:
    """SI value and unit, or the error."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return (float(value), "") if math.isfinite(value) else Error("not-finite", "", f"{value!r} is not finite")
    try:
        number, exponents = _core._quantity(str(value))
    except Error as error:
        return error
    powers = [(unit, power) for unit, power in zip(_BASE_UNITS, exponents) if power]
    return number, _UNITS.get(exponents) or " ".join(unit if power == 1 else f"{unit}^{power}" for unit, power in powers)


def _numbers(key: str, values: Iterable[Any]) -> tuple[list[float], str]:
    """SI values and their common unit; a bare 0 fits any unit."""
    found = []
    for value in values:
        quantity = _quantity(value)
        if isinstance(quantity, Error):
            raise Error(quantity.kind, key, quantity.message, quantity.remedy)
        found.append((value, *quantity))
    units = {unit for _, number, unit in found if unit or number != 0.0}
    if len(units) > 1:
        named = ", ".join(f"'{value}'" for value, _, _ in found[:4])
        raise Error("bad-argument", key, f"the values {named} are of different dimensions", "give all of them in units of one dimension")
    return [number for _, number, _ in found], next(iter(units), "")
