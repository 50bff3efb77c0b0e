"""Process models for filters: finite elements with few unknowns, and complete arm dynamics."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional

import numpy as np

from .. import _core
from ..errors import Error
from .quantities import Measured, Parameter
from .static import Estimate
from .twin import Twin

__all__ = ["ArmModel", "SteppedModel", "TwinModel"]

_DIFFERENCE = 1e-6


class TwinModel:
    """Any robot in static equilibrium at all times. The state consists of its unknowns, which follow a random walk.

    x = (u, e): u(t + h) = u(t) + w with w of covariance walk^2 h. e are the errors of measured commands, white in time, with
    the standard deviations of their sensors. y = h(u, command + e), the static equilibrium.

    Parameters
    ----------
    twin : Twin
        Measurement model. Parameters of the scene and contacts with friction are not allowed, because a filter would have to
        carry their history.
    commands : callable, optional
        Function of time (s) that returns a dict from actuators to commanded values (SI), which may be readings. By default
        the commands stay as they are.

    Raises
    ------
    Error
        bad-argument.
    """

    walks = True  # the derivative of advance() is the same everywhere
    reading_moves = True  # read() changes the state of the simulation

    def __init__(self, twin: Twin, commands: Optional[Callable[[float], Mapping[str, float]]] = None) -> None:
        if any(isinstance(u, Parameter) for u in twin.unknowns):
            raise Error("bad-argument", "TwinModel", "a parameter of the scene is unknown, and a filter cannot rebuild the scene",
                        "estimate it from equilibria: solve()")
        self.twin, self.commands = twin, commands
        self.names = twin.inputs
        self.sensors = list({o.name: o for o in twin.sensors}.values())
        self.rows = [[k for k, o in enumerate(twin.sensors) if o.name == s.name] for s in self.sensors]
        self._mean, self._std = twin.prior()
        self._commanded = self._mean[twin.asked:].copy()
        self._walk = twin.walk()
        self._answers: dict[bytes, tuple[np.ndarray, Optional[np.ndarray]]] = {}
        self._which: dict[tuple[int, ...], np.ndarray] = {}

    def start(self):
        mean = self._mean.copy()
        mean[self.twin.asked:] = 0.0
        return mean, np.diag(self._std**2)

    def values(self, x: np.ndarray) -> np.ndarray:
        """(inputs,) of the twin for a state."""
        return np.concatenate([x[:self.twin.asked], self._commanded + x[self.twin.asked:]])

    def advance(self, x, time, step):
        self._command(time + step)
        result = x.copy()
        result[self.twin.asked:] = 0.0
        return result

    def _command(self, time: float) -> None:
        self._answers.clear()
        if self.commands is None:
            return
        for name, value in self.commands(time).items():
            actuator = self.twin.sim.actuator(name)
            setattr(actuator, actuator.command[0], float(value))
        self._commanded = self.twin.prior()[0][self.twin.asked:]

    def transition(self, x, time, step):
        result = np.eye(len(x))
        result[self.twin.asked:] = 0.0
        return result

    def noise(self, step):
        variances = self._walk**2 * step
        variances[self.twin.asked:] = self._std[self.twin.asked:]**2
        return np.diag(variances)

    def _answer(self, x: np.ndarray, derivative: bool):
        key = x.tobytes()
        answer, slope = self._answers.get(key, (None, None))
        if answer is None or (derivative and slope is None):
            answer = self.twin.predict(self.values(x))
            slope = self.twin.sensitivity(self.values(x)) if derivative else None
        self._answers[key] = answer, slope
        return answer, slope

    def answers(self, x, sensors):
        """(m,) predicted readings of several sensors and their derivative (m, n)."""
        if sensors not in self._which:
            self._which[sensors] = np.array([row for sensor in sensors for row in self.rows[sensor]])
        which = self._which[sensors]
        answer, slope = self._answer(x, True)
        return answer[which], slope[which]

    def state_of(self, estimate: Estimate) -> tuple[np.ndarray, np.ndarray]:
        """Initial mean and covariance of a filter, from an estimate of this twin at rest."""
        mean = estimate.unknowns.copy()
        mean[self.twin.asked:] -= self._commanded
        return mean, estimate.covariance.copy()

    def read(self, x, sensor):
        return self._answer(x, False)[0][self.rows[sensor]]

    def sensitivity(self, x, sensor):
        return self._answer(x, True)[1][self.rows[sensor]]

    def save(self):
        return self.twin.sim.state(), self._commanded

    def restore(self, kept):
        state, self._commanded = kept
        self._answers.clear()
        self.twin.sim.restore(state)


class SteppedModel(TwinModel):
    """The same state as TwinModel, advanced by the simulation's own steps: for quasi-static scenes in real time.

    Each advance() makes one step of the scene, with the unknowns as last estimated. Readings are predicted by the
    linearisation of that step, y = y_step + S (x - x_step), so an estimate costs one step. The readings must be rows, the
    unknowns forces, efforts or motions. Start from an estimate at rest (state_of()), because each step continues from the
    previous one.
    """

    reading_moves = False

    def __init__(self, twin: Twin, commands: Optional[Callable[[float], Mapping[str, float]]] = None) -> None:
        super().__init__(twin, commands)
        self._x = self.start()[0]
        self._now: Optional[tuple[np.ndarray, np.ndarray]] = None
        self._handles = twin.handles()

    def advance(self, x, time, step):
        if abs(step - self.twin.sim.time_step) > 1e-9:
            raise Error("out-of-range", "SteppedModel", f"a step of {step:g} s, where the scene's is {self.twin.sim.time_step:g} s",
                        "filter with the scene's time_step, and readings at its multiples")
        self._x = super().advance(x, time, step)
        for (actuator, quantity), value in zip(self._handles, self.values(self._x).tolist()):
            setattr(actuator, quantity, value)
        self.twin.sim.step()
        self._now = self.twin.of_step()
        return self._x.copy()

    def _answer(self, x, derivative):
        if self._now is None:
            self.twin.predict(self.values(self._x))
            self._now = self.twin.of_step()
        answer, slope = self._now
        return answer + slope @ (x - self._x), slope

    def save(self):
        return super().save(), self._x, self._now

    def restore(self, kept):
        own, self._x, self._now = kept
        super().restore(own)


class ArmModel:
    """Full dynamics of a constant-curvature arm: coordinates, their rates, and unknown parameters of the arm.

    x = (theta, theta_dot, p). theta is advanced by the arm's implicit steps, p is a random walk. Derivatives are central
    differences of these steps.

    Parameters
    ----------
    arm : sinew.pcc.Arm or callable
        The arm, or a function that maps p (a payload, a stiffness) to an Arm.
    torque : callable
        Function of time (s) that returns (inputs,) N m.
    points : dict of str to (int, float)
        Markers: segment and fraction of its length, by the sensors' names without ".position".
    measured : list of Measured
        "tip.position"; "theta" for the coordinates themselves.
    prior : (array_like, array_like), optional
        (n,) mean and standard deviation of (theta, theta_dot, p); by default the equilibrium, 0.3 rad and 1 rad/s.
    unknowns : dict of str to (float, float, float)
        Names of p with mean, standard deviation, and walk per sqrt(s).
    force_noise : float or (coordinates,) array_like
        White noise of the accelerations, rad/s^2 sqrt(s), for effects that the arm's equations neglect.
    push : (int, float, float, float), optional
        An unknown dead force on a point: its segment, the fraction of its length, the standard deviation of each component
        (N), and the walk (N/sqrt(s)). Its components are "push.x", "push.y", "push.z". The inputs of the arm are its
        coordinates.
    """

    def __init__(self, arm: Any, torque: Callable[[float], Sequence[float]], points: Mapping[str, tuple[int, float]],
                 measured: Sequence[Measured], *, prior: Optional[tuple[Sequence[float], Sequence[float]]] = None,
                 unknowns: Optional[Mapping[str, tuple[float, float, float]]] = None,
                 push: Optional[tuple[int, float, float, float]] = None, force_noise: Any = 1.0) -> None:
        self._unknowns, self._push = dict(unknowns or {}), push
        self._constants = len(self._unknowns)
        if push is not None:
            self._unknowns.update({f"push.{axis}": (0.0, push[2], push[3]) for axis in "xyz"})
        self._make: Callable[[np.ndarray], _core.Arm] = arm if not isinstance(arm, _core.Arm) else lambda p: arm
        self._p0 = np.array([mean for mean, _, _ in self._unknowns.values()])
        self._arms: dict[bytes, _core.Arm] = {}
        first = self.arm(self._p0)
        self.n = first.coordinates
        self._torque, self._points, self.sensors = torque, dict(points), list(measured)
        for sensor in self.sensors:
            owner = sensor.name.removesuffix(".position")
            if owner not in self._points and sensor.name != "theta":
                raise Error("unknown-name", f"Measured({sensor.name!r})", "the arm has no such point",
                            f"it has {', '.join(f'{name}.position' for name in self._points)} and theta")
        self.names = [f"theta.{k}" for k in range(self.n)] + [f"theta_dot.{k}" for k in range(self.n)] + list(self._unknowns)
        self._noise = np.broadcast_to(np.asarray(force_noise, float), (self.n,))
        self._prior = prior

    def arm(self, p: np.ndarray) -> _core.Arm:
        """The arm for given values of the unknowns."""
        p = np.asarray(p, float)[:self._constants]
        key = p.tobytes()
        if key not in self._arms:
            if len(self._arms) > 64:
                self._arms.clear()
            self._arms[key] = self._make(p)
        return self._arms[key]

    def start(self):
        if self._prior is not None:
            mean, std = (np.asarray(part, float) for part in self._prior)
        else:
            rest = self.arm(self._p0).equilibrium(np.asarray(self._torque(0.0), float))
            mean = np.concatenate([rest, np.zeros(self.n), self._p0])
            std = np.concatenate([np.full(self.n, 0.3), np.ones(self.n), [s for _, s, _ in self._unknowns.values()]])
        return mean.copy(), np.diag(std**2)

    def advance(self, x, time, step):
        n = self.n
        arm, torque = self.arm(x[2 * n:]), np.asarray(self._torque(time + step), float)
        if self._push is not None:
            torque = torque + np.asarray(arm.jacobian(x[:n], *self._push[:2])).T @ x[-3:]
        theta, rate = arm.simulate(x[:n], x[n:2 * n], torque[None, :], time_step=step)
        return np.concatenate([theta[-1], rate[-1], x[2 * n:]])

    def transition(self, x, time, step):
        return _differences(lambda y: self.advance(y, time, step), x)

    def noise(self, step):
        n = self.n
        result = np.zeros((len(self.names),) * 2)
        density = self._noise**2
        at = np.arange(n)
        result[at, at] = density * step**3 / 3.0
        result[at, at + n] = result[at + n, at] = density * step**2 / 2.0
        result[at + n, at + n] = density * step
        for k, (_, _, walk) in enumerate(self._unknowns.values()):
            result[2 * n + k, 2 * n + k] = walk**2 * step
        return result

    def read(self, x, sensor):
        name = self.sensors[sensor].name
        if name == "theta":
            return x[:self.n].copy()
        segment, fraction = self._points[name.removesuffix(".position")]
        return np.asarray(self.arm(x[2 * self.n:]).point(x[:self.n], segment, fraction))

    def sensitivity(self, x, sensor):
        name = self.sensors[sensor].name
        result = np.zeros((self.n if name == "theta" else 3, len(x)))
        if name == "theta":
            result[:, :self.n] = np.eye(self.n)
        else:
            segment, fraction = self._points[name.removesuffix(".position")]
            result[:, :self.n] = self.arm(x[2 * self.n:]).jacobian(x[:self.n], segment, fraction)
            for k in range(2 * self.n, 2 * self.n + self._constants):  # unknown parameters, such as a length, move points
                step = np.zeros(len(x))
                step[k] = _DIFFERENCE * max(1.0, abs(x[k]))
                result[:, k] = (self.read(x + step, sensor) - self.read(x - step, sensor)) / (2.0 * step[k])
        return result

    def save(self):
        return None

    def restore(self, kept):
        pass


def _differences(function: Callable[[np.ndarray], np.ndarray], x: np.ndarray) -> np.ndarray:
    columns = []
    for k in range(len(x)):
        step = np.zeros(len(x))
        step[k] = _DIFFERENCE * max(1.0, abs(x[k]))
        columns.append((function(x + step) - function(x - step)) / (2.0 * step[k]))
    return np.array(columns).T
