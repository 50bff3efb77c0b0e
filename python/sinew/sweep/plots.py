"""Plots of the table of a sweep."""

from __future__ import annotations

import math
import os
import pathlib
from collections.abc import Callable
from typing import Any, Optional, Union

import numpy as np

from ..errors import Error
from ..plot_style import COLOURS, DASHES, DATA, LEGEND_ROWS, OURS, QUIET, SECOND, SHOWN, pyplot, save
from .table import component_names, load

_Path = Union[str, "os.PathLike[str]"]
_MAX_PANELS = 7
_MAX_GROUPS = 24  # combinations of words with curves of their own
_FLAT = 1e-5      # thickness of a set of points relative to its extent, below which it has no volume
# SI units of the quantities that measures end with.
_UNITS = {**dict.fromkeys(("displacement", "length", "x", "y", "z", "gap", "gap_above", "error"), "m"),
          **dict.fromkeys(("angle", "rx", "ry", "rz"), "rad"), **dict.fromkeys(("tension", "force", "normal_force", "friction_force"), "N"),
          "pressure": "Pa", "torque": "N m", "volume_growth": "m^3", "volume": "m^3", "stiffness": "N/m"}


class _Table:
    """Valid rows of a sweep, and the format of its columns.

    Inputs with words, such as materials, are `words`; the rows with one combination of them are a group, with a curve of its own.
    """

    def __init__(self, folder: _Path) -> None:
        table = load(folder)
        self.attrs, self.all = table.attrs, len(table)
        self.rows = table[table["status"] != "failed"]
        if not len(self.rows):
            raise Error("too-few-points", (str(folder), 0, 0, ""), "no sample of the sweep succeeded", "look at `error` in its table")
        varied = [name for name in table.attrs["inputs"] if table[name].nunique() > 1]
        self.inputs = [name for name in varied if table[name].dtype.kind in "fi"]
        self.words = [name for name in varied if name not in self.inputs]
        self.outputs = [column for name, shape in table.attrs["outputs"].items() for column in component_names(name, shape)
                        if column in table and self.rows[column].nunique() > 1]
        self._units = {name: table.attrs["units"].get(name, "") for name in self.inputs}
        self._units.update({name: _unit(name) for name in self.outputs})

    def numbers(self, name: str) -> np.ndarray:
        return self.rows[name].to_numpy(float) * self._shown(name)[1]

    def label(self, name: str) -> str:
        unit = self._shown(name)[0]
        parts = name.split(".")
        short = ".".join(parts[-2:]) if name not in self.outputs else name
        return f"{short} ({unit})" if unit else short

    def _shown(self, name: str) -> tuple[str, float]:
        unit = self._units.get(name, "")
        return SHOWN.get(unit, (unit, 1.0))

    def groups(self) -> list[tuple[str, np.ndarray]]:
        """Label and rows of each combination of words; one group without a label if there are no words."""
        if not self.words:
            return [("", np.arange(len(self.rows)))]
        found: dict[tuple[str, ...], list[int]] = {}
        for row, key in enumerate(zip(*(self.rows[name].astype(str) for name in self.words))):
            found.setdefault(key, []).append(row)
        return [(", ".join(key), np.array(rows)) for key, rows in found.items()]

    def points(self) -> Optional[tuple[str, np.ndarray]]:
        """The first output that is a position, (rows, 3) m."""
        for name, shape in self.attrs["outputs"].items():
            if shape == (3,) and name.endswith(".position"):
                return name, self.rows[component_names(name, shape)].to_numpy(float)
        return None


def _unit(name: str) -> str:
    """SI unit of a component of a measure; empty if it is not known."""
    if name.endswith(("_energy", "_work")) or name in ("dissipation", "numerical_loss"):
        return "J"
    last = name.rpartition(".")[2]
    return _UNITS.get(last, "m" if last.isdigit() and ".position" in name else "")


def _finite(values: np.ndarray) -> np.ndarray:
    """The values that are known: a gap that was not measured is NaN."""
    return values[np.isfinite(values)]


def _legend(axis: Any, table: _Table) -> None:
    """Names the groups beside an axis."""
    labels = axis.get_legend_handles_labels()[1]
    if labels:
        axis.legend(title=", ".join(table.label(name) for name in table.words), loc="upper left", bbox_to_anchor=(1.0, 1.02),
                    title_fontsize=8, ncol=1 + (len(labels) - 1) // LEGEND_ROWS)


def _colour(group: int) -> str:
    return COLOURS[group % len(COLOURS)]


def _style(group: int) -> dict[str, Any]:
    """Colour and dashes of the curve of a group: after the last colour, the colours repeat with other dashes."""
    return {"color": _colour(group), "linestyle": DASHES[group // len(COLOURS) % len(DASHES)]}


def _scatter(plt: Any, table: _Table) -> Any:
    """Scatter matrix of all pairs of columns, with histograms on the diagonal, in the colours of the groups."""
    names = (table.inputs[: _MAX_PANELS - 1] + table.outputs)[:_MAX_PANELS]
    if len(names) < 2:
        return None
    size, groups = len(names), table.groups()
    figure, axes = plt.subplots(size, size, figsize=(1.9 * size + 1, 1.9 * size + 0.5), squeeze=False, sharex="col")
    for i, upper in enumerate(names):
        for j, right in enumerate(names):
            axis = axes[i, j]
            if i == j:
                axis.hist([_finite(table.numbers(upper)[rows]) for _, rows in groups], bins=20, stacked=True,
                          color=[_colour(k) if table.words else OURS for k in range(len(groups))])
            else:
                colour = DATA if upper in table.inputs else OURS
                for k, (label, rows) in enumerate(groups):
                    axis.plot(table.numbers(right)[rows], table.numbers(upper)[rows], ".", ms=2.5, label=label or None,
                              color=_colour(k) if table.words else colour)
            if i == size - 1:
                axis.set_xlabel(table.label(right).replace(" (", "\n("), fontsize=7)
            if j == 0:
                axis.set_ylabel(table.label(upper).replace(" (", "\n("), fontsize=7)
            axis.tick_params(labelsize=6)
    _legend(axes[0, -1], table)
    return figure


def _parallel(plt: Any, table: _Table) -> Any:
    """A line for each sample through its inputs and outputs, coloured by the last output. Words are equally spaced on their axis."""
    names = table.words + table.inputs + table.outputs
    if len(names) < 2:
        return None
    words = {name: list(dict.fromkeys(table.rows[name].astype(str))) for name in table.words}
    columns = [np.array([words[name].index(word) for word in table.rows[name].astype(str)], dtype=float) if name in words
               else table.numbers(name) for name in names]
    ends = [(seen.min(), seen.max()) if (seen := _finite(column)).size else (math.nan, math.nan) for column in columns]
    scaled = np.array([(column - low) / (high - low) if high > low else 0.5 + 0 * column for column, (low, high) in zip(columns, ends)])
    figure, axis = plt.subplots(figsize=(1.5 * len(names) + 1.5, 4.2))
    colours = plt.get_cmap("viridis").with_extremes(bad=QUIET)(np.ma.masked_invalid(scaled[-1]))
    for k in np.argsort(scaled[-1]):
        axis.plot(range(len(names)), scaled[:, k], lw=0.7, alpha=0.6, color=colours[k])
    for k, (name, reach) in enumerate(zip(names, ends)):
        axis.axvline(k, color=DATA, lw=0.8)
        if name in words:
            for word, at in zip(words[name], np.linspace(0.0, 1.0, len(words[name]))):
                axis.text(k + 0.03, at, word, ha="left", va="center", fontsize=7)
            continue
        for at, number in zip((-0.04, 1.02), reach):
            axis.text(k, at, f"{number:.3g}", ha="center", va="bottom" if at > 0 else "top", fontsize=7)
    axis.set(xticks=range(len(names)), yticks=[], xlim=(-0.3, len(names) - 0.7), ylim=(-0.1, 1.1))
    axis.set_xticklabels([table.label(name).replace(" (", "\n(") for name in names], fontsize=7)
    axis.grid(False)
    return figure


def _surface(plt: Any, table: _Table) -> Any:
    """Outputs over the first two inputs, as filled contours; over a single input, as a curve; over words alone, as bars.

    With words, each of their combinations has its own curve, or its own panel of contours.
    """
    if not table.outputs or not (table.inputs or table.words):
        return None
    groups = table.groups()[:_MAX_GROUPS]
    apart = len(table.inputs) > 1
    panels = [(name, k) for name in table.outputs[:6] for k in range(len(groups) if apart else 1)][:_MAX_GROUPS]
    columns = min(len(groups) if apart and len(groups) > 1 else 3, len(panels), 6)
    lines = -(-len(panels) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(4.2 * columns + (1.5 if table.words else 0), 3.4 * lines), squeeze=False)
    for axis, (name, k) in zip(axes.flat, panels):
        if apart:
            _contours(figure, axis, table, name, *groups[k])
        elif table.inputs:
            _curves(axis, table, name, groups)
        else:
            values = table.numbers(name)
            axis.bar(range(len(groups)), [_finite(values[rows]).mean() if _finite(values[rows]).size else math.nan for _, rows in groups], color=[_colour(g) for g in range(len(groups))])
            axis.set_xticks(range(len(groups)), [label for label, _ in groups], rotation=30, ha="right", fontsize=7)
            axis.set_ylabel(table.label(name))
    if not apart and table.inputs:
        _legend(axes[0, columns - 1], table)
    for axis in axes.flat[len(panels):]:
        axis.set_visible(False)
    return figure


def _curves(axis: Any, table: _Table, name: str, groups: list[tuple[str, np.ndarray]]) -> None:
    """An output over the only input, a curve for each group."""
    first, values = table.numbers(table.inputs[0]), table.numbers(name)
    axis.set(xlabel=table.label(table.inputs[0]), ylabel=table.label(name))
    for k, (label, rows) in enumerate(groups):
        order = rows[np.argsort(first[rows], kind="stable")]
        axis.plot(first[order], values[order], marker=".", ms=4, label=label or None,
                  **(_style(k) if table.words else {"color": OURS}))


def _contours(figure: Any, axis: Any, table: _Table, name: str, label: str, rows: np.ndarray) -> None:
    """An output of a group over the first two inputs."""
    rows = rows[np.isfinite(table.numbers(name)[rows])]
    first, second, values = (table.numbers(column)[rows] for column in (*table.inputs[:2], name))
    axis.set(xlabel=table.label(table.inputs[0]), ylabel=table.label(table.inputs[1]),
             title=f"{table.label(name)}\n{label}" if label else table.label(name))
    # With more than two inputs there are several values at a point: draw points instead of contours.
    flat = len(np.unique(first)) < 2 or len(np.unique(second)) < 2 or len(first) < 4 or np.all(values == values[0])
    if len(table.inputs) > 2 or flat:
        drawn = axis.scatter(first, second, c=values, s=14, cmap="viridis")
    else:
        drawn = axis.tricontourf(first, second, values, levels=16, cmap="viridis")
        axis.plot(first, second, ".", ms=1.5, color="#ffffff80")
    figure.colorbar(drawn, ax=axis)


def _volume(points: np.ndarray) -> Optional[float]:
    """Volume of the hull of points, m^3; None if they lie in a plane, or nearly so."""
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 4:
        return None
    extent = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if extent[2] <= _FLAT * extent[0]:
        return None
    try:
        return float(ConvexHull(points).volume)
    except QhullError:
        return None


def _workspace(plt: Any, table: _Table) -> Any:
    """Positions of a point seen along the three axes, with their hulls; the title gives the volume of the hull."""
    found = table.points()
    if found is None:
        return None
    from scipy.spatial import ConvexHull, QhullError

    name, points = found
    good = np.isfinite(points).all(axis=1)
    figure, axes = plt.subplots(1, 3, figsize=(14.5 if table.words else 13, 4.4))
    for axis, (a, b) in zip(axes, ((0, 2), (1, 2), (0, 1))):
        seen = 1e3 * points[:, [a, b]]
        for k, (label, rows) in enumerate(table.groups()):
            axis.plot(*seen[rows].T, ".", ms=3, color=_colour(k) if table.words else OURS, label=label or None)
        try:
            hull = ConvexHull(seen[good])
            corners = seen[good][np.append(hull.vertices, hull.vertices[0])]
            axis.plot(*corners.T, color=QUIET if table.words else SECOND, lw=1)
        except (QhullError, ValueError):
            pass  # collinear, or too few points
        axis.set(xlabel=f"{'xyz'[a]} (mm)", ylabel=f"{'xyz'[b]} (mm)")
        axis.set_aspect("equal", adjustable="datalim")
    _legend(axes[-1], table)
    volume = _volume(points[good])
    text = f"hull {1e6 * volume:.4g} ml" if volume is not None else "in a plane, no volume"
    figure.suptitle(f"{name}: {good.sum()} points, {text}")
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
    plt, table, drawn = pyplot(), _Table(folder), []
    where = pathlib.Path(folder if out is None else out)
    for name in KINDS if kind is None else [kind]:
        figure = KINDS[name](plt, table)
        if figure is None:
            continue
        path = where if kind is not None and out is not None else where / f"{name}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        save(figure, path)
        plt.close(figure)
        drawn.append(path)
    if not drawn:
        raise Error("too-few-points", (str(folder), 0, 0, ""), "the table has no columns to draw" + (f" as {kind}" if kind else ""),
                    "vary and measure numbers; a workspace needs a position of an effector")
    return drawn
