"""Sobol sensitivity indices: contributions of inputs to the variance of an output."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import Error


class SobolIndices(NamedTuple):
    """Sobol indices of d inputs.

    Attributes
    ----------
    first : (d,) ndarray
        First-order indices: fraction of the variance explained by each input alone.
    total : (d,) ndarray
        Total indices: fraction that includes all interactions of each input.
    first_interval, total_interval : (d, 2) ndarray
        Bootstrap intervals.
    count : int
        Number of base points used, at which all values are finite.
    """

    first: NDArray
    total: NDArray
    first_interval: NDArray
    total_interval: NDArray
    count: int


def saltelli_points(dimensions: int, count: int, seed: int = 1) -> NDArray:
    """Evaluation points for sobol_indices().

    The base points A and B are the two halves of scrambled Sobol points (SciPy) of twice the dimension. For each of them, the
    result contains A, B and, for every input i, A with input i from B, in this order.

    Parameters
    ----------
    dimensions : int
        d, number of inputs.
    count : int
        Number of base points; powers of two are best balanced.
    seed : int
        Seed of the scrambling.

    Returns
    -------
    (count, d + 2, d) ndarray
        In [0, 1).
    """
    from scipy.stats import qmc

    both = qmc.Sobol(2 * dimensions, scramble=True, seed=seed).random_base2(max(0, int(np.ceil(np.log2(count)))))[:count]
    first, second = both[:, :dimensions], both[:, dimensions:]
    points = np.repeat(first[:, None, :], dimensions + 2, axis=1)
    points[:, 1] = second
    for i in range(dimensions):
        points[:, 2 + i, i] = second[:, i]
    return points


def sobol_indices(values: ArrayLike, *, confidence: float = 0.95, resamples: int = 200, seed: int = 1) -> SobolIndices:
    """First-order and total Sobol indices from values at the points of saltelli_points().

    With f centred, N base points and the variance V of f(A) and f(B) together:
    first order (Saltelli et al. 2010, table 2, equation (b), doi:10.1016/j.cpc.2009.09.018)
    S_i = (1/N) sum f(B) (f(A_B^i) - f(A)) / V, total (Jansen 1999, equation (f) there, doi:10.1016/S0010-4655(98)00154-4)
    T_i = (1/2N) sum (f(A) - f(A_B^i))^2 / V. The error decreases about as N^-1/2 for f with jumps, and faster for smooth f.
    Estimates near zero may be negative.

    Parameters
    ----------
    values : (count, d + 2) array_like
        Base points with a value that is not finite are omitted entirely.
    confidence : float
        Level of the bootstrap intervals over the base points, in (0, 1).
    resamples : int
        Number of bootstrap samples; 0 gives intervals of NaN.
    seed : int
        Seed of the bootstrap.

    Returns
    -------
    SobolIndices

    Raises
    ------
    Error
        wrong-shape; too-few-points if fewer than two base points remain; out-of-range.
    """
    table = np.asarray(values, float)
    if table.ndim != 2 or table.shape[1] < 3:
        raise Error("wrong-shape", "sobol_indices(values)", f"the values have the shape {table.shape}",
                    "give (base points, inputs + 2), as saltelli_points() orders them")
    if not 0.0 < confidence < 1.0:
        raise Error("out-of-range", "sobol_indices(confidence)", f"the confidence is {confidence:g}", "give a fraction such as 0.95")
    table = table[np.isfinite(table).all(axis=1)]
    if len(table) < 2:
        raise Error("too-few-points", "sobol_indices(values)", f"{len(table)} base points have all their values",
                    "take more samples, or mend those that fail")
    first, total = _estimate(table)
    draws = np.full((max(resamples, 1), 2, len(first)), np.nan)
    generator = np.random.default_rng(seed)
    for k in range(resamples):
        draws[k] = _estimate(table[generator.integers(len(table), size=len(table))])
    tail = 50.0 * (1.0 - confidence)
    low, high = np.percentile(draws, [tail, 100.0 - tail], axis=0)
    return SobolIndices(first, total, np.stack([low[0], high[0]], axis=1), np.stack([low[1], high[1]], axis=1), len(table))


def _estimate(table: NDArray) -> tuple[NDArray, NDArray]:
    both = table[:, :2]
    variance = both.var()
    if variance == 0.0:
        return np.full(table.shape[1] - 2, np.nan), np.full(table.shape[1] - 2, np.nan)
    centred = table - both.mean()
    a, b, mixed = centred[:, :1], centred[:, 1:2], centred[:, 2:]
    return (b * (mixed - a)).mean(axis=0) / variance, 0.5 * ((a - mixed) ** 2).mean(axis=0) / variance
