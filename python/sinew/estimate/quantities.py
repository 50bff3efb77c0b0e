"""Measured quantities and unknowns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Optional, Union

import numpy as np

from ..errors import Error

__all__ = ["Effort", "Force", "Measured", "Motion", "NodalForce", "Parameter", "Unknown", "readings_of"]

_AXES = "xyz"


def _positive(value: float, place: str, unit: str) -> float:
    number = float(value)
    if not (math.isfinite(number) and number > 0.0):
        raise Error("out-of-range", place, f"{value!r} is not a positive number of {unit}", "give a standard deviation > 0")
    return number


@dataclass(frozen=True)
class Measured:
    """A measured quantity: the true value plus independent Gaussian noise.

    Parameters
    ----------
    name : str
        Name of an observable: "tip.position" (three coordinates), "tip.x", "long_0.tension", "long_0.displacement",
        "chamber.volume_growth", "imu.rotation" for an orientation effector, or the name of a probe.
    std : float
        Standard deviation of the noise in the SI unit of the quantity, > 0.
    rate : float, optional
        Sampling rate, Hz; by default every step of the filter.
    delay : float
        Delay from the sample to its arrival, s, >= 0.

    Raises
    ------
    Error
        out-of-range.
    """

    name: str
    std: float
    rate: Optional[float] = None
    delay: float = 0.0

    def __post_init__(self) -> None:
        place = f"Measured({self.name!r})"
        _positive(self.std, f"{place}.std", "the quantity's unit")
        if self.rate is not None:
            _positive(self.rate, f"{place}.rate", "Hz")
        if not (math.isfinite(self.delay) and self.delay >= 0.0):
            raise Error("out-of-range", f"{place}.delay", f"{self.delay!r} is not a delay", "give s, >= 0")

    @classmethod
    def by(cls, sensor: Any) -> "Measured":
        """The quantity measured by a sensor of a simulation or a robot (Simulation.sensor()), with its noise, rate and delay.

        A marker sensor measures the position, and an orientation sensor the rotation, of the effector of the same name in the
        model. Other sensors measure their observable (Sensor.observable).

        Parameters
        ----------
        sensor : Sensor

        Raises
        ------
        Error
            out-of-range for a sensor without noise and quantum; bad-argument if the model has no such observable.
        """
        place = f"Measured.by({sensor.name})"
        if not sensor.std > 0.0:
            raise Error("out-of-range", place, "the sensor has no noise, and an exact reading cannot be weighted",
                        "give the sensor a noise or a quantum")
        name = {"marker": f"{sensor.name}.position", "orientation": f"{sensor.name}.rotation"}.get(sensor.kind, sensor.observable)
        if name == f"{sensor.name}.true":
            raise Error("bad-argument", place, f"a model does not observe what a {sensor.kind} reads",
                        "measure positions, rotations, or motions and efforts of actuators")
        return cls(name, sensor.std, sensor.rate, sensor.delay)


def readings_of(sensors: Iterable[Any]) -> dict[str, Any]:
    """Latest sample of each sensor, by name of the measured quantity: the readings for solve().

    Parameters
    ----------
    sensors : iterable of Sensor
        Sensors without a valid sample are skipped.
    """
    return {Measured.by(sensor).name: sensor.value for sensor in sensors if sensor.valid}


@dataclass(frozen=True)
class Force:
    """An unknown dead force vector on a point of a body.

    The prior is Gaussian, with independent components along `directions`.

    Parameters
    ----------
    name : str
        Name of the force. Its components are `name.x`, `name.y`, `name.z`, or `name.0` ... with `directions`.
    body : str
    point : (3,) array_like
        Position at rest, m. A point outside of the mesh is attached to the nearest element.
    prior : float or (k,) array_like
        Prior standard deviation of each component, N.
    mean : float or (k,) array_like
        N.
    directions : (k, 3) array_like, optional
        World directions of the components, 1 to 3; by default x, y and z.
    walk : float
        Random walk of the force in a filter: its standard deviation after one second, N/sqrt(s).
    """

    name: str
    body: str
    point: Sequence[float]
    prior: Union[float, Sequence[float]] = 1.0
    mean: Union[float, Sequence[float]] = 0.0
    directions: Optional[Sequence[Sequence[float]]] = None
    walk: float = 1.0

    @property
    def axes(self) -> np.ndarray:
        """(k, 3) unit directions."""
        if self.directions is None:
            return np.eye(3)
        axes = np.atleast_2d(np.asarray(self.directions, float))
        return axes / np.linalg.norm(axes, axis=1)[:, None]

    @property
    def components(self) -> list[str]:
        return [f"{self.name}.{_AXES[k] if self.directions is None else k}" for k in range(len(self.axes))]

    @property
    def actuators(self) -> list[str]:
        """Actuators of the model: one force actuator per component."""
        return [component.replace(".", "_") for component in self.components]

    def overrides(self) -> dict[str, dict]:
        """Additions to the scene: names of actuators with their descriptions."""
        return {f"actuators.{actuator}": {"type": "force", "body": self.body, "point": [float(x) for x in self.point],
                                          "direction": axis.tolist(), "outside": "nearest", "command": {"force": 0.0}}
                for actuator, axis in zip(self.actuators, self.axes)}


@dataclass(frozen=True)
class NodalForce:
    """An unknown dead force vector distributed over nodes of a finite-element body.

    Parameters
    ----------
    name : str
    body : str
    nodes : (n,) array_like of int
    weights : (n,) array_like
        Fraction of the force on each node, with sum 1.
    prior, mean, directions, walk
        As of Force.
    """

    name: str
    body: str
    nodes: Sequence[int]
    weights: Sequence[float]
    prior: Union[float, Sequence[float]] = 1.0
    mean: Union[float, Sequence[float]] = 0.0
    directions: Optional[Sequence[Sequence[float]]] = None
    walk: float = 1.0

    axes = Force.axes
    components = Force.components


@dataclass(frozen=True)
class Effort:
    """An unmeasured effort of an actuator: tension of a cable, pressure of a chamber, torque of a motor.

    Parameters
    ----------
    actuator : str
        Name of an actuator that is commanded in effort.
    prior : float
        Standard deviation, N, Pa or N m.
    mean : float
        The same unit.
    walk : float
        The same unit over sqrt(s).
    """

    actuator: str
    prior: float
    mean: float = 0.0
    walk: float = 0.0


@dataclass(frozen=True)
class Motion:
    """A motion of an actuator known with limited accuracy, such as the length of a cable from its encoder.

    Readings of a commanded motion become such an unknown automatically.

    Parameters
    ----------
    actuator : str
        Name of an actuator that is commanded in motion.
    prior : float
        Standard deviation, m, m^3 or rad.
    mean : float
        The same unit.
    walk : float
        The same unit over sqrt(s).
    """

    actuator: str
    prior: float
    mean: float = 0.0
    walk: float = 0.0


@dataclass(frozen=True)
class Parameter:
    """An unknown scene parameter: Young's modulus, a coefficient of friction, a mass.

    The estimated quantity is log(value/start), with a Gaussian prior: the value stays positive, and `prior` is its relative
    standard deviation. Every change rebuilds the model; derivatives are central differences.

    Parameters
    ----------
    path : str
        "bodies.trunk.material.young_modulus".
    start : float
        Prior median, SI, > 0.
    prior : float
        Prior standard deviation of log(value), about the relative standard deviation of the value.
    also : dict of str to float
        Further parameters with their initial values, which change by the same factor.
    walk : float
        1/sqrt(s), of the logarithm.
    """

    path: str
    start: float
    prior: float = 0.3
    also: Mapping[str, float] = field(default_factory=dict)
    walk: float = 0.0

    def overrides(self, logarithm: float) -> dict[str, float]:
        """Values of the scene for one value of the unknown."""
        factor = math.exp(logarithm)
        return {path: start * factor for path, start in {self.path: self.start, **self.also}.items()}


Unknown = Union[Force, NodalForce, Effort, Motion, Parameter]


def names_of(unknown: Unknown) -> list[str]:
    """Names of the components of an unknown."""
    if isinstance(unknown, (Force, NodalForce)):
        return unknown.components
    if isinstance(unknown, Parameter):
        return [unknown.path]
    quantity = "effort" if isinstance(unknown, Effort) else "motion"
    return [f"{unknown.actuator}.{quantity}"]


def _spread(value, count: int, place: str) -> np.ndarray:
    array = np.asarray(value, float)
    if array.shape not in ((), (count,)) or not np.isfinite(array).all():
        raise Error("wrong-shape", place, f"{value!r} is not a number, nor {count} of them", f"give one number or {count}")
    return np.broadcast_to(array, (count,)).copy()


def prior_of(unknown: Unknown) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation of the components of an unknown."""
    names = names_of(unknown)
    mean = 0.0 if isinstance(unknown, Parameter) else unknown.mean
    std = _spread(unknown.prior, len(names), f"{names[0]}: prior")
    for value in std:
        _positive(value, f"{names[0]}: prior", "the unknown's unit")
    return _spread(mean, len(names), f"{names[0]}: mean"), std
