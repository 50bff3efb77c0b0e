"""Hexahedral meshes for scenes that generate their meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Mapping, Optional, Sequence

import numpy as np

__all__ = ["cup", "voxels", "write"]

_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
_VTK_HEXAHEDRON = 12


def voxels(solid: np.ndarray, edges: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solid cells of a grid whose planes may be unevenly spaced.

    Parameters
    ----------
    solid : (nx, ny, nz) bool
    edges : three arrays, (nx + 1,), (ny + 1,), (nz + 1,) m
        Positions of the grid planes.

    Returns
    -------
    nodes : (n, 3) m
    hexahedra : (m, 8) int
        In VTK's order.
    places : (n, 3) int
        Indices of the planes that a node lies on.
    """
    at = (np.argwhere(solid)[:, None, :] + _CORNERS).reshape(-1, 3)
    places, hexahedra = np.unique(at, axis=0, return_inverse=True)
    nodes = np.stack([edges[axis][places[:, axis]] for axis in range(3)], axis=1)
    return nodes, hexahedra.reshape(-1, 8), places


def _disc(quarter: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A square within a ring: points (n, 2) of the unit disc, quadrilaterals (m, 4), and the points of the circle counter-clockwise."""
    grid = np.linspace(-0.55, 0.55, quarter + 1)
    square = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    at = np.arange((quarter + 1) ** 2).reshape(quarter + 1, quarter + 1)
    cells = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)
    edge = np.concatenate([at[:-1, 0], at[-1, :-1], at[:0:-1, -1], at[0, :0:-1]])
    turn = 2.0 * np.pi * np.arange(4 * quarter) / (4 * quarter) - 0.75 * np.pi
    rim = len(square) + np.arange(4 * quarter)
    ring = np.column_stack([edge, rim, np.roll(rim, -1), np.roll(edge, -1)])
    return np.vstack([square, np.column_stack([np.cos(turn), np.sin(turn)])]), np.vstack([cells, ring]), rim


def cup(
    quarter: int, layers: int, radii: tuple[float, float], height: float, wall: float, floor: float
) -> tuple[np.ndarray, np.ndarray]:
    """A cup that stands on z = 0 around the z axis, with one hexahedron through its floor and one through its wall.

    Parameters
    ----------
    quarter, layers : int
        Cells along a quarter of its circle, and layers from the floor to the rim.
    radii : (float, float) m
        Outer radii at the floor and at the rim.
    height, wall, floor : float
        Height and thicknesses, m.

    Returns
    -------
    nodes : (n, 3) m
    hexahedra : (m, 8) int
        In VTK's order.
    """
    plane, cells, rim = _disc(quarter)
    heights = np.concatenate([[0.0], np.linspace(floor, height, layers)])
    level = len(plane) + len(rim)  # nodes per level: the inner ones, then the outer circle
    nodes = np.concatenate([np.column_stack([np.vstack([(r - wall) * plane, r * plane[rim]]), np.full(level, z)])
                            for r, z in zip(np.interp(heights, [0.0, height], radii), heights)])  # fmt: skip
    outer = len(plane) + np.arange(len(rim))
    around = np.column_stack([rim, outer, np.roll(outer, -1), np.roll(rim, -1)])
    stack = [np.vstack([cells, around])] + (layers - 1) * [around]
    used, hexahedra = np.unique(np.concatenate([np.hstack([k * level + q, (k + 1) * level + q]) for k, q in enumerate(stack)]),
                                return_inverse=True)  # fmt: skip
    return nodes[used], hexahedra.reshape(-1, 8)


def write(path: Path, nodes: np.ndarray, hexahedra: np.ndarray, labels: Optional[Mapping[str, np.ndarray]] = None) -> None:
    """Writes a mesh as a legacy VTK file.

    Parameters
    ----------
    path : Path
    nodes : (n, 3) m
    hexahedra : (m, 8) int
    labels : dict of (n,) int, optional
        In a scene, nodes with the value k of the label "name" are the node set "name:k".
    """
    count = len(hexahedra)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"# vtk DataFile Version 3.0\nhexahedra\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(nodes)} double\n")
        np.savetxt(file, nodes, "%.17g")
        file.write(f"CELLS {count} {9 * count}\n")
        np.savetxt(file, np.column_stack([np.full(count, 8), hexahedra]), "%d")
        file.write(f"CELL_TYPES {count}\n" + f"{_VTK_HEXAHEDRON}\n" * count)
        if labels:
            file.write(f"POINT_DATA {len(nodes)}\n")
        for name, values in (labels or {}).items():
            file.write(f"SCALARS {name} int 1\nLOOKUP_TABLE default\n")
            np.savetxt(file, values, "%d")
