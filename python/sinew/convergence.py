"""Mesh convergence studies: estimate the discretisation error of a scene from runs on finer meshes.

    import sinew.convergence
    study = sinew.convergence.study("beam.yaml", static=True)
    study["tip.position"].relative_error            # of the scene's own mesh

SI units everywhere. docs/convergence.md is the guide. Needs SciPy and PyYAML.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import pathlib
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Optional, Union

import numpy as np

from . import command, mesh, scene
from ._whole_files import draft
from .errors import Error
from .sweep.runner import measure as measure_now

__all__ = ["Estimate", "Level", "Study", "study"]

#: Range of orders accepted as convergence. Displacements and energies reach order 1 even around a crack (Strang and Fix, An Analysis
#: of the Finite Element Method, 1973, section 8.1); a lower observed order means that the meshes are too coarse.
LEAST_ORDER, LARGEST_ORDER = 1.0, 6.0
#: Rounding error of sums over some thousand nodes: smaller values count as zero. It applies to displacements relative to the
#: largest coordinate, to rotations in rad, and to values of a robot that does not move, in SI units.
_ROUNDING = 1e3 * float(np.finfo(float).eps)
#: Richardson's extrapolation holds for meshes that are alike but for the size of their cells. Largest factor by which the number of
#: elements may differ from that of such a mesh: rounding to even numbers of cells makes two cells four instead of three.
_ALIKE = 1.2


@dataclass(frozen=True)
class Level:
    """Result on one mesh of a study.

    Attributes
    ----------
    elements, nodes : int
        Totals of all deformable bodies.
    size : float
        h = (volume/elements)^(1/3), m.
    seconds : float
        Wall time of loading and simulating.
    values : dict
        Value of each measure, (k,) or (). Positions are displacements from the start, m.
    """

    elements: int
    nodes: int
    size: float
    seconds: float
    values: dict[str, np.ndarray]


@dataclass(frozen=True)
class Estimate:
    """Convergence of one measure.

    With values f_k on meshes of size h_k, the last being the finest, and the order p of convergence, Richardson's extrapolation is
    f = f_n + (f_n - f_(n-1))/((h_(n-1)/h_n)^p - 1) (L. F. Richardson, Phil. Trans. R. Soc. A 210, 1911; P. J. Roache, J. Fluids
    Eng. 116, 1994, eq. 9 to 11, also for the uncertainty).

    Attributes
    ----------
    order : float or None
        Observed order p on the last three meshes. None, and p = 1 is used, for two meshes, or if the differences do not
        shrink in one direction as h^p with p from 1 to 6.
    extrapolated : ndarray
        f, the estimate without discretisation error.
    error : float
        |f_0 - f|, the error of the scene's own mesh.
    relative_error : float
        The same divided by |f|; NaN if f is zero.
    uncertainty : float
        Uncertainty of `extrapolated`: |f_n - f| times Roache's safety factor, 1.25 with an observed order, else 3.
    """

    order: Optional[float]
    extrapolated: np.ndarray
    error: float
    relative_error: float
    uncertainty: float


@dataclass(frozen=True)
class Study(Mapping[str, Estimate]):
    """Result of a convergence study: a mapping from measures to estimates.

    Attributes
    ----------
    levels : tuple of Level
        The scene's own mesh, then the finer ones.
    estimates : dict
    """

    levels: tuple[Level, ...]
    estimates: dict[str, Estimate]

    def __getitem__(self, name: str) -> Estimate:
        return self.estimates[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.estimates)

    def __len__(self) -> int:
        return len(self.estimates)


def study(
    scene: Union[str, os.PathLike[str], Mapping[str, Any]],  # noqa: A002 - as sinew.load()
    *,
    measure: Optional[Sequence[str]] = None,
    levels: int = 3,
    duration: Optional[float] = None,
    static: bool = False,
    set: scene.Overrides = None,  # noqa: A002
    progress: bool = False,
) -> Study:
    """Runs a scene on its own meshes and on finer ones, and extrapolates the final values to zero element size.

    The cells of primitive shapes become smaller by factors of 1.5, 2, 2.5, ..., without those that numbers of cells, even for
    tetrahedra, cannot follow: a block of two cells per edge has four, six, ... . Tetrahedra of mesh files are split into eight per
    level. The estimate needs meshes on which the differences shrink: see `Estimate.order`.

    Parameters
    ----------
    scene : path-like or dict
        As in sinew.load().
    measure : sequence of str, optional
        Observables such as "tip.position", or body quantities such as "trunk.strain_energy". By default the positions and
        rotations of all effectors.
    levels : int
        Number of meshes, including the scene's own; 2 or more.
    duration : float, optional
        Simulated time, s; by default the scene's.
    static : bool
        Solve for static equilibrium under the initial commands and loads instead of simulating.
    set : list of str or dict, optional
        As in sinew.load().
    progress : bool
        Whether to report each mesh on standard error.

    Returns
    -------
    Study

    Raises
    ------
    Error
        bad-argument if there is nothing to measure or to refine, or if a measure is zero to rounding on every mesh, such as the
        displacement of a robot without load; unsupported-element for hexahedra and quadratic tetrahedra of mesh files; and the
        errors of sinew.load() and Simulation.run().
    """
    if levels < 2:
        raise Error("out-of-range", "study(levels)", f"a single mesh shows no convergence, and levels is {levels}", "give 2 or more")
    with tempfile.TemporaryDirectory() as folder:
        refinement = _Refinement(scene, set, pathlib.Path(folder))
        found: list[Level] = []
        idle: list[frozenset[str]] = []  # for each mesh, the measures that are zero to rounding
        for k in range(levels):
            begin = time.perf_counter()
            sim = refinement.load(k, found[-1] if found else None)
            names = _measures(sim) if measure is None else list(measure)
            values, rounding = _values(sim, names, duration, static)
            idle.append(rounding)
            found.append(_level(sim, values, time.perf_counter() - begin))
            if progress:
                one = found[-1]
                print(f"mesh {k + 1} of {levels}: {one.elements} elements, {one.seconds:.1f} s", file=sys.stderr)
    _refuse_rounding(names, frozenset.intersection(*idle), found)
    sizes = [level.size for level in found]
    return Study(tuple(found), {name: _estimate(sizes, [level.values[name] for level in found]) for name in names})


class _Refinement:
    """A scene on successively finer meshes."""

    def __init__(self, given: Any, overrides: scene.Overrides, folder: pathlib.Path) -> None:
        import yaml

        self._folder = folder
        self._first = _load(given, overrides)
        self._tree = yaml.safe_load(self._first.to_yaml())
        self._files: dict[str, tuple[int, mesh.Mesh]] = {}  # level and mesh of each body with a mesh file
        self._bodies = [name for name, body in self._tree["bodies"].items() if body.get("type") == "fem"]
        if not self._bodies:
            raise Error("bad-argument", "convergence", "the scene has no body of finite elements", "use a scene with a mesh to refine")
        self._sizes = {name: _edge(self._first.body(name)) for name in self._bodies}
        self._shrink = 1.0  # of the last mesh

    def load(self, k: int, before: Optional[Level]) -> Any:
        """The scene on its k-th mesh."""
        if k == 0:
            return self._first
        usable = []  # how far each candidate is from being alike, its factor and the scene
        for _ in range(8):
            self._shrink += 0.5  # two cells become three, then four ...
            for name in self._bodies:
                self._refine(name, k, self._shrink)
            sim = _load(self._tree, None)
            if before is None or _count(sim)[0] > 1.2 * before.elements:  # else rounding gave the same whole numbers of cells
                usable.append((self._unlikeness(sim), self._shrink, sim))
            if len(usable) == 2 or (usable and usable[-1][0] < _ALIKE):
                break
        if not usable:
            return sim
        _, self._shrink, sim = min(usable, key=lambda candidate: candidate[:2])
        return sim

    def _unlikeness(self, sim: Any) -> float:
        """Factor, >= 1, between the number of elements and that of a mesh refined alike in all directions; splitting is so always."""
        if any("shape" not in self._tree["bodies"][name]["mesh"] for name in self._bodies):
            return 1.0
        ratio = _count(sim)[0] / (_count(self._first)[0] * self._shrink**3)
        return max(ratio, 1.0 / ratio)

    def _refine(self, name: str, k: int, shrink: float) -> None:
        own = self._tree["bodies"][name]["mesh"]
        if "shape" in own:
            own["element_size"] = self._sizes[name] / shrink
            return
        if self._files.get(name, (0,))[0] != k:
            last = self._files[name][1] if name in self._files else mesh.read(own["file"], own.get("unit"))
            self._files[name] = (k, last.refined())
            path = self._folder / f"{name}_{k}.vtu"
            self._files[name][1].write(path)
            own.update(file=str(path), unit="m")


def _load(given: Any, overrides: scene.Overrides) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about locking elements, whose effect the study quantifies
        return scene.load(given, set=overrides)


def _deformable(sim: Any) -> list[Any]:
    return [body for body in sim.bodies.values() if len(body.tetrahedra) + len(body.hexahedra)]


def _count(sim: Any) -> tuple[int, int]:
    bodies = _deformable(sim)
    return sum(len(b.tetrahedra) + len(b.hexahedra) for b in bodies), sum(len(b.positions) for b in bodies)


def _edge(body: Any) -> float:
    """Approximate edge length of a body's cells, m: a cube is one hexahedron or six tetrahedra."""
    count = len(body.hexahedra) or len(body.tetrahedra) / 6
    return float((body.volume / count) ** (1 / 3))


def _measures(sim: Any) -> list[str]:
    wanted = [f"{name}.{quantity}" for name in sim.effectors for quantity in ("position", "rotation")]
    names = [name for name in sim.run(0.0) if name in wanted]
    if not names:
        raise Error("bad-argument", "convergence", "the scene has no effectors",
                    "name a quantity to compare, for example --measure BODY.strain_energy")
    return names


def _values(sim: Any, names: list[str], duration: Optional[float], static: bool) -> tuple[dict[str, np.ndarray], frozenset[str]]:
    """Final values of the measures, and the names of those that are zero to rounding."""
    start, before = measure_now(sim, names), [np.array(body.positions) for body in _deformable(sim)]
    if static:
        sim.solve_static()
    else:
        sim.run(duration)
    end, after = measure_now(sim, names), [np.array(body.positions) for body in _deformable(sim)]
    values = {name: end[name] - start[name] if name.endswith(".position") else end[name] for name in names}
    reach = max(float(np.abs(x).max()) for x in before)
    moves = any(float(np.abs(y - x).max()) > _ROUNDING * reach for x, y in zip(before, after))
    return values, frozenset(name for name in names if _is_rounding(name, values[name], reach, moves))


def _is_rounding(name: str, value: np.ndarray, reach: float, moves: bool) -> bool:
    size = float(np.abs(value).max(initial=0.0))
    if name.endswith(".position"):
        return size <= _ROUNDING * reach
    return size <= _ROUNDING and (not moves or name.endswith(".rotation"))


def _refuse_rounding(names: Sequence[str], idle: frozenset[str], found: Sequence[Level]) -> None:
    for name in names:
        if name in idle:
            largest = max(float(np.abs(level.values[name]).max(initial=0.0)) for level in found)
            what = "displacement" if name.endswith(".position") else "value"
            raise Error("bad-argument", name,
                        f"its {what} is zero to rounding on every mesh, at most {largest:.2g}, so there is no error to estimate",
                        "give the scene a load or a command (without the key `gravity` there is no weight), or name another measure")


def _level(sim: Any, values: dict[str, np.ndarray], seconds: float) -> Level:
    elements, nodes = _count(sim)
    volume = sum(body.volume for body in _deformable(sim))
    return Level(elements, nodes, float((volume / elements) ** (1 / 3)), seconds, values)


def _order(sizes: Sequence[float], values: Sequence[np.ndarray]) -> Optional[float]:
    """p of the last three values, from |f_1 - f_0|/|f_2 - f_1| = (h_0^p - h_1^p)/(h_1^p - h_2^p); None as described in Estimate.order."""
    from scipy.optimize import brentq

    if len(values) < 3:
        return None
    (h0, h1, h2), (f0, f1, f2) = sizes[-3:], values[-3:]
    first, second = np.ravel(f1 - f0), np.ravel(f2 - f1)
    if float(first @ second) <= 0.0:
        return None
    ratio = float(np.linalg.norm(first) / np.linalg.norm(second))

    def miss(p: float) -> float:
        return (h0**p - h1**p) / (h1**p - h2**p) - ratio

    if miss(LEAST_ORDER) * miss(LARGEST_ORDER) > 0.0:
        return None
    return float(brentq(miss, LEAST_ORDER, LARGEST_ORDER, xtol=1e-10))


def _estimate(sizes: Sequence[float], values: Sequence[np.ndarray]) -> Estimate:
    order = _order(sizes, values)
    last = values[-1] - values[-2]
    beyond = last / ((sizes[-2] / sizes[-1]) ** (order or 1.0) - 1.0)
    extrapolated = values[-1] + beyond
    error, size = float(np.linalg.norm(values[0] - extrapolated)), float(np.linalg.norm(extrapolated))
    return Estimate(order, extrapolated, error, error / size if size > 0.0 else math.nan,
                    (3.0 if order is None else 1.25) * float(np.linalg.norm(beyond)))


def _table(found: Study) -> str:
    lines = [f"{'elements':>9} {'nodes':>8} {'size (mm)':>10} {'wall (s)':>9}  " + "  ".join(found)]
    for level in found.levels:
        row = [f"{level.elements:9d} {level.nodes:8d} {1e3 * level.size:10.3f} {level.seconds:9.2f}"]
        lines.append("  ".join(row + [_shown(level.values[name]) for name in found]))
    for name, one in found.items():
        order = "not seen, 1 taken" if one.order is None else f"{one.order:.2f}"
        lines += [f"\n{name}", f"  order of convergence          {order}",
                  f"  extrapolated                  {_shown(one.extrapolated)} +- {one.uncertainty:.2g}",
                  f"  error of the scene's mesh     {one.error:.3g} ({100.0 * one.relative_error:.2g} %)"]
        if one.order is None:
            why = "Two meshes show no order: use more" if len(found.levels) == 2 else "The differences shrink with no clear order: refine further"
            lines.append(f"  {why} before you trust the estimate.")
    return "\n".join([*lines, "\nValues in SI units, positions as displacements from the start."])


def _shown(value: np.ndarray) -> str:
    return " ".join(f"{x:.5g}" for x in np.atleast_1d(value))


def _options(words: list[str]) -> argparse.Namespace:
    parser = command.parser("convergence")
    for name in ("measure", "set"):
        parser.add_argument(f"--{name}", action="append", default=[])
    for name in ("duration", "json"):
        parser.add_argument(f"--{name}")
    parser.add_argument("--levels", type=int, default=3)
    parser.add_argument("--static", action="store_true")
    return parser.parse_args(words)


def _written(found: Study) -> str:
    def plain(value: Any) -> Any:
        return value.tolist() if isinstance(value, np.ndarray) else value

    levels = [{key: plain(value) for key, value in asdict(level).items()} for level in found.levels]
    for level in levels:
        level["values"] = {name: plain(value) for name, value in level["values"].items()}
    estimates = {name: {key: plain(value) for key, value in asdict(one).items()} for name, one in found.items()}
    return json.dumps({"levels": levels, "estimates": estimates}, indent=2)


def main(words: list[str]) -> int:
    """Runs `sinew convergence`; returns the exit code, see command.exit_code()."""
    options = _options(words)
    return command.exit_code(lambda: _converge(options))


def _converge(options: argparse.Namespace) -> int:
    found = study(options.scene, measure=options.measure or None, levels=options.levels, static=options.static,
                  duration=command.seconds("--duration", options.duration), set=options.set, progress=True)
    print(_table(found))
    if options.json:
        with draft(options.json) as beside:
            beside.write_text(_written(found))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
