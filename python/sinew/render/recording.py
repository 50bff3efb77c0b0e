"""Recorded runs as a source of pictures."""

from __future__ import annotations

import os
import pathlib
from typing import Any, Optional, Union

import numpy as np

from .. import _core
from ..errors import Error
from .moment import Moment, between, moment_of, values_at
from .scene import outline_of

__all__ = ["Recording", "need_h5py"]

_FORMAT = "sinew-run"


def need_h5py() -> Any:
    """The module h5py; raises tool-missing."""
    try:
        import h5py
    except ImportError:
        raise Error("tool-missing", "render", "recorded runs need h5py, which is not installed",
                    "install python3-h5py, or pip install sinew[render]") from None
    return h5py


class Recording:
    """A run recorded by `sinew run`, opened for drawing.

    Parameters
    ----------
    path : path-like
        The folder, or its run.h5.

    Attributes
    ----------
    sim : Simulation
        The robot of the recorded scene, at its start.
    times : (frames,) ndarray
        s.

    Raises
    ------
    Error
        file-not-found, unknown-format, malformed-file; tool-missing without h5py.
    """

    def __init__(self, path: Union[str, os.PathLike[str]]) -> None:
        h5py = need_h5py()
        self.path = pathlib.Path(path)
        if self.path.is_dir():
            self.path = self.path / "run.h5"
        if not self.path.exists():
            raise Error("file-not-found", (str(self.path), 0, 0, ""), "there is no recorded run", "give the output folder of `sinew run`")
        try:
            self._file = h5py.File(self.path, "r")
        except OSError as problem:
            raise Error("unknown-format", (str(self.path), 0, 0, ""), f"it cannot be opened as HDF5: {problem}", "name a run.h5") from None
        if self._file.attrs.get("format") != _FORMAT:
            raise Error("unknown-format", (str(self.path), 0, 0, ""), "this is not a recorded run", "give a run.h5")
        if "positions" not in self._file:
            raise Error("malformed-file", (str(self.path), 0, 0, ""), "the run was recorded without positions",
                        "run the scene again, with record: {states: true}")
        # If the run was killed, its series may differ in length.
        frames = min(len(series) for series in [self._file["time"], *self._file["positions"].values()])
        self.times = self._file["time"][:frames]
        self.sim = _core.load_recorded(self._file["scene"][()].decode("utf-8"))
        self._outline = outline_of(self.sim)
        self._start = moment_of(self.sim, self._outline)
        missing = [name for name in self.sim.bodies if name not in self._file["positions"]]
        if missing or frames == 0:
            raise Error("malformed-file", (str(self.path), 0, 0, ""), f"there are no positions of {', '.join(missing) or 'any moment'}",
                        "run the scene again")
        self._threads = {name: _Thread(points, self.sim, self._start, name in self._outline.held)
                         for name, points in self._start.cables.items()}  # fmt: skip

    def __len__(self) -> int:
        return len(self.times)

    def at(self, time: float, field: Optional[str] = None) -> Moment:
        """State at a time, interpolated linearly between the two nearest recorded moments.

        Parameters
        ----------
        time : float
            s; times outside the recording give its first or last moment.
        field : str, optional
            "displacement", or a name in sinew.fields.FIELDS, which is computed from the recorded positions.
        """
        after = int(np.clip(np.searchsorted(self.times, time), 0, len(self) - 1))
        second = self.moment(after, field)
        if after == 0 or self.times[after] <= time:
            return second
        first = self.moment(after - 1, field)
        return between(first, second, (time - first.time) / (second.time - first.time))

    def moment(self, index: int, field: Optional[str] = None) -> Moment:
        """A recorded moment. Fields of elements are computed from the recorded positions. Raises Error (unknown-name)."""
        file, start = self._file, self._start
        positions = {name: file["positions"][name][index] for name in start.positions}
        values = {} if field is None else {
            name: found for name, now in positions.items() if (found := values_at(self.sim.body(name), field, now)) is not None
        }  # fmt: skip
        touching, forces = [np.zeros((0, 3))], [np.zeros((0, 3))]
        for contact in file.get("contacts", {}).values():
            if "position" in contact:
                touching.append(contact["position"][index])
                across = np.nan_to_num(contact["normal"][index])  # NaN: points that were not found, without a force
                forces.append(contact["normal_force"][index][:, None] * across + contact["friction_force"][index])
        return Moment(
            time=float(self.times[index]),
            positions=positions,
            values=values,
            cables={name: thread.points(positions) for name, thread in self._threads.items()},
            slack={name for name in start.slack | set(start.cables) if self._is_slack(name, index)},
            poses={name: self._pose(name, index) for name in start.poses},
            touching=np.concatenate(touching),
            forces=np.concatenate(forces),
            effectors={name: file["effectors"][name]["position"][index] for name in start.effectors},
            goals=self._goals(index),
        )

    def _pose(self, contact: str, index: int) -> np.ndarray:
        poses = self._file.get(f"contacts/{contact}/pose")
        return self._start.poses[contact] if poses is None else poses[index]

    def close(self) -> None:
        """Closes the file. May be called repeatedly."""
        self._file.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def _is_slack(self, name: str, index: int) -> bool:
        actuator = self._file.get(f"actuators/{name}")
        return actuator is not None and self.sim.actuator(name).type == "cable" and not actuator["effort"][index] > 0.0

    def _goals(self, index: int) -> dict[str, np.ndarray]:
        found = {}
        for name, series in self._file.get("controller", {}).items():
            if "target" in series and self.sim.effector(name).unit == "m":
                found[name] = series["target"][index]
        return found


class _Thread:
    """A cable that moves with the bodies it runs through, because its points are not recorded.

    Each point is an affine combination of the nodes of the element that is nearest at the start.
    """

    def __init__(self, points: np.ndarray, sim: Any, start: Moment, held: bool) -> None:
        self._points, self._parts = points, []
        elements = [(name, nodes) for name, body in sim.bodies.items() for nodes in _elements(body)]
        for k, point in enumerate(points):
            if k == 0 and held:
                continue
            chosen = [(float(np.min(np.linalg.norm(start.positions[name][nodes].mean(axis=1) - point, axis=1))), name, nodes)
                      for name, nodes in elements]  # fmt: skip
            _, name, nodes = min(chosen, key=lambda one: one[0])
            centres = start.positions[name][nodes].mean(axis=1)
            own = nodes[np.argmin(np.linalg.norm(centres - point, axis=1))]
            self._parts.append((k, name, own, _weights(start.positions[name][own], point)))

    def points(self, positions: dict[str, np.ndarray]) -> np.ndarray:
        """(k, 3) m for given positions of the bodies' nodes."""
        now = self._points.copy()
        for k, name, nodes, weights in self._parts:
            now[k] = weights @ positions[name][nodes]
        return now


def _elements(body: Any) -> list[np.ndarray]:
    """Nodes of elements, (m, k) for each kind; for a body without elements, all nodes as one."""
    found = [np.asarray(part) for part in (body.tetrahedra, body.hexahedra) if len(part)]
    return found or [np.arange(len(body.positions))[None]]


def _weights(nodes: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Minimum-norm weights with sum 1 with which nodes (k, 3) give a point."""
    middle = nodes.mean(axis=0)
    return 1.0 / len(nodes) + (point - middle) @ np.linalg.pinv(nodes - middle, rcond=1e-6)
