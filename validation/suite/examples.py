"""Runs the scenes and scripts of examples/ as their users do, and compares the figures that comments and pages claim."""

from __future__ import annotations

import csv
import functools
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from typing import Callable

import numpy as np

from .case import REPOSITORY, shared_data

FOLDER = REPOSITORY / "examples"
# Words of steps that are no solutions, of warnings and of errors, in a program's summary or a script's output.
COMPLAINT = re.compile(r"Traceback|Warning\b|sinew: (?:error|warning|notice)|^steps flagged", re.MULTILINE)


@dataclass(frozen=True)
class Ran:
    """What an example left: its output, and the table out/run.csv of a scene."""

    output: str
    folder: pathlib.Path
    seconds: float
    problem: str = ""

    @functools.cached_property
    def table(self) -> dict[str, np.ndarray]:
        """Columns of numbers, by name without unit, in SI units."""
        with open(self.folder / "out" / "run.csv", newline="") as file:
            names, *lines = csv.reader(file)
        columns = {}
        for name, values in zip(names, zip(*lines)):
            try:
                columns[name.split(" [")[0]] = np.array(values, float)
            except ValueError:
                columns[name.split(" [")[0]] = np.array(values)
        return columns


Reader = Callable[[Ran], float]


@dataclass(frozen=True)
class Figure:
    """A claimed figure.

    Parameters
    ----------
    quantity, where : str
        What it is, and the comment or page that claims it.
    read : callable
        Finds it in what the example left.
    claim, tolerance : float
        In `unit`; |figure - claim| may be at most the tolerance.
    """

    quantity: str
    read: Reader
    claim: float
    tolerance: float
    unit: str = ""
    where: str = "its comment"


@dataclass(frozen=True)
class Example:
    """A scene or script, with the arguments that its page gives, and its time limit (s, on an idle core)."""

    path: str
    figures: tuple[Figure, ...] = ()
    arguments: tuple[str, ...] = ()
    limit: float = 120.0
    notices: tuple[str, ...] = ()  # kinds of warnings that its page explains
    needs: str = ""  # a Python module, or a folder of published data that the argument "{data}" names

    def command(self, build: pathlib.Path) -> list[str] | None:
        """None if this machine lacks what it needs."""
        file = str(FOLDER / self.path)
        if self.path.endswith(".yaml"):
            return [str(build / "bin" / "sinew"), "run", file, "--out", "out", *self.arguments]
        data = shared_data(self.needs) if "{data}" in self.arguments else None
        if self.needs and data is None and not has_module(self.needs):
            return None
        return [sys.executable, file, *(one.format(data=data) for one in self.arguments)]


def has_module(name: str) -> bool:
    return not subprocess.run([sys.executable, "-c", f"import {name}"], capture_output=True).returncode


def printed(pattern: str, group: int = 1) -> Reader:
    """The number in the first match of a regular expression in the output."""
    def read(ran: Ran) -> float:
        found = re.search(pattern, ran.output, re.MULTILINE)
        return float(found.group(group).replace("+-", "")) if found else math.nan
    return read


def last(column: str, scale: float = 1.0) -> Reader:
    """The last value of a column of run.csv."""
    return lambda ran: scale * float(ran.table[column][-1])


def largest(column: str, scale: float = 1.0) -> Reader:
    """The largest value of a column of run.csv."""
    return lambda ran: scale * float(np.nanmax(ran.table[column]))


def at(column: str, moment: float, scale: float = 1.0) -> Reader:
    """The value of a column of run.csv at a time (s)."""
    def read(ran: Ran) -> float:
        return scale * float(ran.table[column][np.argmin(np.abs(ran.table["time"] - moment))])
    return read


def first_above(column: str, threshold: float) -> Reader:
    """The first time (s) at which a column of run.csv exceeds a value."""
    def read(ran: Ran) -> float:
        above = np.flatnonzero(ran.table[column] > threshold)
        return float(ran.table["time"][above[0]]) if len(above) else math.nan
    return read


def run(example: Example, build: pathlib.Path, folder: pathlib.Path, patience: float = 1.0) -> Ran | None:
    """Runs an example in an empty folder. @return None if this machine lacks what it needs.

    Parameters
    ----------
    build : Path
        A build tree, with bin/sinew and python/sinew.
    folder : Path
        Becomes the current folder.
    patience : float
        A factor on the time limit, for machines that are busy or slow.
    """
    command = example.command(build)
    if command is None:
        return None
    surroundings = dict(os.environ, PYTHONPATH=str(build / "python"), MPLBACKEND="Agg", PYTHONDONTWRITEBYTECODE="1",
                        PATH=f"{build / 'bin'}:{os.environ.get('PATH', '')}")
    start = time.monotonic()
    process = subprocess.Popen(command, cwd=folder, env=surroundings, text=True, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        output, _ = process.communicate(timeout=patience * example.limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # its workers, too
        output, _ = process.communicate()
        problem = f"not finished after {patience * example.limit:.0f} s"
    else:
        problem = complaint(process.returncode, output, example.notices)
    return Ran(output, folder, time.monotonic() - start, problem)


def complaint(code: int, output: str, notices: tuple[str, ...] = ()) -> str:
    """What is wrong with a run, or nothing: an exit code, a warning of another kind than `notices`, a flagged step."""
    lines = output.strip().splitlines()
    if code:
        return f"exit code {code}: {lines[-1] if lines else 'no output'}"
    known = tuple(f"[{kind}]" for kind in notices)
    return next((line for line in lines if COMPLAINT.search(line) and not line.endswith(known or ("\0",))), "")


def source_state() -> dict[str, tuple[int, int]]:
    """Size and time of change of every file under examples/, apart from Python's caches."""
    return {str(path.relative_to(FOLDER)): (path.stat().st_size, path.stat().st_mtime_ns)
            for path in sorted(FOLDER.rglob("*")) if path.is_file() and "__pycache__" not in path.parts}


def changed_sources(before: dict[str, tuple[int, int]]) -> list[str]:
    """Files under examples/ that were written, added or removed since `before`."""
    after = source_state()
    return sorted(path for path in before.keys() | after.keys() if before.get(path) != after.get(path))
