"""Tubes, rods and balls as triangles: cables, arrows, points."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

__all__ = ["Marks"]

_TUBE, _FINE = 8, 20  # number of sides: of tubes, which are thin; of rods and balls


class Marks:
    """Round objects of one frame, drawn together.

    Attributes
    ----------
    vertices : (v, 9) ndarray of float32
        Position, m, unit normal, and sRGB.
    triangles : (t, 3) ndarray of int32
        Counter-clockwise seen from outside.
    """

    def __init__(self) -> None:
        self._vertices: list[np.ndarray] = []
        self._triangles: list[np.ndarray] = []
        self._count = 0

    @property
    def vertices(self) -> np.ndarray:
        return np.concatenate([np.zeros((0, 9), dtype="f4"), *self._vertices])

    @property
    def triangles(self) -> np.ndarray:
        return np.concatenate([np.zeros((0, 3), dtype="i4"), *self._triangles])

    def _add(self, points: np.ndarray, normals: np.ndarray, colour: Any, triangles: np.ndarray) -> None:
        rows = np.empty((len(points), 9), dtype="f4")
        rows[:, :3], rows[:, 3:6], rows[:, 6:] = points, normals, colour
        self._vertices.append(rows)
        self._triangles.append((triangles + self._count).astype("i4"))
        self._count += len(points)

    def tube(self, points: np.ndarray, radius: float, colour: Any) -> None:
        """Adds a tube along (k, 3), m."""
        points = points[np.concatenate([[True], np.any(np.diff(points, axis=0) != 0.0, axis=1)])]
        if len(points) < 2:
            return
        along = _units(np.diff(points, axis=0))
        along = _units(np.vstack([along[:1], along[:-1] + along[1:], along[-1:]]))
        # The world axis that is least parallel to the tube is the reference, which keeps the frames from flipping.
        aside = _units(np.cross(along, np.eye(3)[np.argmin(np.abs(along).max(axis=0))]))
        normals = _rings(along, aside, _TUBE)
        k = len(points)
        hull = (np.arange(k - 1)[:, None, None] * _TUBE + _band(_TUBE)[None]).reshape(-1, 3)
        self._add((points[:, None] + radius * normals).reshape(-1, 3), normals.reshape(-1, 3), colour, hull)
        self.ball(points[[0, -1]], radius, colour, _TUBE)

    def rod(self, first: np.ndarray, last: np.ndarray, radii: tuple[Any, Any], colour: Any) -> None:
        """Adds cylinders or cones from (k, 3) to (k, 3), m, with a radius at each end, m, closed at the first end."""
        k, along = len(first), last - first
        lengths = np.maximum(np.linalg.norm(along, axis=1), 1e-12)
        axis = along / lengths[:, None]
        aside = _units(np.cross(axis, np.where(np.abs(axis[:, :1]) < 0.7, np.eye(3)[:1], np.eye(3)[1:2])))
        out = _rings(axis, aside, _FINE)
        r0, r1 = (np.broadcast_to(radius, (k,))[:, None, None] for radius in radii)
        rings = np.stack([first[:, None] + r0 * out, last[:, None] + r1 * out], axis=1)
        slope = _units((out * lengths[:, None, None] + axis[:, None] * (r0 - r1)).reshape(-1, 3)).reshape(out.shape)
        band = (np.arange(k)[:, None, None] * 2 * _FINE + _band(_FINE)[None]).reshape(-1, 3)
        self._add(rings.reshape(-1, 3), np.stack([slope, slope], axis=1).reshape(-1, 3), colour, band)
        cap = np.concatenate([rings[:, 0], first[:, None]], axis=1)
        side = np.arange(_FINE)
        fan = np.stack([np.full(_FINE, _FINE), (side + 1) % _FINE, side], axis=1)
        fans = (np.arange(k)[:, None, None] * (_FINE + 1) + fan[None]).reshape(-1, 3)
        self._add(cap.reshape(-1, 3), np.repeat(-axis, _FINE + 1, axis=0), colour, fans)

    def arrows(self, points: np.ndarray, vectors: np.ndarray, radius: float, colour: Any) -> None:
        """Adds arrows from points (k, 3) along vectors (k, 3), m, with shafts of a given radius, m; short arrows are thinner."""
        lengths = np.linalg.norm(vectors, axis=1)
        heads = np.minimum(5.0 * radius, 0.6 * lengths)
        necks = points + vectors * (1.0 - heads / lengths)[:, None]
        shafts = np.minimum(radius, 0.12 * lengths)
        self.rod(points, necks, (shafts, shafts), colour)
        self.rod(necks, points + vectors, (0.42 * heads, 0.0), colour)

    def ball(self, centres: np.ndarray, radius: float, colour: Any, sides: int = _FINE) -> None:
        """Adds balls at (k, 3), m."""
        unit, triangles = _ball(sides)
        k, n = len(centres), len(unit)
        hull = (np.arange(k)[:, None, None] * n + triangles[None]).reshape(-1, 3)
        self._add((centres[:, None] + radius * unit).reshape(-1, 3), np.tile(unit, (k, 1)), colour, hull)


def _units(vectors: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def _rings(axis: np.ndarray, aside: np.ndarray, sides: int) -> np.ndarray:
    """(k, sides, 3): unit vectors around axes (k, 3), starting at `aside`."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    third = np.cross(axis, aside)
    return np.cos(angle)[:, None] * aside[:, None] + np.sin(angle)[:, None] * third[:, None]


@functools.lru_cache(maxsize=4)
def _band(sides: int) -> np.ndarray:
    """(2 sides, 3): triangles between two successive rings."""
    k = np.arange(sides)
    n = (k + 1) % sides
    return np.vstack([np.stack([k, n, n + sides], axis=1), np.stack([k, n + sides, k + sides], axis=1)])


@functools.lru_cache(maxsize=4)
def _ball(sides: int) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) points of the unit sphere; (t, 3) triangles."""
    rings = sides // 2
    polar, angle = np.pi * np.arange(rings + 1) / rings, 2.0 * np.pi * np.arange(sides) / sides
    points = np.stack([np.outer(np.sin(polar), np.cos(angle)), np.outer(np.sin(polar), np.sin(angle)),
                       np.outer(np.cos(polar), np.ones(sides))], axis=-1).reshape(-1, 3)  # fmt: skip
    row, k = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    a, b = row * sides + k, row * sides + (k + 1) % sides
    return points, np.stack([[a, a + sides, b], [b, a + sides, b + sides]]).transpose(2, 3, 0, 1).reshape(-1, 3)
