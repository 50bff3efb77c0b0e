"""Checks of a renderer's arguments."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Optional

import numpy as np

from ..errors import Error

__all__ = ["checked_range", "checked_size", "goal_points"]


def goal_points(goals: Any) -> list[np.ndarray]:
    """(3,) m for each goal of an array, a mapping or None. Raises wrong-shape, not-finite."""
    if goals is None:
        return []
    points = np.asarray(list(goals.values()) if isinstance(goals, Mapping) else goals, dtype=float)
    if points.size == 0:
        return []
    points = np.atleast_2d(points)
    if points.ndim != 2 or points.shape[1] != 3:
        raise Error("wrong-shape", "goals", f"they have shape {points.shape}", "give (n, 3) m, or a mapping of names to (3,)")
    if not np.isfinite(points).all():
        raise Error("not-finite", "goals", "a goal is not finite", "leave it out")
    return list(points)


def checked_size(size: Any) -> tuple[int, int]:
    """Width and height, pixels. Raises wrong-shape, out-of-range."""
    try:
        width, height = (int(part) for part in size)
    except (TypeError, ValueError):
        raise Error("wrong-shape", "size", f"{size!r} is not a size", "give width and height in pixels") from None
    if width < 1 or height < 1:
        raise Error("out-of-range", "size", f"it is {width} x {height}", "give width and height in pixels, 1 or more")
    return width, height


def checked_range(given: Any) -> Optional[tuple[float, float]]:
    """The ends of a range, or None. Raises wrong-shape, out-of-range."""
    if given is None:
        return None
    try:
        low, high = (float(part) for part in given)
    except (TypeError, ValueError):
        raise Error("wrong-shape", "field_range", f"{given!r} is not a range", "give the lower value and then the higher one") from None
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise Error("out-of-range", "field_range", f"it is {low:g} to {high:g}", "give the lower value and then the higher one")
    return low, high
