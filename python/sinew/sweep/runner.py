"""Runs samples of a job, one by one."""

from __future__ import annotations

import math
import os
import time
import traceback
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Optional

import numpy as np

from .. import _core, scene
from ..errors import Error, StepWarning
from .samples import Axis, Value

#: Work and losses since the start; undefined for a static equilibrium, which makes no steps.
LEDGER = ("actuator_work", "outside_work", "dissipation", "numerical_loss")
#: Quantities of a body that can be measured in addition to the observables: "trunk.strain_energy".
OF_BODY = ("strain_energy", "kinetic_energy", "gravity_energy", "mass", "volume")
_ALL_STEPS = 1_000_000_000


class Row(NamedTuple):
    """Result of a sample."""

    index: int
    status: str  # "done", "flagged", "failed"
    error: str
    seconds: float
    outputs: dict[str, Any]


@dataclass(frozen=True)
class Job:
    """Data of a sweep that a worker needs.

    Attributes
    ----------
    scene : str
        YAML with absolute paths; empty if a function needs none.
    axes : tuple of Axis
    commands : tuple of int
        Indices of axes that are commands of actuators, which a loaded simulation can take.
    measures : tuple of str
    shapes : dict
        Shape of each measure.
    duration : float, optional
        s.
    static : bool
        An equilibrium instead of a run.
    function : callable, optional
        Function of a Sample that replaces both.
    timeout : float, optional
        Limit on each sample, s.
    seed : int
    """

    scene: str
    axes: tuple[Axis, ...]
    commands: tuple[int, ...] = ()
    measures: tuple[str, ...] = ()
    shapes: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    duration: Optional[float] = None
    static: bool = False
    function: Optional[Callable[["Sample"], Mapping[str, Any]]] = None
    timeout: Optional[float] = None
    seed: int = 1


class Sample(Mapping[str, Value]):
    """One sample, as passed to the function of a sweep: a mapping from varied keys to values in SI, or text.

    Attributes
    ----------
    index : int
        Number of the sample, from 0.
    seed : int
        Seed for random numbers of this sample: it depends only on the sweep's seed and the index.
    """

    def __init__(self, index: int, seed: int, values: Mapping[str, Value], load: Callable[..., _core.Simulation]) -> None:
        self.index, self.seed = index, seed
        self._values, self._load = dict(values), load

    def __getitem__(self, key: str) -> Value:
        return self._values[key]

    def __iter__(self):
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def load(self, *, set: scene.Overrides = None) -> _core.Simulation:  # noqa: A002
        """Loads the sweep's scene with this sample's values, at its start, on one thread.

        Parameters
        ----------
        set : list of str or dict, optional
            As in sinew.load(), instead of the varied keys; required if these are not keys of the scene.

        Raises
        ------
        Error
            bad-argument if the sweep has no scene; the errors of sinew.load().
        """
        return self._load(set)


def check_measures(sim: _core.Simulation, measures: Sequence[str], static: bool) -> dict[str, tuple[int, ...]]:
    """Shapes of measures of a simulation.

    Raises
    ------
    Error
        unknown-name with a suggestion; bad-argument for text, and for accumulated work if no step is made.
    """
    shapes = {}
    for name in measures:
        if static and name in LEDGER:
            raise Error("bad-argument", "sweep(measure)", f"'{name}' accumulates over steps, and an equilibrium has none",
                        "run for a while, or measure 'strain_energy'")
        try:
            value = measure(sim, [name])[name]
        except Error as error:
            raise Error(error.kind, "sweep(measure)", error.message, error.remedy) from None
        if value.dtype.kind != "f":
            raise Error("bad-argument", "sweep(measure)", f"'{name}' is text, not a number",
                        "measure numbers; the status of every sample is in the table anyway")
        shapes[name] = value.shape
    return shapes


def measure(sim: _core.Simulation, names: Sequence[str]) -> dict[str, np.ndarray]:
    """Present values of measures by name. Raises Error (unknown-name) with a suggestion."""
    found, observed = {}, []
    for name in names:
        body, _, quantity = name.rpartition(".")
        if name in LEDGER:
            found[name] = np.asarray(sim.ledger[name])
        elif quantity in OF_BODY and body in sim.bodies:
            found[name] = np.asarray(getattr(sim.body(body), quantity), float)
        else:
            observed.append(name)
    if observed:
        recorded = sim.run(0.0, record=observed)
        found.update((name, recorded[name][-1]) for name in observed)
    return found


class Runner:
    """Runs samples of a job in this process. Keeps a simulation while only commands change."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self._sim: Optional[_core.Simulation] = None
        self._of: tuple[Value, ...] = ()  # values of the kept simulation other than commands
        self._reusable: Optional[bool] = None if job.commands else False

    def row(self, index: int, values: Sequence[Value]) -> Row:
        """Result of a sample; any failure is reported in the row."""
        begin = time.perf_counter()
        try:
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                outputs = self._called(index, values) if self.job.function else self._simulated(values)
            remarks = [str(one.message) for one in told if issubclass(one.category, StepWarning)]
            remarks = [] if self.job.function else remarks
            status, error = ("flagged", "; ".join(remarks)) if remarks else ("done", "")
        except (Exception, SystemExit) as problem:  # a function may call sys.exit()
            self._sim = None
            status, error, outputs = "failed", describe(problem), {}
        return Row(index, status, error, time.perf_counter() - begin, outputs)

    def _simulated(self, values: Sequence[Value]) -> dict[str, Any]:
        sim = self._simulation(values, keep=True)
        if self.job.static:
            sim.solve_static()
        else:
            sim.run(self.job.duration, record=[], every=_ALL_STEPS)
        found = measure(sim, self.job.measures)
        for name, value in found.items():
            if value.shape != self.job.shapes[name]:
                raise Error("wrong-shape", name, f"it has the shape {value.shape}, and {self.job.shapes[name]} in the first sample",
                            "measure what has one shape in all samples")
        return found

    def _called(self, index: int, values: Sequence[Value]) -> dict[str, Any]:
        job = self.job
        named = {axis.key: value for axis, value in zip(job.axes, values)}
        seed = int(np.random.SeedSequence([job.seed, index]).generate_state(1, np.uint64)[0])
        found = job.function(Sample(index, seed, named, lambda given: self._for_function(values, given)))
        if not isinstance(found, Mapping):
            raise Error("wrong-type", "sweep(function)", f"the function returned {type(found).__name__}",
                        "return a dict of numbers and arrays")
        outputs = {str(name): np.asarray(value, float) for name, value in found.items()}
        if job.measures and set(outputs) != set(job.measures):
            raise Error("unknown-name", "sweep(function)", f"the function returned {sorted(outputs)}, not {sorted(job.measures)}",
                        "return the names of `measure`")
        return outputs

    def _for_function(self, values: Sequence[Value], given: scene.Overrides) -> _core.Simulation:
        if not self.job.scene:
            raise Error("bad-argument", "Sample.load()", "this sweep has no scene", "give one: sinew.sweep.run(scene, ...)")
        return self._simulation(values, keep=False) if given is None else self._load(given)

    def _simulation(self, values: Sequence[Value], keep: bool) -> _core.Simulation:
        """Simulation at its start. With `keep` it is not passed to other code, so that reset() restores it."""
        job = self.job
        fixed = tuple(value for k, value in enumerate(values) if k not in job.commands)
        if self._sim is None or self._of != fixed or self._reusable is False:
            self._sim, self._of = self._load(self._overrides(values)), fixed
            return self._sim if keep or self._reusable is False else self._sim.clone()
        if keep:
            self._sim.reset()
            sim = self._sim
        else:
            sim = self._sim.clone()
        if self._reusable and self._command(sim, values):
            return sim
        return self._compared(sim, values, keep)

    def _overrides(self, values: Sequence[Value]) -> list[str]:
        return [f"{axis.key}={axis.spell(value)}" for axis, value in zip(self.job.axes, values)]

    def _load(self, overrides: scene.Overrides) -> _core.Simulation:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # issued once, by the process that started the sweep
            return scene.loads(self.job.scene, set=overrides, threads=1)

    def _command(self, sim: _core.Simulation, values: Sequence[Value]) -> bool:
        for k in self.job.commands:
            _, name, _, quantity = self.job.axes[k].key.split(".")
            setattr(sim.actuator(name), quantity, float(values[k]))
        return True

    def _compared(self, sim: _core.Simulation, values: Sequence[Value], keep: bool) -> _core.Simulation:
        """At the first use, a kept simulation must equal a newly loaded one; otherwise none is kept."""
        fresh = self._load(self._overrides(values))
        try:
            self._command(sim, values)
            same = sim.state() == fresh.state() and all(
                sim.actuator(name).command == fresh.actuator(name).command
                for name in {self.job.axes[k].key.split(".")[1] for k in self.job.commands})
        except Error:
            same = False
        self._reusable = same
        if same:
            return sim
        self._sim = fresh
        return fresh


def describe(problem: BaseException) -> str:
    """An exception in one line: its text and, if it is not from sinew, the file and line."""
    if isinstance(problem, Error):
        return str(problem)
    where = traceback.extract_tb(problem.__traceback__)
    at = f" ({os.path.basename(where[-1].filename)}, line {where[-1].lineno})" if where else ""
    return f"{type(problem).__name__}: {problem}{at}"
