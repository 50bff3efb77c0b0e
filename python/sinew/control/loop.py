"""Common part of all loops: the parallel model, measurements and their loss, commands and reports."""

from __future__ import annotations

import copy
import math
from typing import Any, Callable, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from .. import _core
from ..errors import Error, RunError
from .estimator import JacobianEstimator
from .program import Choice, Standing
from .robot import Answer, Robot

__all__ = ["Loop", "Memory"]

_TRACKED, _HOLDING, _OPEN, _HELD_BACK = "tracked", "holding", "open-loop", "held-back"
_JACOBIANS = ("estimate", "model")
_TINY = np.finfo(float).tiny


class Memory(NamedTuple):
    """One past step: effector positions of the model, the commands that led to them, the measurements at that time, and the
    age of their samples in steps.
    """

    positions: dict[str, np.ndarray]
    commands: np.ndarray
    measured: Optional[dict[str, np.ndarray]]
    ages: dict[str, int]


def _vector(value: Any, place: str, unit: str) -> np.ndarray:
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise Error("wrong-type", place, f"{value!r} is not a vector", f"give three numbers ({unit})") from None
    if found.shape != (3,):
        raise Error("wrong-shape", place, f"its shape is {found.shape}", f"give three numbers ({unit})")
    return found


def _positive(value: float, place: str, *, zero: bool = False) -> float:
    if isinstance(value, (int, float)) and math.isfinite(value) and (value > 0.0 or (zero and value == 0.0)):
        return float(value)
    remedy = f"give a finite number {'of 0 or more' if zero else 'above 0'}"
    raise Error("out-of-range", place, f"it is {value!r}", remedy)


class Loop:
    """Base of ClosedLoop and PredictiveController. The docstring of ClosedLoop describes the parameters."""

    _observer = 1.0  # fraction of a new difference between measurement and model that is added

    def __init__(self, model: Any, effectors: Mapping[str, Any], actuators: Optional[Sequence[str]],
                 command: Union[str, Mapping[str, str], None], weights: Optional[Mapping[str, Any]], tolerance: float,
                 sensors: Union[Mapping[str, Any], Sequence[Any], None], hold: float,
                 real_jacobian: Union[str, Callable[[], np.ndarray]], estimator: Optional[Mapping[str, Any]]) -> None:
        place = self._place = type(self).__name__
        if not isinstance(effectors, Mapping):
            raise Error("wrong-type", f"{place}(effectors)", f"{effectors!r} is not a dict",
                        "give a dict such as {'tip': [0.03, 0.0, 0.18]}")
        if not effectors:
            raise Error("no-effectors", f"{place}(effectors)", "there are none", "give at least one target")
        if model.controller is not None:
            raise Error("actuator-owned", f"{place}(model)", "a controller is attached to the model",
                        "detach it first: model.detach()")
        self.model = model
        self._robot = Robot(model, list(effectors), actuators, command, place)
        self._targets: dict[str, Any] = {}
        for name, target in effectors.items():
            self.set_target(name, target)
        self._row_weights = self._to_weights(weights)
        self._tolerance = _positive(tolerance, f"{place}(tolerance)")
        self._sensors = self._to_sensors(sensors)
        self._ages = dict.fromkeys(effectors, 0)  # age of the samples, steps
        self._hold = _positive(hold, f"{place}(hold)", zero=True)
        if not callable(real_jacobian) and real_jacobian not in _JACOBIANS:
            raise Error("unknown-choice", f"{place}(real_jacobian)", f"there is no {real_jacobian!r}",
                        "use 'estimate', 'model' or a function that returns it")
        self._real_jacobian = real_jacobian
        self._window, self._estimator = self._to_estimator(**(estimator or {}))
        self._status, self._time = "not-started", -math.inf
        self._lost_since: Optional[float] = None
        self._offsets = {name: np.zeros(3) for name in effectors}  # measurement minus model
        self._errors: dict[str, float] = {name: math.nan for name in effectors}
        self._least, self._least_std = math.nan, math.nan
        self._memory: list[Memory] = []
        robot = self._robot
        self._commands = np.where(robot.by_motion, robot.motions, robot.efforts)

    # Methods that a subclass defines.

    def _choose(self, answer: Answer, standing: Standing, found: Mapping[str, Any]) -> Choice:
        raise NotImplementedError

    def _state(self) -> tuple:
        return ()

    def _restore(self, state: tuple) -> None:
        del state

    # Public interface.

    @property
    def status(self) -> str:
        """Progress towards the targets after the last step:

        - 'not-started': no step yet
        - 'on-target': every effector was measured within the tolerance of its target
        - 'moving': the errors are above the tolerance, and no limit is active
        - 'at-limits': the errors are above the tolerance, and a limit of an actuator is active
        - 'limits-conflict': efforts are beyond their limits, and motion limits prevent their return
        - 'held-back': the model cannot follow the chosen commands; those of the step before stay
        - 'condition-violated': no limit is active, and the symmetric part of J_real J_model^+ is not positive definite
          (`least_eigenvalue` is at most 0, by more than twice its standard deviation if it is estimated)
        - 'holding': a measurement is missing; all commands are held
        - 'open-loop': the measurement has been missing for longer than `hold`; the model, corrected by the last difference,
          replaces it
        """
        return self._status

    @property
    def errors(self) -> dict[str, float]:
        """Last measured distance (m or rad) of each effector from its target, along the directions with non-zero weight. If the
        measurement is missing, the model's. NaN before the first step.
        """
        return dict(self._errors)

    @property
    def error(self) -> float:
        """Largest of `errors`."""
        return max(self._errors.values())

    @property
    def least_eigenvalue(self) -> float:
        """Least eigenvalue of the symmetric part of J_real J_model^+ in the last step, for weighted errors, over the directions in
        which the actuators can move the effectors. The errors decrease if it is above 0 (docs/closed_loop.md). NaN before the
        first step and while a measurement is missing.
        """
        return self._least

    @property
    def least_eigenvalue_std(self) -> float:
        """Standard deviation of `least_eigenvalue`: 0 unless J_real is estimated."""
        return self._least_std

    @property
    def commands(self) -> dict[str, float]:
        """Last commands by actuator; `quantities` gives the commanded quantities."""
        return {name: float(value) for name, value in zip(self._robot.actuators, self._commands)}

    @property
    def quantities(self) -> dict[str, str]:
        """Commanded quantity of each actuator: "displacement" (m), "tension" (N), "pressure" (Pa) ..."""
        return self._robot.quantities

    @property
    def actuators(self) -> list[str]:
        """Names of the commanded actuators."""
        return list(self._robot.actuators)

    @property
    def positions(self) -> dict[str, np.ndarray]:
        """(3,) position (m) or rotation vector (rad) of each effector: the model's, corrected by the last measured difference."""
        return {name: self._robot.shifted(name, value, self._offsets[name])
                for name, value in self._robot.positions().items()}

    @property
    def time(self) -> float:
        """Time of the last step, s; -inf before the first."""
        return self._time

    @property
    def targets(self) -> dict[str, Any]:
        """Targets by effector: (3,) arrays or sinew.Target."""
        return dict(self._targets)

    def set_target(self, name: str, target: Any) -> None:
        """Sets the target of an effector from the next step on.

        Parameters
        ----------
        name : str
            One of the loop's effectors.
        target : (3,) array_like or sinew.Target
            m, or rotation vector, rad. Circles, polylines and trajectories run in the time that step() is given.

        Raises
        ------
        Error
            unknown-name, wrong-type, wrong-shape, not-finite; suspicious-unit: farther than a hundred times the
            distance of the effector from the origin, with 1 m for one nearer.
        """
        item = f"targets['{name}']"
        if name not in self._robot.effectors:
            raise Error("unknown-name", item, f"this loop does not control '{name}'",
                        f"it steers {', '.join(self._robot.effectors)}")
        if not isinstance(target, _core.Target):
            target = _vector(target, item, self._robot.effectors[name].unit)
            if not np.isfinite(target).all():
                raise Error("not-finite", item, f"it is {target}", "give finite numbers")
            now = np.linalg.norm(self._robot.effectors[name].value)
            if np.linalg.norm(target) > 100.0 * max(1.0, now):
                raise Error("suspicious-unit", item, f"{target} m is far away from a robot at {now:.3g} m",
                            "targets are in m")
        self._targets[name] = target

    def send(self, sim: Any, commands: Mapping[str, float]) -> None:
        """Sends commands to a simulation with the same actuators: the plant of a twin test.

        Raises
        ------
        Error
            unknown-name, wrong-actuator-type, actuator-owned.
        """
        self._robot.send(sim, commands)

    def step(self, measured: Optional[Mapping[str, Any]] = None, time: Optional[float] = None) -> dict[str, float]:
        """One step of the loop, once every time step of the model.

        Parameters
        ----------
        measured : dict, optional
            For a loop without sensors: current position (3,) m, or rotation vector, rad, by effector. A missing
            measurement is omitted, None or NaN.
        time : float
            Present time on the clock of the sensors, s; later than at the previous step.

        Returns
        -------
        dict
            Commands by actuator, valid until the next step; `quantities` gives the commanded quantities.

        Raises
        ------
        Error
            wrong-type, wrong-shape, unknown-name, not-finite (time); non-monotonic-time: not later than the step before,
            or than a sample; bad-argument: measurements given to a loop that has sensors. RunError: as
            Simulation.step() of the model, singular-matrix.
        """
        if time is None or not (isinstance(time, (int, float)) and math.isfinite(time)):
            raise Error("not-finite", "step(time)", f"it is {time!r}", "give the time in s")
        if not time > self._time:
            raise Error("non-monotonic-time", "step(time)", f"{time:g} s comes after {self._time:g} s",
                        "give times that grow from step to step")
        found = self._read(measured) if self._sensors is None else self._read_sensors(measured, time)
        self._time = time
        before = self._commands
        lost = [name for name, value in found.items() if value is None]
        mode = self._mode(bool(lost), time)
        if mode == _HOLDING:
            self._status, self._least, self._least_std = _HOLDING, math.nan, math.nan
            self._observe(found)
            self._errors = self._distances(self._differences(found, time))
            self._advance(None, before)
            return self.commands
        self._observe(found)
        self._errors = self._distances(self._differences(found, time))
        robot, answer = self._robot, self._robot.response()
        if mode == _TRACKED:
            self._learn(found)
        standing = Standing(robot.efforts, robot.motions, self._commands, robot.slack)
        choice = self._choose(answer, standing, found)
        self._judge(answer, choice, mode)
        self._command(answer, standing, choice)
        self._advance(None if lost else found, before)
        return self.commands

    def state(self) -> tuple:
        """Complete state of the loop, including the model, as a value. Targets and gains are inputs and not included."""
        return (self.model.state(), self._status, self._time, self._lost_since,
                {name: offset.copy() for name, offset in self._offsets.items()}, dict(self._errors), self._least,
                self._least_std, list(self._memory), self._commands.copy(), self._estimator.state(), self._state())

    def restore(self, state: tuple) -> None:
        """Restores a state(), bit for bit. Raises the errors of Simulation.restore()."""
        self.model.restore(state[0])
        (self._status, self._time, self._lost_since) = state[1:4]
        self._offsets = {name: offset.copy() for name, offset in state[4].items()}
        self._errors, self._least, self._least_std = dict(state[5]), state[6], state[7]
        self._memory, self._commands = list(state[8]), state[9].copy()
        if self._status != "not-started":
            self._robot.send(self.model, self.commands)
        self._estimator.restore(state[10])
        self._restore(state[11])

    def clone(self, sensors: Union[Mapping[str, Any], Sequence[Any], None] = None) -> "Loop":
        """A loop on a clone of the model, in the same state. A function given as `real_jacobian` is shared.

        Parameters
        ----------
        sensors : dict or list of Sensor, optional
            Sensors of another plant, such as a clone; by default the same sensors.
        """
        other = copy.copy(self)
        if sensors is not None:
            other._sensors = self._to_sensors(sensors)
        other.model = self.model.clone()
        other._robot = self._robot.on(other.model)
        other._targets, other._ages = dict(self._targets), dict(self._ages)
        other._estimator = self._estimator.clone()
        other.restore(self.state())
        return other

    # Implementation.

    def _to_weights(self, weights: Optional[Mapping[str, Any]]) -> np.ndarray:
        place = f"{self._place}(weights)"
        for name in weights or {}:
            if name not in self._robot.effectors:
                raise Error("unknown-name", place, f"'{name}' has a weight but no target", "add it to effectors")
        result = []
        for name, directions in zip(self._robot.effectors, self._robot.directions):
            value = np.array((weights or {}).get(name, 1.0), dtype=float)
            if value.ndim > 1 or (value.ndim == 1 and len(value) != len(directions)):
                raise Error("wrong-shape", f"{place}['{name}']", f"its shape is {value.shape}",
                            f"give one number, or one for each of its {len(directions)} directions")
            result.append(np.broadcast_to(value, len(directions)))
        found = np.concatenate(result)
        if not (np.isfinite(found).all() and (found >= 0.0).all() and found.any()):
            raise Error("out-of-range", place, f"they are {found}", "give finite weights of 0 or more, one above 0")
        return found

    def _to_estimator(self, noise: float = 1e-4, noise_rotation: float = 1e-3, spread: float = 0.3,
                      forgetting: float = 0.9, window: int = 5) -> tuple[int, JacobianEstimator]:
        """Window of differences, and the estimator of the weighted errors."""
        if not (isinstance(window, int) and window >= 1):
            raise Error("out-of-range", f"{self._place}(estimator)['window']", f"it is {window!r}",
                        "give 1 sample or more")
        noises = []
        for name, effector in self._robot.effectors.items():
            own = self._sensors[name].std if self._sensors is not None else 0.0
            noises.append(own or (noise_rotation if effector.unit == "rad" else noise))
        every = np.repeat(noises, [len(directions) for directions in self._robot.directions])
        scaled = np.sqrt(self._row_weights) * every
        return window, JacobianEstimator(scaled[self._row_weights > 0.0], spread=spread, forgetting=forgetting)

    def _to_sensors(self, given: Union[Mapping[str, Any], Sequence[Any], None]) -> Optional[dict[str, Any]]:
        """Sensor of each effector; None if measurements are passed to step()."""
        if given is None:
            return None
        place = f"{self._place}(sensors)"
        if not isinstance(given, Mapping):
            try:
                given = {sensor.name: sensor for sensor in given}
            except (TypeError, AttributeError):
                raise Error("wrong-type", place, f"{given!r} are not sensors",
                            "give a dict such as {'tip': plant.sensor('camera')}, or a list of sensors") from None
        for name in given:
            if name not in self._robot.effectors:
                raise Error("unknown-name", place, f"this loop does not control '{name}'",
                            f"it steers {', '.join(self._robot.effectors)}")
        for name, effector in self._robot.effectors.items():
            kind = "orientation" if effector.unit == "rad" else "marker"
            if name not in given:
                raise Error("missing-key", place, f"no sensor measures the effector '{name}'", f"give a {kind} for it")
            found = getattr(given[name], "kind", type(given[name]).__name__)
            if found != kind:
                raise Error("wrong-type", f"{place}['{name}']", f"it is of type {found}", f"give a sensor of type {kind}")
        return {name: given[name] for name in self._robot.effectors}

    def _period(self, sensor: Any) -> float:
        return max(1.0 / sensor.rate if sensor.rate else 0.0, self.model.time_step)

    def _read_sensors(self, measured: Optional[Mapping[str, Any]], time: float) -> dict[str, Any]:
        """Last delivered sample for each effector, None if the next one is overdue."""
        if measured is not None:
            raise Error("bad-argument", "step(measured)", "the loop has sensors", "feed them: sensor.feed(value, time)")
        found: dict[str, Any] = {}
        for name, sensor in (self._sensors or {}).items():
            age = time - sensor.time
            if age < -1e-9:
                raise Error("non-monotonic-time", "step(time)",
                            f"'{sensor.name}' has a sample of {sensor.time:g} s, later than now, {time:g} s",
                            "give the time of the plant: step(time=plant.time)")
            seen = sensor.valid and age <= sensor.delay + self._period(sensor) + 0.5 * self.model.time_step
            found[name] = np.array(sensor.value) if seen else None
            self._ages[name] = round(age / self.model.time_step) if seen else 0
        return found

    def _read(self, measured: Optional[Mapping[str, Any]]) -> dict[str, Any]:
        """Measurement of each effector, None if it is missing."""
        if measured is not None and not isinstance(measured, Mapping):
            raise Error("wrong-type", "step(measured)", f"{measured!r} is not a dict",
                        "give a dict from effectors to (3,) arrays")
        measured = measured or {}
        for name in measured:
            if name not in self._robot.effectors:
                raise Error("unknown-name", "step(measured)", f"this loop does not control '{name}'",
                            f"it steers {', '.join(self._robot.effectors)}")
        found: dict[str, Any] = {}
        for name, effector in self._robot.effectors.items():
            value = measured.get(name)
            if value is not None:
                value = _vector(value, f"measured['{name}']", effector.unit)
            found[name] = None if value is None or not np.isfinite(value).all() else value
        return found

    def _mode(self, lost: bool, time: float) -> str:
        if not lost:
            self._lost_since = None
            return _TRACKED
        if self._lost_since is None:
            self._lost_since = time
        # The margin of half a step absorbs rounding in sums of time steps.
        return _HOLDING if time - self._lost_since < self._hold - 0.5 * self.model.time_step else _OPEN

    def _past(self, name: str, step: int, age: int) -> Optional[np.ndarray]:
        """Position of an effector of the model `age` steps before a step of the memory (its length: now)."""
        at = step - age
        if at < 0:
            return None
        return self._memory[at].positions[name] if at < len(self._memory) else self._robot.positions()[name]

    def _delayed(self) -> dict[str, np.ndarray]:
        """Effectors of the model at the time of the present samples; before the start, their initial positions."""
        steps = len(self._memory)
        found = {name: self._past(name, steps, min(age, steps)) for name, age in self._ages.items()}
        return {name: value for name, value in found.items() if value is not None}

    def _samples(self) -> int:
        """Largest delay of the samples, in steps."""
        late = [(sensor.delay + self._period(sensor)) / self.model.time_step for sensor in (self._sensors or {}).values()]
        return math.ceil(max(late, default=0.0) + 0.5)

    def _observe(self, found: Mapping[str, Any]) -> None:
        """Filters the difference between measurement and model: adds the fraction `_observer` of its change."""
        then = self._delayed()
        for name, value in found.items():
            if value is None:
                continue
            offset = self._robot.difference(name, value, then[name])
            part = self._observer if self._offsets[name].any() else 1.0
            self._offsets[name] = self._offsets[name] + part * (offset - self._offsets[name])

    def _differences(self, found: Mapping[str, Any], time: float) -> dict[str, np.ndarray]:
        """(3,) from the measured (or else predicted) position of each effector to its target at a time."""
        predicted = self.positions
        now = {name: predicted[name] if value is None else value for name, value in found.items()}
        return {name: self._robot.difference(name, self._target(name, time), value) for name, value in now.items()}

    def _target(self, name: str, time: float) -> np.ndarray:
        target = self._targets[name]
        return np.array(target.at(time)) if isinstance(target, _core.Target) else target

    def _distances(self, differences: Mapping[str, np.ndarray]) -> dict[str, float]:
        result, first = {}, 0
        for (name, difference), directions in zip(differences.items(), self._robot.directions):
            counts = self._row_weights[first:first + len(directions)] > 0.0
            result[name] = float(np.linalg.norm((directions @ difference)[counts]))
            first += len(directions)
        return result

    def _learn(self, found: Mapping[str, np.ndarray]) -> None:
        """Updates the estimator with the difference of measurements a window apart and the motion of the model in that time."""
        window, steps = self._window, len(self._memory)
        if self._real_jacobian != "estimate" or steps % window or steps < window:
            return
        before = self._memory[steps - window]
        if before.measured is None:
            return
        robot = self._robot
        now = {name: self._past(name, steps, age) for name, age in self._ages.items()}
        then = {name: self._past(name, steps - window, age) for name, age in before.ages.items()}
        if any(value is None for value in (*now.values(), *then.values())):
            return
        root = np.sqrt(self._row_weights)
        modelled = robot.rows({name: robot.difference(name, now[name], then[name]) for name in found})
        measured = robot.rows({name: robot.difference(name, value, before.measured[name]) for name, value in found.items()})
        self._estimator.update((root * modelled)[root > 0.0], (root * measured)[root > 0.0])

    def _judge(self, answer: Answer, choice: Choice, mode: str) -> None:
        """Evaluates the condition of convergence and the status."""
        # In weighted errors, e' = Q^1/2 e, along the directions in which some effort moves the effectors.
        counts = self._row_weights > 0.0
        root = np.sqrt(self._row_weights[counts])[:, None]
        energy = np.sqrt(np.abs(np.diag(answer.w_aa)) + _TINY)
        left, sizes, _ = np.linalg.svd(root * answer.w_ea[counts] / energy, full_matrices=False)
        basis = left[:, sizes > 1e-9 * sizes.max()]
        into = self._by_command(answer, choice.sensitivity)[:, counts] / root.T @ basis
        modelled = root * answer.jacobian[counts] @ into
        if callable(self._real_jacobian):
            real = np.array(self._real_jacobian(), dtype=float)
            if real.shape != answer.jacobian.shape:
                raise Error("wrong-shape", f"{self._place}(real_jacobian)", f"it returned shape {real.shape}",
                            f"return {answer.jacobian.shape}: rows of the effectors, actuators")
            product = basis.T @ (root * real[counts] @ into)
        else:
            product = basis.T @ (modelled + self._estimator.error() @ modelled)
        values, vectors = np.linalg.eigh(0.5 * (product + product.T))
        self._least = float(values[0])
        self._least_std = 0.0
        if self._real_jacobian == "estimate":
            self._least_std = self._estimator.std(basis @ vectors[:, 0], modelled @ vectors[:, 0])
        violated = self._least + 2.0 * self._least_std <= 0.0
        if mode == _OPEN:
            self._status = _OPEN
            self._least = self._least_std = math.nan
        elif choice.conflict:
            self._status = "limits-conflict"
        elif all(error <= self._tolerance for error in self._errors.values()):
            self._status = "on-target"
        elif choice.limited:
            self._status = "at-limits"
        else:
            self._status = "condition-violated" if violated else "moving"

    def _by_command(self, answer: Answer, changes: np.ndarray) -> np.ndarray:
        """Converts changes of efforts to changes of commands; (actuators,) or (actuators, k)."""
        by_motion = self._robot.by_motion if changes.ndim == 1 else self._robot.by_motion[:, None]
        return np.where(by_motion, answer.w_aa @ changes, changes)

    def _command(self, answer: Answer, standing: Standing, choice: Choice) -> None:
        robot = self._robot
        now = np.where(robot.by_motion, standing.motions, standing.efforts)
        wanted = now + self._by_command(answer, choice.change)
        limits = np.where(robot.by_motion, robot.motion_limits, robot.effort_limits)
        reach = limits[2] * self.model.time_step
        self._commands = np.clip(np.clip(wanted, self._commands - reach, self._commands + reach), limits[0], limits[1])

    def _advance(self, measured: Optional[dict[str, np.ndarray]], before: np.ndarray) -> None:
        """Stores this step, whose effectors follow from the commands `before` it, and steps the model."""
        self._memory.append(Memory(self._robot.positions(), before, measured, dict(self._ages)))
        keep = max(2 * (self._samples() + self._window) + 2, 4)
        if len(self._memory) > 2 * keep:
            # Only whole windows are removed, which keeps their phase.
            del self._memory[:keep // self._window * self._window]
        self._robot.send(self.model, self.commands)
        try:
            self.model.step()
        except RunError:  # the model cannot follow: the last commands stay, or the error of these is raised
            self._commands = before
            self._robot.send(self.model, self.commands)
            self.model.step()
            self._status = _HELD_BACK
