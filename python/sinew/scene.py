"""Load simulations from scenes."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any, Optional, Union

from . import _core
from ._core import Simulation
from .errors import Error, SinewWarning

__all__ = ["load", "loads"]

Overrides = Union[str, Iterable[str], Mapping[str, Any], None]


def load(
    scene: Union[str, os.PathLike[str], Mapping[str, Any]],
    *,
    set: Overrides = None,  # noqa: A002 - the command line's --set
    threads: Optional[int] = None,
    folder: Union[str, os.PathLike[str]] = "",
) -> Simulation:
    """Loads a scene and returns its simulation, with the first controller of the scene attached.

    Parameters
    ----------
    scene : path-like or dict
        Path of a YAML file, or the same structure as a dict.
    set : list of str or dict, optional
        Overrides of scene values: ["time_step=5ms"] or {"time_step": "5 ms"}.
    threads : int, optional
        Threads per step; by default the scene's, else 1. Results do not depend on it.
    folder : path-like
        Base of relative paths in a dict; by default the working folder. Paths in a file are
        relative to the file's folder.

    Returns
    -------
    Simulation

    Raises
    ------
    Error
        If the scene is invalid: with file, line, column and remedy.

    Warns
    -----
    SinewWarning
        For every warning in `Simulation.notices`, for example elements that lock.

    Examples
    --------
    >>> sim = sinew.load("trunk.yaml", set=["time_step=5ms"])
    """
    overrides = _assignments(set)
    if isinstance(scene, Mapping):
        return _warned(
            _core.load_tree(scene, overrides, os.fspath(folder), "scene", _count(threads))
        )
    if not isinstance(scene, (str, os.PathLike)):
        raise Error(
            "wrong-type",
            "load(scene)",
            f"a value of type {type(scene).__name__} is not a scene",
            "give the path of a YAML file, or a dict",
        )
    return _warned(_core.load_file(os.fspath(scene), overrides, _count(threads)))


def loads(
    text: str,
    *,
    set: Overrides = None,  # noqa: A002
    threads: Optional[int] = None,
    folder: Union[str, os.PathLike[str]] = "",
) -> Simulation:
    """Loads a scene from YAML text, for example from Simulation.to_yaml().

    Parameters
    ----------
    text : str
        YAML.
    set, threads, folder
        As for load().

    Returns
    -------
    Simulation
    """
    return _warned(
        _core.load_text(text, _assignments(set), os.fspath(folder), "scene", _count(threads))
    )


def _warned(sim: Simulation) -> Simulation:
    """Issues a scene's notices as warnings at the caller of load() or loads()."""
    for notice in sim.notices:
        if notice.level == "warning":
            warnings.warn(str(notice), SinewWarning, stacklevel=3)
    return sim


def _count(threads: Optional[int]) -> Optional[int]:
    if threads is None or (isinstance(threads, int) and not isinstance(threads, bool)):
        return threads
    raise Error("wrong-type", "load(threads)", f"{threads!r} is not a number of threads", "give an int, 1 or more")


def _assignments(overrides: Overrides) -> list[str]:
    """Overrides as a list of "path=value"."""
    if overrides is None:
        return []
    if isinstance(overrides, str):
        return [overrides]
    if isinstance(overrides, Mapping):
        return [f"{path}={_spell(value)}" for path, value in overrides.items()]
    assignments = list(overrides)
    for assignment in assignments:
        if not isinstance(assignment, str):
            raise Error(
                "wrong-type",
                "load(set)",
                f"{assignment!r} is not text",
                'give a list of "path=value", or a dict',
            )
    return assignments


def _spell(value: Any) -> str:
    """A value as YAML (JSON is a subset of YAML)."""
    if isinstance(value, str):
        return value
    if hasattr(value, "tolist"):
        value = value.tolist()
    try:
        return json.dumps(value)
    except TypeError:
        raise Error(
            "wrong-type", "load(set)", f"a scene cannot hold {value!r}", "use numbers and text"
        ) from None
