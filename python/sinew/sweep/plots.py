"""Plots of the table of a sweep."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable
from typing import Any, Optional, Union

import numpy as np

from .. import plot
from ..errors import Error
from .table import component_names, load

_Path = Union[str, "os.PathLike[str]"]
_MAX_PANELS = 7
# Displayed unit of each SI unit, and the conversion factor.
_SHOWN = {"m": ("mm", 1e3), "Pa": ("kPa", 1e-3), "m^3": ("ml", 1e6), "J": ("mJ", 1e3)}


class _Table:
    """Valid rows of a sweep, and the format of its columns."""

    def __init__(self, folder: _Path) -> None:
        table = load(folder)
        self.attrs, self.all = table.attrs, len(table)
        self.rows = table[table["status"] != "failed"]
        units = table.attrs["units"]
        self.inputs = [name for name in table.attrs["inputs"] if table[name].dtype.kind in "fi" and table[name].nunique() > 1]
        self.outputs = [column for name, shape in table.attrs["outputs"].items() for column in component_names(name, shape)
                        if column in table and self.rows[column].nunique() > 1]
        self._units = {name: units.get(name, "") for name in self.inputs}
        self._units.update({name: "m" for name in self.outputs if ".position." in name})
        self._units.update({name: "J" for name in self.outputs if name.endswith(("_energy", "_work"))})
        if not len(self.rows):
            raise Error("too-few-points", (str(folder), 0, 0, ""), "no sample of the sweep succeeded", "look at `error` in its table")

    def numbers(self, name: str) -> np.ndarray:
        return self.rows[name].to_numpy(float) * self._shown(name)[1]

    def label(self, name: str) -> str:
        unit = self._shown(name)[0]
        parts = name.split(".")
        short = ".".join(parts[-2:]) if name in self.inputs else name
        return f"{short} ({unit})" if unit else short

    def _shown(self, name: str) -> tuple[str, float]:
        unit = self._units.get(name, "")
        return _SHOWN.get(unit, (unit, 1.0))

    def points(self) -> Optional[tuple[str, np.ndarray]]:
        """The first output that is a position, (rows, 3) m."""
        for name, shape in self.attrs["outputs"].items():
            if shape == (3,) and name.endswith(".position"):
                return name, self.rows[component_names(name, shape)].to_numpy(float)
        return None


def _scatter(plt: Any, table: _Table) -> Any:
    """Scatter matrix of all pairs of columns, with histograms on the diagonal."""
    names = (table.inputs[: _MAX_PANELS - 1] + table.outputs)[:_MAX_PANELS]
    if len(names) < 2:
        return None
    size = len(names)
    figure, axes = plt.subplots(size, size, figsize=(1.9 * size + 1, 1.9 * size + 0.5), squeeze=False, sharex="col")
    for i, upper in enumerate(names):
        for j, right in enumerate(names):
            axis = axes[i, j]
            if i == j:
                axis.hist(table.numbers(upper), bins=20, color=plot.OURS)
            else:
                colour = plot.DATA if upper in table.inputs else plot.OURS
                axis.plot(table.numbers(right), table.numbers(upper), ".", ms=2.5, color=colour)
            if i == size - 1:
                axis.set_xlabel(table.label(right).replace(" (", "\n("), fontsize=7)
            if j == 0:
                axis.set_ylabel(table.label(upper).replace(" (", "\n("), fontsize=7)
            axis.tick_params(labelsize=6)
    return figure


def _parallel(plt: Any, table: _Table) -> Any:
    """A line for each sample through its inputs and outputs, coloured by the last output."""
    names = table.inputs + table.outputs
    if len(names) < 2:
        return None
    columns = [table.numbers(name) for name in names]
    scaled = np.array([(column - column.min()) / np.ptp(column) if np.ptp(column) else 0.5 + 0 * column for column in columns])
    figure, axis = plt.subplots(figsize=(1.5 * len(names) + 1.5, 4.2))
    colours = plt.get_cmap("viridis")(scaled[-1])
    for k in np.argsort(scaled[-1]):
        axis.plot(range(len(names)), scaled[:, k], lw=0.7, alpha=0.6, color=colours[k])
    for k, column in enumerate(columns):
        axis.axvline(k, color=plot.DATA, lw=0.8)
        for at, number in ((-0.04, column.min()), (1.02, column.max())):
            axis.text(k, at, f"{number:.3g}", ha="center", va="bottom" if at > 0 else "top", fontsize=7)
    axis.set(xticks=range(len(names)), yticks=[], xlim=(-0.3, len(names) - 0.7), ylim=(-0.1, 1.1))
    axis.set_xticklabels([table.label(name).replace(" (", "\n(") for name in names], fontsize=7)
    axis.grid(False)
    return figure


def _surface(plt: Any, table: _Table) -> Any:
    """Outputs over the first two inputs, as filled contours; over a single input, as a line."""
    if not table.inputs or not table.outputs:
        return None
    names = table.outputs[:6]
    columns = min(3, len(names))
    figure, axes = plt.subplots(-(-len(names) // columns), columns, figsize=(4.2 * columns, 3.4 * -(-len(names) // columns)), squeeze=False)
    first = table.numbers(table.inputs[0])
    for axis, name in zip(axes.flat, names):
        values = table.numbers(name)
        axis.set(xlabel=table.label(table.inputs[0]), title=table.label(name))
        if len(table.inputs) == 1:
            order = np.argsort(first)
            axis.plot(first[order], values[order], ".-", color=plot.OURS, ms=4)
            continue
        second = table.numbers(table.inputs[1])
        axis.set_ylabel(table.label(table.inputs[1]))
        # With more than two inputs there are several values at a point: draw points instead of contours.
        flat = len(np.unique(first)) < 2 or len(np.unique(second)) < 2 or len(first) < 4
        if len(table.inputs) > 2 or flat:
            drawn = axis.scatter(first, second, c=values, s=14, cmap="viridis")
        else:
            drawn = axis.tricontourf(first, second, values, levels=16, cmap="viridis")
            axis.plot(first, second, ".", ms=1.5, color="#ffffff80")
        figure.colorbar(drawn, ax=axis)
    for axis in axes.flat[len(names):]:
        axis.set_visible(False)
    return figure


def _workspace(plt: Any, table: _Table) -> Any:
    """Positions of a point seen along the three axes, with their hulls; the title gives the volume of the hull."""
    found = table.points()
    if found is None:
        return None
    from scipy.spatial import ConvexHull, QhullError

    name, points = found
    points = points[np.isfinite(points).all(axis=1)]

    def hull(of: np.ndarray) -> Optional[ConvexHull]:
        try:
            return ConvexHull(of)
        except (QhullError, ValueError):
            return None  # collinear, coplanar, or too few points

    whole = hull(points)
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.4))
    for axis, (a, b) in zip(axes, ((0, 2), (1, 2), (0, 1))):
        seen = 1e3 * points[:, [a, b]]
        axis.plot(*seen.T, ".", ms=3, color=plot.OURS)
        round_it = hull(seen)
        if round_it is not None:
            corners = seen[np.append(round_it.vertices, round_it.vertices[0])]
            axis.plot(*corners.T, color=plot.SECOND, lw=1)
        axis.set(xlabel=f"{'xyz'[a]} (mm)", ylabel=f"{'xyz'[b]} (mm)")
        axis.set_aspect("equal", adjustable="datalim")
    text = f"hull {1e6 * whole.volume:.4g} ml" if whole is not None else "no volume"
    figure.suptitle(f"{name}: {len(points)} points, {text}")
    return figure


KINDS: dict[str, Callable[[Any, _Table], Any]] = {
    "scatter": _scatter, "parallel": _parallel, "surface": _surface, "workspace": _workspace}


def draw(folder: _Path, out: Optional[_Path] = None, kind: Optional[str] = None) -> list[pathlib.Path]:
    """Plots a sweep: scatter matrix, parallel coordinates, response surfaces, and the workspace of the first position.

    Parameters
    ----------
    folder : path-like
        Folder of the sweep, which may still be running.
    out : path-like, optional
        Output folder for scatter.png, parallel.png, surface.png and workspace.png, by default the folder of the sweep.
        With `kind`, the PNG file.
    kind : str, optional
        Plot only "scatter", "parallel", "surface" or "workspace".

    Returns
    -------
    list of Path
        Files written. Plots without suitable columns are skipped.

    Raises
    ------
    Error
        unknown-choice; too-few-points if the requested plot has no data; and the errors of load().
    """
    if kind is not None and kind not in KINDS:
        raise Error("unknown-choice", "plot(kind)", f"there is no plot '{kind}'", f"choose one of {', '.join(KINDS)}")
    plt, table, drawn = plot._pyplot(), _Table(folder), []
    where = pathlib.Path(folder if out is None else out)
    for name in KINDS if kind is None else [kind]:
        figure = KINDS[name](plt, table)
        if figure is None:
            continue
        path = where if kind is not None and out is not None else where / f"{name}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, dpi=110)
        plt.close(figure)
        drawn.append(path)
    if not drawn:
        raise Error("too-few-points", (str(folder), 0, 0, ""), "the table has no columns to draw" + (f" as {kind}" if kind else ""),
                    "vary and measure numbers; a workspace needs a position of an effector")
    return drawn
