"""What all plots share: colours, displayed units, the style of matplotlib, and how a file is written."""

from __future__ import annotations

import math
import os
import pathlib

OURS, DATA, SECOND, QUIET = "#1f5fa8", "#222222", "#c8501e", "#999999"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195", "#5c5c5c")
LEGEND_ROWS = 11  # rows that fit the height of a panel
DASHES = ("-", "-.", ":")  # for the first len(COLOURS) lines, the next ones, and so on


def pyplot():
    """matplotlib.pyplot without a display, in the style of all plots."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"axes.grid": True, "grid.color": "#e4e4e4", "axes.spines.top": False,
                         "axes.spines.right": False, "legend.frameon": False,
                         "figure.constrained_layout.use": True, "legend.fontsize": 8})
    return plt


def save(figure, path) -> None:
    """Writes a figure beside the file that it then replaces: what was there stays whole until then."""
    path = pathlib.Path(path)
    draft = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        figure.savefig(draft, dpi=110, format=path.suffix.lstrip(".") or "png")
        os.replace(draft, path)
    finally:
        draft.unlink(missing_ok=True)


# Displayed unit of each SI unit, and the conversion factor.
SHOWN = {"m": ("mm", 1e3), "Pa": ("kPa", 1e-3), "m^3": ("ml", 1e6), "J": ("mJ", 1e3), "rad": ("degrees", 180 / math.pi),
         "m^3/s": ("ml/s", 1e6), "F": ("pF", 1e12)}
