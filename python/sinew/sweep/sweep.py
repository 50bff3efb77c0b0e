"""Runs a sweep and returns its table."""

from __future__ import annotations

import hashlib
import inspect
import json
import multiprocessing
import pathlib
import re
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from .. import _core
from .. import scene as scenes
from ..errors import Error
from .engine import Engine, connect
from .progress import Progress
from .samples import Axis, Design, design
from .store import Rows, Store, table_path
from .runner import Job, Sample, check_measures

if TYPE_CHECKING:
    import os

    import pandas

_COMMAND = re.compile(r"actuators\.[^.]+\.command\.[a-z_]+")


def run(
    scene: Union[str, os.PathLike[str], Mapping[str, Any], None] = None,
    *,
    vary: Mapping[str, Any],
    measure: Sequence[str] = (),
    out: Union[str, os.PathLike[str]],
    function: Optional[Callable[[Sample], Mapping[str, Any]]] = None,
    sample: Optional[str] = None,
    seed: int = 1,
    workers: Optional[int] = None,
    scheduler: Any = None,
    duration: Optional[float] = None,
    static: bool = False,
    set: scenes.Overrides = None,  # noqa: A002 - the command line's --set
    timeout: Optional[float] = None,
    resume: bool = False,
    progress: Union[bool, Callable[[int, int], object], None] = None,
) -> pandas.DataFrame:
    """Runs a scene, or a function, over a range of parameter values on a Dask cluster.

    Each sample loads the scene with its parameter values, simulates it, and measures the final state. A failed sample is also a
    row of the table. Rows are written as samples finish: an aborted sweep leaves a valid table.

    Parameters
    ----------
    scene : path-like or dict, optional
        As in sinew.load(). The workers must be able to read the files that it names.
    vary : dict
        Values for each key of the scene (keys as in `set`): text as on the command line, "300kPa:600kPa:7" (grid, both
        ends included), "300kPa:600kPa" (range) or "1mm,2mm,5mm" (list); a list or array of SI numbers or of text; or a
        tuple (low, high), a range. A grid has all combinations; the last key changes fastest.
    measure : list of str
        Observables as in Simulation.run(record=...), such as "tip.position" (m) or "strain_energy" (J), and body quantities
        such as "trunk.strain_energy", kinetic_energy, gravity_energy (J), mass (kg), volume (m^3). With a function, the
        names that it must return (default: any).
    out : path-like
        Output folder, for sweep.h5.
    function : callable, optional
        Called with a Sample instead of simulating the scene; returns a dict of numbers and arrays. The shape of an output
        must be the same in all samples. The keys of `vary` are then arbitrary.
    sample : str, optional
        Sampling of the ranges: "sobol:512" (scrambled), "halton:500" (scrambled), "random:500", or "saltelli:256" for Sobol
        indices, with 256 (keys + 2) samples. The values of a list are equally likely.
    seed : int
        Random seed of the sample.
    workers : int, optional
        Local worker processes with one thread each; by default one per core.
    scheduler : str or distributed.Client, optional
        Address of a Dask scheduler such as "tcp://127.0.0.1:8786", or a client, to use instead of `workers`.
    duration : float, optional
        Simulated time, s; by default the scene's.
    static : bool
        Solve for static equilibrium (Simulation.solve_static()) instead of simulating.
    set : list of str or dict, optional
        Overrides for all samples, as in sinew.load().
    timeout : float, optional
        Wall-time limit per sample, s. Samples then run in a separate process, which is killed with its children.
    resume : bool
        Continue an interrupted sweep of the same scene, variation and function, or start it if there is none.
    progress : bool or callable, optional
        By default a line on standard error if that is a terminal. A function is called with (rows, samples) after each
        batch.

    Returns
    -------
    pandas.DataFrame
        The table, as from sinew.sweep.load(out).

    Raises
    ------
    Error
        Before the first sample: bad-argument, unknown-name (with a suggestion) and the errors of sinew.load(); file-exists
        if `out` has a table and `resume` is not set, or the table of another sweep.
    RunError
        scheduler-lost, worker-failed. Finished rows are kept.
    KeyboardInterrupt
        After Ctrl-C. Finished rows are kept.

    Examples
    --------
    >>> table = sinew.sweep.run("trunk.yaml", vary={"bodies.trunk.material.young_modulus": "300kPa:600kPa:7"},
    ...                         measure=["tip.position"], out="out/modulus", workers=2)
    """
    if scheduler is None:
        _refuse_import_by_workers()
    samples = design(vary, sample, seed)
    job = _job(scene, samples, list(measure), function, duration, static, set, timeout, seed)
    what = _identity(job, samples)
    store, there = _open_store(out, job, samples, what, resume)
    with_rows = frozenset(there)
    order = [index for index in _order(job, samples) if index not in with_rows]
    shown = Progress(samples.size, len(with_rows), progress)
    try:
        if order:
            with connect(scheduler, workers) as client:
                Engine(client, _packed(job), samples, order, store, shown).run()
    finally:
        shown.end()
        store.close()
    from .table import load

    return load(out)


def _refuse_import_by_workers() -> None:
    """Raises an error in a script without `if __name__ == "__main__":`. Local workers import the main script, so a script that
    starts a sweep on import would start further ones without end.
    """
    script = getattr(sys.modules["__main__"], "__file__", None)
    unguarded = script is not None and pathlib.Path(script).suffix == ".py" and "__name__" not in _source(pathlib.Path(script))
    if unguarded or getattr(multiprocessing.current_process(), "_inheriting", False):
        raise Error("bad-argument", "sweep.run()", "the script starts a sweep when a worker imports it",
                    'call it under `if __name__ == "__main__":`')


def _source(path: pathlib.Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="ignore")
    except OSError:
        return "__name__"  # the file no longer exists, so no worker imports it


def _packed(job: Job) -> bytes:
    try:
        import cloudpickle
    except ImportError as missing:
        raise Error("tool-missing", "sinew.sweep", f"sweeps need cloudpickle: {missing}", "apt-get install python3-distributed") from None
    return cloudpickle.dumps(job)


def _job(scene: Any, samples: Design, measure: list[str], function: Any, duration: Optional[float], static: bool, given: scenes.Overrides,
         timeout: Optional[float], seed: int) -> Job:
    """The job, after all checks that are possible before the first sample."""
    if function is None and scene is None:
        raise Error("bad-argument", "sweep.run()", "there is neither a scene nor a function", "give one of them")
    if function is None and not measure:
        raise Error("bad-argument", "sweep(measure)", "no quantity to measure", "name observables such as 'tip.position' (--measure)")
    if len({*measure}) != len(measure):
        raise Error("duplicate-key", "sweep(measure)", f"a name comes twice in {measure}", "measure each once")
    if static and duration is not None:
        raise Error("bad-argument", "sweep(duration)", "an equilibrium has no duration", "leave out duration, or static")
    if function is not None and (static or duration is not None):
        raise Error("bad-argument", "sweep(function)", "a function runs its samples itself", "leave out duration and static")
    if function is not None and not callable(function):
        raise Error("wrong-type", "sweep(function)", f"{function!r} cannot be called", "give a function of a Sample")
    if timeout is not None and not timeout > 0.0:
        raise Error("out-of-range", "sweep(timeout)", f"the timeout is {timeout:g} s", "give more than zero")
    common = dict(axes=tuple(samples.axes), measures=tuple(measure), duration=duration, static=static, function=function, timeout=timeout,
                  seed=seed)
    if scene is None:
        return Job(scene="", **common)
    with warnings.catch_warnings():
        if function is None:
            warnings.simplefilter("ignore")  # issued when the first sample is loaded, below
        base = scenes.load(scene, set=given, threads=1)
    if function is not None:
        return Job(scene=base.to_yaml(), **common)
    first = [f"{axis.key}={axis.spell(value)}" for axis, value in zip(samples.axes, samples.values(0))]
    sim = scenes.load(scene, set=[*scenes._assignments(given), *first], threads=1)
    shapes = check_measures(sim, measure, static)
    if not static:
        _check_duration(sim, duration)
    commands = () if sim.controller is not None else tuple(k for k, axis in enumerate(samples.axes) if _is_command(sim, axis))
    return Job(scene=base.to_yaml(), commands=commands, shapes=shapes, **common)


def _check_duration(sim: _core.Simulation, duration: Optional[float]) -> None:
    """Raises the errors of run() for a duration, after at most a few steps."""

    class Enough(Exception):
        pass

    def stop(*_: int) -> None:
        raise Enough

    if duration is not None and not (np.isfinite(duration) and duration >= 0.0):
        raise Error("out-of-range", "sweep(duration)", f"the duration is {duration:g} s", "give zero or more")
    if duration is None and "\nduration:" not in "\n" + sim.to_yaml():
        try:
            sim.run(record=[], every=1, progress=stop)
        except Enough:
            pass


def _is_command(sim: _core.Simulation, axis: Axis) -> bool:
    """Whether the axis is a constant command of an actuator, which a loaded simulation can take."""
    return axis.is_number and bool(_COMMAND.fullmatch(axis.key)) and axis.key.split(".")[1] in sim.actuators


def _order(job: Job, samples: Design) -> Sequence[int]:
    """Order of the samples in which those that differ in commands only are adjacent, because they share a simulation."""
    fixed = [k for k in range(len(samples.axes)) if k not in job.commands]
    if not job.commands or not fixed or samples.method != "grid":
        return range(samples.size)
    shape = [len(axis.values) for axis in samples.axes]
    numbers = np.arange(samples.size).reshape(shape)
    return numbers.transpose(fixed + list(job.commands)).ravel().tolist()


def _identity(job: Job, samples: Design) -> dict[str, Any]:
    """Data that distinguish this sweep from all others."""
    how = "function" if job.function else "static" if job.static else "run"
    return {"scene": _scene_hash(job.scene), **samples.describe(), "measure": list(job.measures), "how": how, "duration": job.duration,
            "function": _spell_function(job.function)}


def _scene_hash(text: str) -> str:
    """Hash of the scene and the files that it names, wherever they are."""

    def content(found: re.Match) -> str:
        path = pathlib.Path(found[1].strip("\"'"))
        return "file: " + (hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else found[1])

    return hashlib.sha256(re.sub(r"file: ([^,}\n]+)", content, text).encode()).hexdigest()


def _spell_function(function: Any) -> str:
    if function is None:
        return ""
    name = getattr(function, "__qualname__", type(function).__name__)
    try:
        return f"{name} {hashlib.sha256(inspect.getsource(function).encode()).hexdigest()}"
    except (OSError, TypeError):
        return name


def _open_store(out: Any, job: Job, samples: Design, what: dict[str, Any], resume: bool) -> tuple[Store, Sequence[int]]:
    """The table, and the samples that it already contains."""
    path = table_path(out)
    before: Optional[Rows] = None
    if path.exists():
        if not resume:
            raise Error("file-exists", (str(path), 0, 0, ""), "the folder has a sweep already",
                        "go on with resume=True (--resume), or name another folder")
        before = Rows(path)
        there = json.loads(before.about["identity"])
        for name in what:
            if there.get(name) != json.loads(json.dumps(what[name])):
                raise Error("file-exists", (str(path), 0, 0, ""), f"it is of another sweep: {name} is {_short(there.get(name))} there and "
                            f"{_short(what[name])} here", "repeat what the folder has, or name another folder")
    about = {"sinew_version": _core.__version__, "instruction_set": _core.instruction_set, "samples": samples.size, "seed": samples.seed,
             "sample": f"{samples.method}:{samples.count}", "identity": json.dumps(what),
             "hash": hashlib.sha256(json.dumps(what).encode()).hexdigest(), "units": {axis.key: axis.unit for axis in samples.axes}}
    outputs = before.outputs if before is not None else dict(job.shapes)
    inputs = {axis.key: 0 if axis.is_number else max(len(str(value).encode()) for value in axis.values) for axis in samples.axes}
    store = Store(out, about, job.scene, inputs, outputs, before)
    return store, [] if before is None else before.samples.tolist()


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) < 200 else text[:200] + " ..."
