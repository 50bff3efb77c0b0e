"""Meshes of hexahedra, for scenes that generate theirs."""

from __future__ import annotations

from pathlib import Path
from typing import Mapping, Optional, Sequence

import numpy as np

__all__ = ["voxels", "write"]

_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
_VTK_HEXAHEDRON = 12


def voxels(solid: np.ndarray, edges: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The solid cells of a grid whose planes may be unevenly spaced.

    Parameters
    ----------
    solid : (nx, ny, nz) bool
    edges : three arrays, (nx + 1,), (ny + 1,), (nz + 1,) m
        Where the planes of the grid are.

    Returns
    -------
    nodes : (n, 3) m
    hexahedra : (m, 8) int
        In VTK's order.
    places : (n, 3) int
        The planes that a node lies on.
    """
    at = (np.argwhere(solid)[:, None, :] + _CORNERS).reshape(-1, 3)
    places, hexahedra = np.unique(at, axis=0, return_inverse=True)
    nodes = np.stack([edges[axis][places[:, axis]] for axis in range(3)], axis=1)
    return nodes, hexahedra.reshape(-1, 8), places


def write(path: Path, nodes: np.ndarray, hexahedra: np.ndarray, labels: Optional[Mapping[str, np.ndarray]] = None) -> None:
    """Writes a mesh as a legacy VTK file.

    Parameters
    ----------
    path : Path
    nodes : (n, 3) m
    hexahedra : (m, 8) int
    labels : dict of (n,) int, optional
        Nodes with the value k of the label "name" are the node set "name:k" of a scene.
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
