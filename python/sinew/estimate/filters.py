"""Estimation over time: extended and unscented Kalman filters and moving horizon, for sensors with different rates and delays."""

from __future__ import annotations

import bisect
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Protocol

import numpy as np

from .._core import silent_periods
from ..errors import Error
from .quantities import Measured

__all__ = ["ExtendedKalman", "Filter", "MovingHorizon", "ProcessModel", "Reading", "UnscentedKalman"]

_TOGETHER = 1e-9  # s: times closer than this are one instant


class ProcessModel(Protocol):
    """Model that a filter needs: x(t + h) = advance(x) + w, with w of covariance noise(h), and y = read(x) + v.

    A model may have further state besides x, such as the positions of finite elements; save() and restore() handle it. A
    filter restores an instant before it advances from it, and reads at the instant reached. If `walks` is true, the
    derivative of advance() is constant.
    """

    names: list[str]
    sensors: list[Measured]

    def start(self) -> tuple[np.ndarray, np.ndarray]:
        """Initial mean (n,) and covariance (n, n)."""

    def advance(self, x: np.ndarray, time: float, step: float) -> np.ndarray:
        """State (n,) `step` s after `time`."""

    def transition(self, x: np.ndarray, time: float, step: float) -> np.ndarray:
        """(n, n) derivative of advance() at x."""

    def noise(self, step: float) -> np.ndarray:
        """Covariance (n, n) added in `step` s."""

    def read(self, x: np.ndarray, sensor: int) -> np.ndarray:
        """Reading (m,) of a sensor without noise."""

    def sensitivity(self, x: np.ndarray, sensor: int) -> np.ndarray:
        """(m, n) derivative of read()."""

    def save(self) -> Any: ...

    def restore(self, kept: Any) -> None: ...


@dataclass(frozen=True)
class Reading:
    """One reading of one sensor.

    Attributes
    ----------
    time : float
        Time of the sample, not of its arrival, s.
    sensor : int
        Index of the sensor in the model.
    values : (m,) ndarray
        SI; NaN for a missing value.
    """

    time: float
    sensor: int
    values: np.ndarray


@dataclass
class _Instant:
    """Estimate at one time, after the readings of that time, and these readings."""

    time: float
    mean: np.ndarray
    covariance: np.ndarray
    kept: Any
    readings: list[Reading]


class Filter:
    """Advances a model through time and corrects it with readings as they arrive.

    If a reading is late (a camera with a delay), the filter returns to the last instant before the sample and repeats the
    steps and readings since then. The estimate is therefore the same as without the delay. Readings older than `memory` are
    dropped and counted.

    Parameters
    ----------
    model : ProcessModel
    step : float
        Time step of the model, s, > 0.
    start : ((n,) ndarray, (n, n) ndarray), optional
        Initial mean and covariance; by default the model's.
    memory : float
        Time for which steps are kept for late readings, s; 0 if there are none, and no state is saved.
    silence : float
        Number of periods (steps for sensors without a rate) without a reading after which a sensor is lost.

    Attributes
    ----------
    time : float
        s.
    mean : (n,) ndarray
    covariance : (n, n) ndarray
    dropped : int
        Number of readings that arrived too late.
    """

    def __init__(self, model: ProcessModel, step: float, *, start: Optional[tuple[np.ndarray, np.ndarray]] = None, time: float = 0.0,
                 memory: float = 0.5, silence: float = silent_periods) -> None:
        if not (math.isfinite(step) and step > 0.0):
            raise Error("out-of-range", "Filter(step)", f"{step!r} is not a time step", "give a time > 0, in s")
        for sensor in model.sensors:
            if sensor.rate is not None and sensor.rate * step > 1.0 + 1e-9:
                raise Error("out-of-range", f"Measured({sensor.name!r}).rate",
                            f"{sensor.rate:g} Hz is faster than the filter's step of {step:g} s",
                            "take a shorter step, or thin the readings out")
            if sensor.delay > memory:
                raise Error("out-of-range", f"Measured({sensor.name!r}).delay",
                            f"{sensor.delay:g} s is longer than the filter's memory of {memory:g} s", "give a longer memory")
        self.model, self.step, self.memory, self.silence = model, step, memory, silence
        mean, covariance = model.start() if start is None else start
        self._past = [_Instant(time, mean, covariance, model.save(), [])]
        self._last = dict.fromkeys(range(len(model.sensors)), time)
        self._at = self._past[0]  # instant of the model's present state
        self._variances: dict[tuple[int, ...], np.ndarray] = {}
        self.dropped = 0

    @property
    def time(self) -> float:
        return self._past[-1].time

    @property
    def mean(self) -> np.ndarray:
        return self._past[-1].mean

    @property
    def covariance(self) -> np.ndarray:
        return self._past[-1].covariance

    @property
    def std(self) -> np.ndarray:
        """(n,) standard deviations."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def lost(self) -> list[str]:
        """Names of lost sensors. The estimate continues without them, with growing covariance."""
        periods = [1.0 / s.rate if s.rate else self.step for s in self.model.sensors]
        return [s.name for k, s in enumerate(self.model.sensors)
                if self.time - self._last[k] - s.delay > self.silence * periods[k] + _TOGETHER]

    def sensor(self, name: str) -> int:
        """Index of a sensor. Raises Error (unknown-name)."""
        names = [s.name for s in self.model.sensors]
        if name not in names:
            raise Error("unknown-name", "Filter", f"there is no sensor '{name}'", f"there are {', '.join(names)}")
        return names.index(name)

    def delivered(self, sensors: Iterable[Any]) -> list[Reading]:
        """Samples delivered by sensors in their last step, for update().

        Parameters
        ----------
        sensors : iterable of Sensor
            Of a simulation or a robot. The quantities that they measure (Measured.by()) must be among the sensors of the model.
            Leave out sensors of commands: these are inputs of the model.

        Raises
        ------
        Error
            unknown-name; those of Measured.by().
        """
        return [Reading(sensor.time, self.sensor(Measured.by(sensor).name), np.atleast_1d(np.asarray(sensor.value, float)))
                for sensor in sensors if sensor.fresh]

    def update(self, time: float, readings: Sequence[Reading] = ()) -> None:
        """Advances to a time with the readings that have arrived since the last call, in any order.

        Parameters
        ----------
        time : float
            New time, s, not before the time of the filter.
        readings : list of Reading
            Readings up to `time`. Readings with only NaN are ignored.

        Raises
        ------
        Error
            non-monotonic-time.
        """
        if time < self.time - _TOGETHER:
            raise Error("non-monotonic-time", "Filter.update(time)", f"{time:g} s is before the time of the filter, {self.time:g} s", "give increasing times")
        fresh = []
        for reading in readings:
            if reading.time > time + _TOGETHER:
                raise Error("non-monotonic-time", "Filter.update(readings)", f"a reading of {reading.time:g} s at {time:g} s",
                            "give the instant that it is of")
            if np.isnan(reading.values).all():
                continue
            if reading.time < self._past[0].time - _TOGETHER:
                self.dropped += 1
                continue
            fresh.append(reading)
            self._last[reading.sensor] = max(self._last[reading.sensor], reading.time)
        fresh.sort(key=lambda r: (r.time, r.sensor))
        pending = self._return_to(fresh[0].time) + fresh if fresh else []
        if len(pending) > len(fresh):
            pending.sort(key=lambda r: (r.time, r.sensor))
        self._go(time, pending)
        self._forget()

    def _return_to(self, time: float) -> list[Reading]:
        """Removes instants at or after a time and returns their readings."""
        at = max(bisect.bisect_left([i.time for i in self._past], time - _TOGETHER), 1)
        again = [r for instant in self._past[at:] for r in instant.readings]
        del self._past[at:]
        return again

    def _go(self, time: float, pending: list[Reading]) -> None:
        stops = sorted({r.time for r in pending if r.time > self.time + _TOGETHER} | {time})
        here = [r for r in pending if r.time <= self.time + _TOGETHER]
        if here:
            self._correct(here)
        for stop in stops:
            while stop - self.time > _TOGETHER:
                left = stop - self.time
                step = left / math.ceil(left / self.step - 1e-6)
                self._predict(step)
            self._correct([r for r in pending if abs(r.time - stop) <= _TOGETHER])

    def _forget(self) -> None:
        while len(self._past) > 2 and self._past[1].time < self.time - self.memory - _TOGETHER:
            del self._past[0]

    def _predict(self, step: float) -> None:
        last = self._past[-1]
        if self._at is not last or getattr(self.model, "reading_moves", True):
            self.model.restore(last.kept)
        mean, covariance = self.predict(last.mean, last.covariance, last.time, step)
        self._past.append(_Instant(last.time + step, mean, covariance, self.model.save() if self.memory > 0.0 else None, []))
        self._at = self._past[-1]

    def _correct(self, readings: list[Reading]) -> None:
        now = self._past[-1]
        if not readings:
            return
        mean, covariance = self.correct(now.mean, now.covariance, readings)
        now.mean, now.covariance, now.readings = mean, covariance, now.readings + readings
        if getattr(self.model, "reading_moves", True):
            now.kept = self.model.save()

    # Methods that a subclass defines.

    def predict(self, mean: np.ndarray, covariance: np.ndarray, time: float, step: float) -> tuple[np.ndarray, np.ndarray]:
        raise NotImplementedError

    def correct(self, mean: np.ndarray, covariance: np.ndarray, readings: list[Reading]) -> tuple[np.ndarray, np.ndarray]:
        raise NotImplementedError

    def _seen(self, readings: list[Reading]) -> tuple[np.ndarray, np.ndarray, tuple[int, ...], np.ndarray]:
        """Available numbers, their variances, their sensors, and their positions among all numbers of the sensors."""
        sensors = tuple(r.sensor for r in readings)
        numbers = np.concatenate([r.values for r in readings])
        if sensors not in self._variances:
            of_each = [np.full(len(r.values), self.model.sensors[r.sensor].std**2) for r in readings]
            self._variances[sensors] = np.concatenate(of_each)
        mask = np.isfinite(numbers)
        return numbers[mask], self._variances[sensors][mask], sensors, mask

    def _answers(self, x: np.ndarray, sensors: tuple[int, ...], mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Predicted available readings at x, and their derivative."""
        if hasattr(self.model, "answers"):
            answer, sensitivity = self.model.answers(x, sensors)
        else:
            answer = np.concatenate([self.model.read(x, k) for k in sensors])
            sensitivity = np.concatenate([self.model.sensitivity(x, k) for k in sensors])
        return answer[mask], sensitivity[mask]


def _corrected(mean, covariance, innovation, sensitivity, variances):
    """Mean and covariance by the gain K = P H^T (H P H^T + R)^-1, the covariance in Joseph's form."""
    spread = sensitivity @ covariance
    own = spread @ sensitivity.T
    own.flat[::len(own) + 1] += variances
    gain = np.linalg.solve(own, spread).T
    left = gain @ sensitivity
    left *= -1.0
    left.flat[::len(left) + 1] += 1.0
    return mean + gain @ innovation, left @ covariance @ left.T + (gain * variances) @ gain.T


class ExtendedKalman(Filter):
    """The extended Kalman filter (Simon, Optimal State Estimation, Wiley 2006, sec. 13.2).

    Prediction x <- f(x), P <- F P F^T + Q; correction by the gain K = P H^T (H P H^T + R)^-1, the covariance in Joseph's
    form, which stays positive definite.
    """

    def predict(self, mean, covariance, time, step):
        transition = self.model.transition(mean, time, step)
        return self.model.advance(mean, time, step), transition @ covariance @ transition.T + self.model.noise(step)

    def correct(self, mean, covariance, readings):
        numbers, variances, sensors, mask = self._seen(readings)
        answer, sensitivity = self._answers(mean, sensors, mask)
        return _corrected(mean, covariance, numbers - answer, sensitivity, variances)


class UnscentedKalman(Filter):
    """The unscented Kalman filter (Julier and Uhlmann, Proc. IEEE 92 (2004) 401-422; Simon sec. 14.3).

    2n sigma points x +- sqrt(n) times the columns of P's Cholesky factor, with equal weights: exact to third order for
    Gaussian x, without derivatives.
    """

    def _points(self, mean: np.ndarray, covariance: np.ndarray) -> np.ndarray:
        spread = np.linalg.cholesky(covariance) * math.sqrt(len(mean))
        return np.concatenate([mean + spread.T, mean - spread.T])

    def predict(self, mean, covariance, time, step):
        if getattr(self.model, "walks", False):  # linear model: the derivative is exact
            transition = self.model.transition(mean, time, step)
            return self.model.advance(mean, time, step), transition @ covariance @ transition.T + self.model.noise(step)
        moved = np.array([self.model.advance(point, time, step) for point in self._points(mean, covariance)])
        centre = moved.mean(axis=0)
        return centre, (moved - centre).T @ (moved - centre) / len(moved) + self.model.noise(step)

    def correct(self, mean, covariance, readings):
        numbers, variances, sensors, mask = self._seen(readings)
        points = self._points(mean, covariance)
        answers = np.array([np.concatenate([self.model.read(p, k) for k in sensors])[mask] for p in points])
        centre = answers.mean(axis=0)
        cross = (points - mean).T @ (answers - centre) / len(points)
        own = (answers - centre).T @ (answers - centre) / len(points) + np.diag(variances)
        gain = np.linalg.solve(own, cross.T).T
        covariance = covariance - gain @ own @ gain.T
        return mean + gain @ (numbers - centre), 0.5 * (covariance + covariance.T)


class MovingHorizon(ExtendedKalman):
    """Moving horizon estimation (Rao, Rawlings, Mayne, IEEE Trans. Autom. Control 48 (2003) 246-258).

    At every instant with readings, minimises over the states of the last `horizon` instants

        |x_0 - xbar|^2_(P_0^-1) + sum |x_k+1 - f(x_k)|^2_(Q^-1) + sum |y_k - h(x_k)|^2_(R^-1)

    by the Gauss-Newton method. Each iteration is one pass of a Kalman filter and smoother over the horizon, linearised about
    the last trajectory (the iterated smoother is Gauss-Newton: Bell, SIAM J. Optim. 4 (1994) 626-636). xbar and P_0 are the
    filter's estimate at the beginning of the horizon (arrival cost). Bounds keep the states physical.

    Parameters
    ----------
    model, step, start, time, memory, silence
        As for Filter; the memory is at least the horizon.
    horizon : int
        Number of instants, >= 1.
    iterations : int
        Maximum number; ends earlier if the trajectory moves by less than 1e-3 standard deviations.
    lower, upper : (n,) array_like, optional
        Bounds on the states, enforced by projection at every iteration.
    """

    def __init__(self, model: ProcessModel, step: float, *, horizon: int = 10, iterations: int = 5, lower: Optional[Sequence[float]] = None,
                 upper: Optional[Sequence[float]] = None, start: Optional[tuple[np.ndarray, np.ndarray]] = None, time: float = 0.0,
                 memory: float = 0.5, silence: float = silent_periods) -> None:
        if horizon < 1:
            raise Error("out-of-range", "MovingHorizon(horizon)", f"{horizon} instants", "give 1 or more")
        super().__init__(model, step, start=start, time=time, memory=max(memory, (horizon + 1) * step), silence=silence)
        self.horizon, self.iterations = horizon, iterations
        count = len(self.mean)
        self.lower = np.full(count, -math.inf) if lower is None else np.asarray(lower, float)
        self.upper = np.full(count, math.inf) if upper is None else np.asarray(upper, float)

    def _correct(self, readings: list[Reading]) -> None:
        super()._correct(readings)
        if readings:
            self._smooth()

    def _smooth(self) -> None:
        window = self._past[-(self.horizon + 1):]
        trajectory = [instant.mean.copy() for instant in window]
        for _ in range(self.iterations):
            passed = self._pass(window, trajectory)
            last = np.linalg.cholesky(passed[1][-1])
            moved = max(float(np.abs(np.linalg.solve(last, after - before)).max()) for before, after in zip(trajectory, passed[0]))
            trajectory = passed[0]
            if moved < 1e-3:
                break
        now = window[-1]
        now.mean, now.covariance = trajectory[-1], passed[1][-1]
        self.model.restore(now.kept)

    def _pass(self, window, about):
        """Kalman filter over the window, linearised about a trajectory, then Rauch-Tung-Striebel smoothing backwards."""
        means, covariances = [window[0].mean], [window[0].covariance]
        ahead, transitions = [], []
        for before, now, x, y in zip(window, window[1:], about, about[1:]):
            step = now.time - before.time
            self.model.restore(before.kept)
            transition = self.model.transition(x, before.time, step)
            moved = self.model.advance(x, before.time, step)
            mean = moved + transition @ (means[-1] - x)
            covariance = transition @ covariances[-1] @ transition.T + self.model.noise(step)
            ahead.append((mean, covariance))
            transitions.append(transition)
            if now.readings:
                mean, covariance = self._correct_about(y, mean, covariance, now.readings)
            means.append(mean)
            covariances.append(covariance)
        smoothed = [means[-1]]
        for k in range(len(window) - 2, -1, -1):
            gain = np.linalg.solve(ahead[k][1], transitions[k] @ covariances[k]).T
            smoothed.insert(0, means[k] + gain @ (smoothed[0] - ahead[k][0]))
        return [np.clip(x, self.lower, self.upper) for x in smoothed], covariances

    def _correct_about(self, about, mean, covariance, readings):
        numbers, variances, sensors, mask = self._seen(readings)
        answer, sensitivity = self._answers(about, sensors, mask)
        return _corrected(mean, covariance, numbers - answer - sensitivity @ (mean - about), sensitivity, variances)
