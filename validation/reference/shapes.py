"""Meshes for cases, written as VTU."""

from __future__ import annotations

import pathlib

import meshio
import numpy as np


def _write(path: pathlib.Path, points, cells, kind: str, sets) -> pathlib.Path:
    masks = {name: np.asarray(members, np.uint8) for name, members in (sets or {}).items()}
    meshio.write_points_cells(path, np.asarray(points, float), [(kind, np.asarray(cells))], point_data=masks)
    return path


def write_hexahedra(path: pathlib.Path, points, cells, sets=None) -> pathlib.Path:
    """(n, 3) m, (m, 8) in VTK order, and by name masks (n,) of nodes."""
    return _write(path, points, cells, "hexahedron", sets)


def write_tetrahedra(path: pathlib.Path, points, cells, sets=None) -> pathlib.Path:
    """As write_hexahedra(), (m, 4)."""
    return _write(path, points, cells, "tetra", sets)


def hollow_sphere(path: pathlib.Path, inner: float, outer: float, around: int, through: int) -> pathlib.Path:
    """A spherical shell: each face of a cube in around x around cells, blown up on a sphere at equal angles,
    and `through` layers of even thickness. Radii in m."""
    angles = np.tan(np.linspace(-np.pi / 4, np.pi / 4, around + 1))
    numbers: dict[tuple, int] = {}
    points: list[np.ndarray] = []

    def node(direction: np.ndarray, layer: int) -> int:
        key = (*np.round(direction, 9), layer)
        if key not in numbers:
            numbers[key] = len(points)
            points.append(direction * (inner + (outer - inner) * layer / through))
        return numbers[key]

    cells = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            grid = np.empty((around + 1, around + 1, 3))
            for i, a in enumerate(angles):
                for j, b in enumerate(angles):
                    grid[i, j, axis], grid[i, j, u], grid[i, j, v] = side, side * a, b
            grid /= np.linalg.norm(grid, axis=2, keepdims=True)
            for i in range(around):
                for j in range(around):
                    square = [grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]]
                    for k in range(through):
                        cells.append([node(d, k) for d in square] + [node(d, k + 1) for d in square])
    return write_hexahedra(path, points, cells)
