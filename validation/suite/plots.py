"""Common style of all plots."""

from __future__ import annotations

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

OURS = "#1f5fa8"
REFERENCE = "#222222"
SECOND = "#c8501e"
THIRD = "#3a8a4d"
QUIET = "#999999"

plt.rcParams.update(
    {
        "font.size": 10,
        "axes.grid": True,
        "grid.color": "#e4e4e4",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.titlesize": 11,
        "legend.frameon": False,
        "lines.markersize": 5,
        "figure.constrained_layout.use": True,
    }
)


def axes(columns: int = 1, width: float = 6.4, height: float = 3.8):
    """A figure and its axes (an array of them for several columns)."""
    return plt.subplots(1, columns, figsize=(width if columns == 1 else 4.6 * columns, height))


def slope_line(axis, steps, errors, order: float) -> None:
    """A dashed line of the expected slope through the finest point."""
    finest = min(range(len(steps)), key=lambda i: steps[i])
    line = [0.75 * errors[finest] * (s / steps[finest]) ** order for s in steps]
    axis.plot(steps, line, "--", color=REFERENCE, lw=1, label=f"slope {order:g}")
