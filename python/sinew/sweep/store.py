"""The table of a sweep: DIR/sweep.h5, written by one process.

    /sample (rows,)            number of the sample; -1: the row is not complete
    /inputs/KEY (rows,)        SI numbers, or text
    /outputs/NAME (rows, ...)  SI; NaN if the sample failed
    /status, /error, /seconds, /version, /instruction_set, /worker (rows,)
    /scene                     text

Rows are in the order in which samples finished. The file is written in HDF5's single-writer mode (SWMR), and /sample after
all other columns of a row, so a killed process leaves a readable table.
"""

from __future__ import annotations

import fcntl
import json
import os
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np

from ..errors import Error
from .runner import Row

FORMAT, FORMAT_VERSION, NAME = "sinew-sweep", 1, "sweep.h5"
_TEXTS = {"status": 8, "error": 1000, "version": 16, "instruction_set": 16, "worker": 80}
_CHUNK_BYTES = 1 << 16
_Path = Union[str, "os.PathLike[str]"]


def _h5py():
    try:
        import h5py
    except ImportError as missing:
        raise Error("tool-missing", "sinew.sweep", f"tables need h5py: {missing}", "apt-get install python3-h5py") from None
    return h5py


def table_path(folder: _Path) -> pathlib.Path:
    """The table in the folder of a sweep."""
    return pathlib.Path(folder) / NAME


class Store:
    """Writes rows.

    Parameters
    ----------
    folder : path-like
        Created if it does not exist.
    about : dict
        Description of the sweep: text, numbers and JSON data; stored as attributes.
    scene : str
        Stored as text.
    inputs : dict
        Length of the text of every varied key; 0: numbers.
    outputs : dict
        Shape of every output known so far; functions may return others.
    rows : Rows, optional
        Rows to continue from. They are copied to the new file, which replaces the old one.
    """

    def __init__(self, folder: _Path, about: Mapping[str, Any], scene: str, inputs: Mapping[str, int],
                 outputs: Mapping[str, tuple[int, ...]], rows: Optional[Rows] = None) -> None:
        self.path = table_path(folder)
        self._about, self._scene, self._inputs, self.outputs = dict(about), scene, dict(inputs), dict(outputs)
        self._file: Any = None
        self._columns: list[str] = []
        self.count = 0
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
        self._lock = _locked(self.path)
        self._open(rows)

    def _open(self, rows: Optional[Rows]) -> None:
        """Creates a new file beside the old one, with the existing rows, and replaces the old one by it."""
        beside = self.path.with_suffix(".h5.new")
        file = _h5py().File(beside, "w", libver="latest")
        about = {name: value if isinstance(value, (str, int, float)) else json.dumps(value) for name, value in self._about.items()}
        file.attrs.update({"format": FORMAT, "format_version": FORMAT_VERSION, **about})
        file.attrs["inputs"] = json.dumps(list(self._inputs))
        file.attrs["outputs"] = json.dumps({name: list(shape) for name, shape in self.outputs.items()})
        file.create_dataset("scene", data=np.frombuffer(self._scene.encode() or b"\n", dtype=np.uint8))
        columns = {"sample": ((), "i8", -1), "seconds": ((), "f8", np.nan)}
        columns.update({name: ((), f"S{length}", b"") for name, length in _TEXTS.items()})
        columns.update({f"inputs/{_slot(name)}": ((), f"S{length}" if length else "f8", b"" if length else np.nan)
                        for name, length in self._inputs.items()})
        columns.update({f"outputs/{_slot(name)}": (tuple(shape), "f8", np.nan) for name, shape in self.outputs.items()})
        for name, (shape, kind, fill) in columns.items():
            size = max(1, int(np.prod(shape, dtype=int)) * np.dtype(kind).itemsize)
            packed = {"compression": "gzip", "compression_opts": 1} if size > 8 and kind != "f8" else {}
            file.create_dataset(name, shape=(0, *shape), maxshape=(None, *shape), dtype=kind, fillvalue=fill,
                                chunks=(max(1, _CHUNK_BYTES // size), *shape), **packed)
        file.swmr_mode = True
        self._file, self._columns, self.count = file, list(columns), 0
        if rows is not None:
            self._extend({name: rows.column(name) for name in columns if name in rows.columns or name == "sample"}, len(rows))
        os.replace(beside, self.path)

    def append(self, rows: Sequence[Row], inputs: Sequence[Sequence[Any]], by: Mapping[str, str]) -> None:
        """Adds rows and flushes them.

        Parameters
        ----------
        rows : list of Row
            Outputs with new names become columns; rows with a different shape than the table's become failed ones.
        inputs : list
            Values of the varied keys for each row.
        by : dict
            "version", "instruction_set" and "worker".
        """
        if not rows:
            return
        known = dict(self.outputs)
        for row in rows:
            for name, value in row.outputs.items():
                known.setdefault(name, np.shape(value))
        if len(known) > len(self.outputs):
            self.outputs = known
            before = Rows(self.path)
            self._close_file()
            self._open(before)
        outputs = self.outputs
        rows = [_checked(row, outputs) for row in rows]
        table: dict[str, np.ndarray] = {
            "sample": np.array([row.index for row in rows], dtype="i8"), "seconds": np.array([row.seconds for row in rows])}
        for name in ("status", "error"):
            table[name] = _texts([getattr(row, name) for row in rows], _TEXTS[name])
        for name, value in by.items():
            table[name] = _texts([value] * len(rows), _TEXTS[name])
        for k, (name, length) in enumerate(self._inputs.items()):
            column = [values[k] for values in inputs]
            table[f"inputs/{_slot(name)}"] = _texts(column, length) if length else np.array(column, dtype=float)
        for name, shape in outputs.items():
            missing = np.full(shape, np.nan)
            table[f"outputs/{_slot(name)}"] = np.array([row.outputs.get(name, missing) for row in rows], dtype=float).reshape(-1, *shape)
        self._extend(table, len(rows))

    def _extend(self, table: Mapping[str, np.ndarray], count: int) -> None:
        end = self.count + count
        for name in self._columns:
            if name != "sample":
                self._file[name].resize(end, axis=0)
                if name in table:
                    self._file[name][self.count:end] = table[name]
        self._file.flush()
        # Writing /sample last completes the rows.
        self._file["sample"].resize(end, axis=0)
        self._file["sample"][self.count:end] = table["sample"]
        self._file.flush()
        self.count = end

    def close(self) -> None:
        """Closes the file; another process may continue it."""
        self._close_file()
        self._lock.close()

    def _close_file(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None


class Rows:
    """Complete rows of a table, which may still be written or whose writer may have been killed.

    Parameters
    ----------
    path : path-like
        The folder, or the file.

    Raises
    ------
    Error
        file-not-found; malformed-file if the file is not a sweep.
    """

    def __init__(self, path: _Path) -> None:
        path = pathlib.Path(path)
        path = table_path(path) if path.is_dir() else path
        if not path.exists():
            raise Error("file-not-found", (str(path), 0, 0, ""), "there is no table of a sweep", "give the output folder of `sinew sweep`")
        try:
            file = _h5py().File(path, "r", libver="latest", swmr=True)
        except OSError as problem:
            raise Error("malformed-file", (str(path), 0, 0, ""), f"it cannot be read: {problem}",
                        "name a folder of `sinew sweep`") from None
        with file:
            if file.attrs.get("format") != FORMAT or file.attrs["format_version"] != FORMAT_VERSION:
                raise Error("malformed-file", (str(path), 0, 0, ""), "this HDF5 file does not hold a sweep of this version",
                            "name a folder of `sinew sweep`")
            self.about: dict[str, Any] = dict(file.attrs)
            self.scene = bytes(file["scene"][:]).decode()
            self.inputs: list[str] = json.loads(self.about["inputs"])
            self.outputs = {name: tuple(shape) for name, shape in json.loads(self.about["outputs"]).items()}
            self.columns = [*_TEXTS, "seconds", *(f"inputs/{_slot(name)}" for name in self.inputs),
                            *(f"outputs/{_slot(name)}" for name in self.outputs)]
            sample = file["sample"][:]
            self._kept = np.flatnonzero(sample >= 0)
            self._table = {name: file[name][: len(sample)][self._kept] for name in self.columns}
            self.samples: np.ndarray = sample[self._kept]

    def __len__(self) -> int:
        return len(self.samples)

    def column(self, name: str) -> np.ndarray:
        """A column as stored in the file."""
        return self.samples if name == "sample" else self._table[name]

    def values(self, name: str) -> np.ndarray:
        """(rows,) or (rows, ...) of a varied key, an output, or another column; text as str."""
        for kind, names in (("inputs", self.inputs), ("outputs", self.outputs)):
            if name in names:
                return _decoded(self.column(f"{kind}/{_slot(name)}"))
        return _decoded(self.column(name))


def _locked(path: pathlib.Path) -> Any:
    """Locks the table for other sweeps as long as the returned file is open."""
    lock = open(path.with_suffix(".lock"), "w", encoding="utf-8")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        lock.close()
        raise Error("file-exists", (str(path), 0, 0, ""), "another sweep is writing it", "wait for it, or name another folder") from None
    return lock


def _slot(name: str) -> str:
    """A name that HDF5 accepts: "/" would create a group, and "." is the group itself."""
    return name.replace("%", "%25").replace("/", "%2F") if name != "." else "%2E"


def _texts(values: Sequence[Any], length: int) -> np.ndarray:
    encoded = [str(value).encode()[:length].decode(errors="ignore").encode() for value in values]
    return np.array(encoded, dtype=f"S{length}")


def _decoded(column: np.ndarray) -> np.ndarray:
    return np.char.decode(column, "utf-8") if column.dtype.kind == "S" else column


def _checked(row: Row, outputs: Mapping[str, tuple[int, ...]]) -> Row:
    """The row, as failed if an output has a different shape than in the table."""
    for name, value in row.outputs.items():
        if np.shape(value) != tuple(outputs[name]):
            error = (f"'{name}' has the shape {np.shape(value)}, and {tuple(outputs[name])} in a sample before; return one shape from all "
                     "samples [wrong-shape]")
            return row._replace(status="failed", error=error, outputs={})
    return row
