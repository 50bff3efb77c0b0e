"""Static estimation: nonlinear maximum a posteriori estimate, its covariance, and observability."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
import scipy.stats

from ..errors import Error, RunError
from .quantities import Parameter
from .response import Response
from .twin import Twin

__all__ = ["Estimate", "Observability", "observability", "solve"]

_FIRST_RADIUS = 1.0  # of trust, in standard deviations of the prior
_SEEN = 1.0  # singular value above which readings outweigh the prior


@dataclass(frozen=True)
class Observability:
    """Information in the readings about the unknowns, compared with the prior.

    The singular values are those of the whitened sensitivity S = R^(-1/2) J P_0^(1/2), R the covariance of noise and of
    measured commands, P_0 the prior's. Readings reduce the standard deviation along a direction of singular value s from the
    prior's to 1/sqrt(1 + s^2) of it: s = 0 is not observable, and for s < 1 the prior dominates.

    Attributes
    ----------
    singular_values : (k,) ndarray
        Descending.
    directions : (k, k) ndarray
        Rows: unit vectors of unknowns in units of their prior's standard deviation.
    names : list of str
        Names of the unknowns.
    """

    singular_values: np.ndarray
    directions: np.ndarray
    names: list[str]

    @property
    def unobservable(self) -> list[str]:
        """Directions with singular values below 1, as text: "0.98 hand.y + 0.2 hand.z (0.03)"."""
        return [f"{self._spell(direction)} (singular value {value:.2g})"
                for value, direction in zip(self.singular_values, self.directions) if value < _SEEN]

    def _spell(self, direction: np.ndarray) -> str:
        order = [k for k in np.argsort(-np.abs(direction), kind="stable") if abs(direction[k]) > 0.1]
        return " ".join(f"{'-' if direction[k] < 0 else '+'} {abs(direction[k]):.2f} {self.names[k]}" for k in order).lstrip("+ ")


@dataclass(frozen=True)
class Estimate:
    """Estimate for a robot at rest.

    Attributes
    ----------
    values, std : dict of str to float
        Value and standard deviation of each unknown, SI. For a Parameter, the standard deviation is to first order.
    names : list of str
        Order of `covariance`. Measured commands, which are also estimated, come last.
    covariance : (inputs, inputs) ndarray
        (P_0^-1 + J^T R^-1 J)^-1 at the estimate, SI; for a Parameter, of its logarithm.
    unknowns : (inputs,) ndarray
        Values in that order; for a Parameter, log(value/start).
    observability : Observability
        Observability of the requested unknowns.
    predicted, residuals : dict of str to float
        Readings predicted at the estimate, and measured minus predicted readings in standard deviations of each sensor.
    chi_squared : float
        Chi squared of the residuals and of the distance from the prior, with `degrees` degrees of freedom if the model is
        correct.
    degrees : int
    probability : float
        Probability that chi squared is at least this large.
    log_evidence : float
        log p(readings | model), by Laplace's approximation.
    iterations : int
    status : str
        "converged"; "iteration-limit"; or "stalled": no shorter step lowers the cost, because the model has no equilibrium in
        that direction, or because of rounding. The estimate is then the best point that was found.
    positions : dict of str to (n, 3) ndarray
        Nodes of all bodies, m.
    """

    values: dict[str, float]
    std: dict[str, float]
    names: list[str]
    covariance: np.ndarray
    unknowns: np.ndarray
    observability: Observability
    predicted: dict[str, float]
    residuals: dict[str, float]
    chi_squared: float
    degrees: int
    probability: float
    log_evidence: float
    iterations: int
    status: str
    positions: dict[str, np.ndarray]

    def holds(self, truth: Sequence[float], share: float = 0.9) -> bool:
        """Whether a true value lies inside the confidence ellipsoid.

        Parameters
        ----------
        truth : (k,) array_like
            True values of the first k `names`.
        share : float
            Probability of the ellipsoid, such as 0.9.
        """
        error = np.asarray(truth, float) - self.unknowns[:len(truth)]
        own = self.covariance[:len(truth), :len(truth)]
        return bool(error @ np.linalg.solve(own, error) <= scipy.stats.chi2.ppf(share, len(truth)))

    def __str__(self) -> str:
        lines = [f"{name:<28}{self.values[name]:>12.5g} +- {self.std[name]:.2g}" for name in self.values]
        lines += [f"chi squared {self.chi_squared:.3g} of {self.degrees}, probability {self.probability:.2g}; {self.status}"]
        lines += [f"not observable: {text}" for text in self.observability.unobservable]
        return "\n".join(lines)


def observability(sensitivity: np.ndarray, noise: np.ndarray, prior: np.ndarray, names: Sequence[str], asked: int) -> Observability:
    """Observability of the first `asked` unknowns; the others count as noise.

    Parameters
    ----------
    sensitivity : (m, k) ndarray
    noise : (m,) ndarray
        Standard deviations, or a covariance (m, m).
    prior : (k,) ndarray
        Standard deviations.
    names : (k,) list of str
    asked : int
    """
    if asked == 0:
        return Observability(np.empty(0), np.empty((0, 0)), [])
    covariance = np.diag(noise**2) if noise.ndim == 1 else noise
    others = sensitivity[:, asked:] * prior[asked:]
    lower = np.linalg.cholesky(covariance + others @ others.T)
    whitened = np.linalg.solve(lower, sensitivity[:, :asked] * prior[:asked])
    _, values, directions = np.linalg.svd(whitened, full_matrices=True)
    return Observability(np.pad(values, (0, asked - len(values))), directions, list(names[:asked]))


class _Problem:
    """min 1/2 |L^-1 (y - h(u))|^2 + 1/2 |(u - u_0)/sigma|^2 in v = (u - u_0)/sigma."""

    def __init__(self, twin: Twin, readings: Mapping[str, Any], extra: Optional[np.ndarray]) -> None:
        self.twin = twin
        numbers, commands = twin.split(readings)
        self.seen = np.isfinite(numbers)
        if not self.seen.any():
            raise Error("no-sensors", "solve(readings)", "no sensor has a reading", f"give some of {', '.join(twin.outputs)}")
        self.mean, self.std = twin.prior(commands)
        self.numbers = numbers[self.seen]
        covariance = np.diag(twin.noise**2)
        if extra is not None:
            covariance = covariance + extra
        self.noise = covariance[np.ix_(self.seen, self.seen)]
        self.lower = np.linalg.cholesky(self.noise)
        self.cost = math.inf

    def residual(self, v: np.ndarray) -> np.ndarray:
        """(seen,) whitened residual; moves the model."""
        return np.linalg.solve(self.lower, self.numbers - self.twin.predict(self.mean + self.std * v)[self.seen])

    def keep(self, v: np.ndarray) -> tuple:
        """The model at its present equilibrium; see Twin.keep()."""
        return self.twin.keep(self.mean + self.std * v)

    def jacobian(self, v: np.ndarray) -> np.ndarray:
        """(seen, k) derivative of L^-1 h with respect to v at the present state of the model."""
        return np.linalg.solve(self.lower, self.twin.sensitivity(self.mean + self.std * v)[self.seen] * self.std)


def _cost(residual: np.ndarray, v: np.ndarray) -> float:
    return 0.5 * float(residual @ residual + v @ v)


def _begin(problem: _Problem, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The start and its residual. A start without an equilibrium is replaced by one nearer to the prior mean."""
    for share in (1.0, 0.5, 0.0):
        try:
            return share * v, problem.residual(share * v)
        except RunError:
            if share == 0.0 or not v.any():
                raise
    raise AssertionError


class _Model:
    """Quadratic model of the cost about a point: |r - J s|^2 / 2 + |v + s|^2 / 2."""

    def __init__(self, jacobian: np.ndarray, residual: np.ndarray, v: np.ndarray) -> None:
        self.jacobian, self.residual, self.v = jacobian, residual, v
        self.values, self.axes = np.linalg.eigh(jacobian.T @ jacobian + np.eye(len(v)))
        self.slope = self.axes.T @ (jacobian.T @ residual - v)

    def step(self, radius: float) -> np.ndarray:
        """The minimum within a ball (Nocedal & Wright, Numerical Optimization, 2006, sec. 4.3): (A + mu 1) s = g, mu by
        bisection."""
        whole = self.slope / self.values
        if np.linalg.norm(whole) <= radius:
            return self.axes @ whole
        low, high = 0.0, float(np.linalg.norm(self.slope)) / radius
        for _ in range(60):
            damping = 0.5 * (low + high)
            longer = np.linalg.norm(self.slope / (self.values + damping)) > radius
            low, high = (damping, high) if longer else (low, damping)
        return self.axes @ (self.slope / (self.values + high))

    def decrease(self, step: np.ndarray) -> float:
        return _cost(self.residual, self.v) - _cost(self.residual - self.jacobian @ step, self.v + step)


def _descend(problem: _Problem, v: np.ndarray, max_iterations: int, tolerance: float):
    """Gauss-Newton steps within a ball of trust, whose radius is first one standard deviation of the prior: larger steps leave
    the range in which the linearisation, and maybe the equilibrium, exists. Ends with the model at the result."""
    v, residual = _begin(problem, v)
    cost, status, radius = _cost(residual, v), "iteration-limit", _FIRST_RADIUS
    for iteration in range(1, max_iterations + 1):  # noqa: B007
        kept = problem.keep(v)
        model = _Model(problem.jacobian(v), residual, v)
        whole = model.step(math.inf)
        foreseen = model.decrease(whole)
        step, trial, radius = _trusted(problem, model, cost, radius)
        if trial is None:  # limited by rounding, or there is no equilibrium in this direction
            problem.twin.go_back(kept)
            status = "converged" if foreseen < 1e-6 * (1.0 + cost) else "stalled"
            break
        v, residual = v + step, trial
        fell, cost = cost - _cost(residual, v), _cost(residual, v)
        # The length of the step in standard deviations of the estimate is sqrt(2 foreseen).
        little = fell < 0.5 * tolerance**2
        if foreseen < 0.5 * tolerance**2 or little:
            free = np.linalg.norm(step) > 0.999 * np.linalg.norm(whole)
            status = "converged" if foreseen < 0.5 * tolerance**2 or free else "stalled"
            break
    return v, residual, iteration, status


def _trusted(problem: _Problem, model: _Model, cost: float, radius: float):
    """A step that lowers the cost, the residual after it, and the radius for the next; no residual if none does."""
    whole = float(np.linalg.norm(model.step(math.inf)))
    radius = min(radius, whole) if whole > 0.0 else radius
    smallest = 1e-3 * radius
    while radius >= smallest:
        step = model.step(radius)
        foreseen = model.decrease(step)
        try:
            trial = problem.residual(model.v + step)
            share = (cost - _cost(trial, model.v + step)) / foreseen if foreseen > 0.0 else 0.0
            if share >= 1e-4:
                return step, trial, radius * (2.0 if share > 0.75 else 1.0 if share > 0.25 else 0.5)
        except RunError:
            pass
        radius *= 0.5
    return np.zeros_like(model.v), None, radius


def solve(twin: Twin, readings: Mapping[str, Any], *, start: Optional[Sequence[float]] = None, unobservable: str = "report",
          max_iterations: int = 30, tolerance: float = 1e-3, extra: Optional[np.ndarray] = None) -> Estimate:
    """Maximum a posteriori estimate of the unknowns from readings of a robot at rest.

    Minimises |R^(-1/2) (y - h(u))|^2 + |P_0^(-1/2) (u - u_0)|^2 by the Gauss-Newton method with a region of trust, where h is
    the nonlinear static equilibrium. Derivatives use the same compliance as control (Tarantola, Inverse Problem Theory, SIAM 2005, sec. 3.4). The
    covariance follows from the linearisation at the estimate.

    Parameters
    ----------
    twin : Twin
        Left at the estimate: `twin.sim` has the estimated shape.
    readings : dict of str to float or array_like
        Readings by name of the sensor. A sensor that is missing or NaN is ignored.
    start : (inputs,) array_like, optional
        Initial guess; by default the prior mean.
    unobservable : {"report", "refuse"}
        "refuse" raises an error if the prior dominates the readings in any direction.
    max_iterations : int
    tolerance : float
        Size of the last step, in standard deviations of the estimate.
    extra : (outputs, outputs) array_like, optional
        Covariance of model errors, in addition to the sensor noise.

    Returns
    -------
    Estimate

    Raises
    ------
    Error
        unknown-name, wrong-shape, no-sensors for readings; unobservable.
    RunError
        not-converged if the model has no equilibrium at the initial guess, half-way to the prior mean, or at the prior mean.
    """
    problem = _Problem(twin, readings, extra)
    v = np.zeros(len(problem.mean)) if start is None else (np.asarray(start, float) - problem.mean) / problem.std
    v, residual, iterations, status = _descend(problem, v, max_iterations, tolerance)
    jacobian = problem.jacobian(v)
    information = jacobian.T @ jacobian + np.eye(len(v))
    covariance = np.linalg.inv(information) * np.outer(problem.std, problem.std)
    seen = observability(problem.lower @ jacobian / problem.std, problem.noise, problem.std, twin.inputs, twin.asked)
    if unobservable == "refuse" and seen.unobservable:
        raise Error("unobservable", "solve(readings)", f"the readings do not determine {'; '.join(seen.unobservable)}",
                    "add a sensor, ask for less, or take unobservable='report' and the prior's word for it")
    cost = _cost(residual, v)
    evidence = (-cost - 0.5 * np.linalg.slogdet(information)[1] - np.log(np.diag(problem.lower)).sum()
                - 0.5 * len(residual) * math.log(2.0 * math.pi))
    return _told(twin, problem, v, residual, covariance, seen, evidence, iterations, status)


def _told(twin: Twin, problem: _Problem, v, residual, covariance, seen, evidence, iterations, status) -> Estimate:
    values, std = {}, {}
    unknowns, deviations = problem.mean + problem.std * v, np.sqrt(np.diag(covariance))
    parameters = {u.path: u for u in twin.unknowns if isinstance(u, Parameter)}
    for name, value, deviation in zip(twin.inputs, unknowns, deviations):
        if name in parameters:
            value = parameters[name].start * math.exp(value)
            deviation = value * deviation
        values[name], std[name] = float(value), float(deviation)
    outputs = [name for name, seen_ in zip(twin.outputs, problem.seen) if seen_]
    chi_squared = 2.0 * _cost(residual, v)
    degrees = len(residual)  # terms of readings and prior, minus one per unknown, which leaves the number of readings
    return Estimate(values, std, twin.inputs, covariance, unknowns, seen,
                    dict(zip(outputs, twin.read()[problem.seen])), dict(zip(outputs, residual)), chi_squared, degrees,
                    float(scipy.stats.chi2.sf(chi_squared, degrees)), float(evidence), iterations, status,
                    {name: np.array(body.positions) for name, body in twin.sim.bodies.items()})


def shape_std(twin: Twin, estimate: Estimate, body: str) -> np.ndarray:
    """Standard deviation of the nodal coordinates of a finite-element body, (n, 3) m.

    Parameters
    ----------
    twin : Twin
        At the estimate, without parameters among its unknowns.
    estimate : Estimate
        Result of solve() for this twin.
    body : str
    """
    response = Response(twin.sim, twin.sim.linearise(fields=True))
    field = twin.nodal_columns(response, body)
    by_unknown = []
    for one in twin._inputs:
        if isinstance(one.unknown, Parameter):
            raise Error("bad-argument", "shape_std()", f"'{one.name}' is a parameter of the scene", "fix it first")
        by_unknown.append(_field_of(twin, response, field, one))
    motions = np.array(by_unknown)  # (inputs, n, 3)
    lower = np.linalg.cholesky(estimate.covariance)
    return np.sqrt((np.einsum("kij,kl->lij", motions, lower)**2).sum(axis=0))


def _field_of(twin: Twin, response: Response, field: np.ndarray, one) -> np.ndarray:
    _, efforts = twin.column(response, one.unknown, one.component)
    moved = np.einsum("r,rij->ij", efforts, field)
    if hasattr(one.unknown, "nodes"):
        raise Error("bad-argument", "shape_std()", "forces on nodes have no rows", "use a Force at a point")
    return moved
