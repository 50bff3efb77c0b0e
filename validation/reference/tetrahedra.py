"""Geometry of linear tetrahedra in NumPy: boundary, shape gradients, consistent face loads."""

from __future__ import annotations

import numpy as np


def boundary(tetrahedra: np.ndarray) -> np.ndarray:
    """Triangles (t, 3) of only one tetrahedron, counter-clockwise seen from outside."""
    faces = np.concatenate([tetrahedra[:, list(f)]
                            for f in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                return_counts=True)
    return faces[first[count == 1]]


def area_vectors(nodes: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Outward normals times areas, (t, 3) m^2."""
    a, b, c = (nodes[triangles[:, i]] for i in range(3))
    return 0.5 * np.cross(b - a, c - a)


def face_loads(nodes: np.ndarray, triangles: np.ndarray, stress: np.ndarray) -> np.ndarray:
    """Nodal forces (n, 3) N consistent with the tractions P N of a constant stress P (Pa)."""
    share = area_vectors(nodes, triangles) @ stress.T / 3.0
    loads = np.zeros_like(nodes)
    for i in range(3):
        np.add.at(loads, triangles[:, i], share)
    return loads


def gradients(nodes: np.ndarray, tetrahedra: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape gradients (m, 4, 3) 1/m and volumes (m,) m^3 at rest."""
    edges = (nodes[tetrahedra[:, 1:]] - nodes[tetrahedra[:, :1]]).transpose(0, 2, 1)
    inverse = np.linalg.inv(edges)  # rows: gradients of nodes 1, 2, 3
    first = -inverse.sum(axis=1, keepdims=True)
    return np.concatenate([first, inverse], axis=1), np.linalg.det(edges) / 6.0
