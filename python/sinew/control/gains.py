"""Gains of a loop, constant or scheduled, and their limit for a given delay."""

from __future__ import annotations

import math
from typing import Any, Callable, NamedTuple, Sequence

import numpy as np

from ..errors import Error

__all__ = ["Gains", "Schedule", "delay_limit"]


class Gains(NamedTuple):
    """Gains of the requested effector velocity v = dr/dt + rate e + integral (time integral of e), with the target r and the
    measured error e.

    Attributes
    ----------
    rate : float
        1/s, > 0: without delay, the error decays as exp(-rate t).
    integral : float
        1/s^2, >= 0. Without it, a disturbance that grows by d m/s leaves the error d/rate; with it, none. The loop is
        critically damped at rate^2/4.
    """

    rate: float = 5.0
    integral: float = 0.0

    def check(self, place: str) -> "Gains":
        """Checks the gains and returns them.

        Raises
        ------
        Error
            out-of-range: not finite, a rate of 0 or less, an integral gain below 0.
        """
        checks = (("rate", self.rate, self.rate > 0.0), ("integral", self.integral, self.integral >= 0.0))
        for name, value, good in checks:
            if not (good and math.isfinite(value)):
                raise Error("out-of-range", f"{place}.{name}", f"it is {value}",
                            "give a finite rate above 0 and an integral gain of 0 or more")
        return self


class Schedule:
    """Gain schedule over a variable: linear between the points, constant beyond them.

    If the gains change slowly compared with the loop, the loop is as stable as with each of them (Shamma & Athans,
    Automatica 27 (1991) 559-564). There is no such guarantee for a variable that changes as fast as the loop itself.

    Parameters
    ----------
    variable : callable
        Function of the loop before its step that returns a float: loop.positions["tip"][2], loop.time, ...
    points : (n,) array_like
        Ascending values of the variable.
    gains : list of Gains
        Gains at these points.

    Raises
    ------
    Error
        wrong-type, wrong-length, not-finite, non-monotonic-time: points that do not ascend.
    """

    def __init__(self, variable: Callable[[Any], float], points: Sequence[float], gains: Sequence[Gains]) -> None:
        if not callable(variable):
            raise Error("wrong-type", "Schedule(variable)", f"{variable!r} cannot be called",
                        "give a function of the loop, such as lambda loop: loop.positions['tip'][2]")
        self.variable = variable
        self.points = np.array(points, dtype=float)
        self.gains = [Gains(*each).check(f"Schedule(gains)[{k}]") for k, each in enumerate(gains)]
        if self.points.ndim != 1 or len(self.points) != len(self.gains) or not len(self.gains):
            raise Error("wrong-length", "Schedule(gains)", f"{len(self.gains)} gains for {self.points.size} points",
                        "give gains for each point")
        if not np.isfinite(self.points).all() or (np.diff(self.points) <= 0.0).any():
            raise Error("non-monotonic-time", "Schedule(points)", f"{list(self.points)} do not ascend",
                        "give finite, ascending numbers")

    def at(self, value: float) -> Gains:
        """Gains at a value of the variable."""
        if not math.isfinite(value):
            raise Error("not-finite", "Schedule(variable)", f"it returned {value}", "return a finite number")
        return Gains(*(float(np.interp(value, self.points, [each[k] for each in self.gains])) for k in range(2)))


def delay_limit(delay: int) -> float:
    """Largest stable rate times sample time, rate * T, of a resolved-rate loop with an exact Jacobian.

    The loop is an integrator with a delay, x[n+1] = x[n] - k x[n-d]. The largest root of its characteristic polynomial
    z^(d+1) - z^d + k lies on the unit circle, at z = exp(i pi/(2 d + 1)), for

        k = 2 sin(pi/(2 (2 d + 1))):

    2 without delay, 1 with one sample, 0.618 with two. For long delays k -> pi/(2 d), the limit rate < pi/(2 tau) of
    continuous time (Levin & May, Theoretical Population Biology 9 (1976) 178-187). If the Jacobian is inexact and the
    eigenvalues of J_real J_model^+ are real and positive, divide the limit by the largest of them.

    Parameters
    ----------
    delay : int
        d, number of samples between the effect of a command and the measurement that the loop uses, >= 0.
    """
    if delay < 0:
        raise Error("out-of-range", "delay_limit(delay)", f"it is {delay}", "give samples, 0 or more")
    return 2.0 * math.sin(math.pi / (2.0 * (2 * delay + 1)))
