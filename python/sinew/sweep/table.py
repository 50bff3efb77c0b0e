"""Reads the tables of sweeps."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Union

import numpy as np

from ..errors import Error
from .sensitivity import SobolIndices, sobol_indices
from .store import Rows

if TYPE_CHECKING:
    import pandas

_MAX_COLUMNS = 64  # per output
_AXES = {(3,): "xyz", (4,): "wxyz"}
_Path = Union[str, "os.PathLike[str]"]


def load(folder: _Path) -> pandas.DataFrame:
    """Loads the table of a sweep, which may still be running or have been interrupted.

    Parameters
    ----------
    folder : path-like
        Output folder of run() or `sinew sweep`.

    Returns
    -------
    pandas.DataFrame
        Indexed and sorted by sample number. Columns: every varied key (SI, or text) and every measured component, such as
        "tip.position.x" or "strain_energy" (SI; NaN for a failed sample); components of larger arrays are numbered,
        "trunk.coordinates.0", and arrays of more than 64 numbers are available from arrays() only. Then `status` ("done",
        "flagged" for unreliable steps, "failed"), `error`, `seconds` (wall time, s), and `version`, `instruction_set` and
        `worker` of the process. `attrs` has "scene" (YAML), "seed", "samples", "units", "hash" ...

    Raises
    ------
    Error
        file-not-found, malformed-file; tool-missing without pandas or h5py.
    """
    try:
        import pandas
    except ImportError as missing:
        raise Error("tool-missing", "sinew.sweep.load()", f"tables need pandas: {missing}", "apt-get install python3-pandas") from None
    rows = Rows(folder)
    columns = {name: rows.values(name) for name in rows.inputs}
    for name, shape in rows.outputs.items():
        size = int(np.prod(shape, dtype=int))
        if size <= _MAX_COLUMNS:
            columns.update(zip(component_names(name, shape), rows.values(name).reshape(len(rows), size).T))
    for name in ("status", "error", "seconds", "version", "instruction_set", "worker"):
        columns[name] = rows.values(name)
    table = pandas.DataFrame(columns, index=pandas.Index(rows.samples, name="sample")).sort_index()
    table.attrs = {name: rows.about[name].item() if hasattr(rows.about[name], "item") else rows.about[name]
                   for name in ("sinew_version", "instruction_set", "samples", "seed", "sample", "hash")}
    table.attrs.update(scene=rows.scene, units=json.loads(rows.about["units"]), inputs=rows.inputs, outputs=rows.outputs)
    return table


def arrays(folder: _Path, name: str) -> np.ndarray:
    """A complete output in the order of load(), for example "trunk.positions" as (rows, n, 3) m.

    Parameters
    ----------
    folder : path-like
    name : str
        Name of a measure or of an output of the function.

    Returns
    -------
    (rows, ...) ndarray
        SI; NaN for failed samples.

    Raises
    ------
    Error
        unknown-name; as load().
    """
    rows = Rows(folder)
    if name not in rows.outputs:
        raise Error("unknown-name", "sweep.arrays(name)", f"the sweep has no output '{name}'", f"it has {', '.join(rows.outputs)}")
    return rows.values(name)[np.argsort(rows.samples, kind="stable")]


def indices(folder: _Path, column: str, *, confidence: float = 0.95, resamples: int = 200) -> pandas.DataFrame:
    """Sobol indices of a sweep with `sample="saltelli:N"`: see sobol_indices().

    Parameters
    ----------
    folder : path-like
    column : str
        Column of load(), such as "tip.position.x".
    confidence, resamples
        As in sobol_indices().

    Returns
    -------
    pandas.DataFrame
        A row for each varied key; columns `first`, `first_low`, `first_high`, `total`, `total_low`, `total_high`.

    Raises
    ------
    Error
        bad-argument for another sampling method; unknown-name; too-few-points. Base points with a failed or missing sample
        are ignored.
    """
    import pandas

    table = load(folder)
    method, _, count = table.attrs["sample"].partition(":")
    keys = table.attrs["inputs"]
    if method != "saltelli":
        raise Error("bad-argument", "sweep.indices(folder)", f"the sweep was sampled by {table.attrs['sample']}",
                    "sample it by saltelli:256")
    if column not in table or table[column].dtype.kind != "f":
        raise Error("unknown-name", "sweep.indices(column)", f"the table has no numeric column '{column}'",
                    f"it has {', '.join(name for name in table if table[name].dtype.kind == 'f')}")
    values = table[column].reindex(range(int(count) * (len(keys) + 2))).to_numpy().reshape(int(count), len(keys) + 2)
    found: SobolIndices = sobol_indices(values, confidence=confidence, resamples=resamples)
    return pandas.DataFrame({"first": found.first, "first_low": found.first_interval[:, 0], "first_high": found.first_interval[:, 1],
                             "total": found.total, "total_low": found.total_interval[:, 0], "total_high": found.total_interval[:, 1]},
                            index=pandas.Index(keys, name="key"))


def component_names(name: str, shape: tuple[int, ...]) -> list[str]:
    """Columns of an output: ["tip.position.x", ...]."""
    if shape == ():
        return [name]
    if shape in _AXES:
        return [f"{name}.{axis}" for axis in _AXES[shape]]
    return [f"{name}.{'.'.join(map(str, place))}" for place in np.ndindex(shape)]
