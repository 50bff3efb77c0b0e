"""Surfaces of bodies as triangles with smooth normals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

__all__ = ["Skin", "boundary_of"]

_CREASE = math.radians(50.0)  # angle between the rest normals of neighbouring faces above which their edge is sharp

# Faces of elements in VTK's node order, counter-clockwise seen from outside; corners first, then mid-edge nodes.
_TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
_QUADRATIC = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
_HEXAHEDRON = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
# Triangles and edges of a face with 3, 4 or 6 nodes.
_SPLIT = {3: [[0, 1, 2]], 4: [[0, 1, 2], [0, 2, 3]], 6: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]}
_RIM = {3: [[0, 1], [1, 2], [2, 0]], 4: [[0, 1], [1, 2], [2, 3], [3, 0]], 6: [[0, 3], [3, 1], [1, 4], [4, 2], [2, 5], [5, 0]]}


def _outer(elements: np.ndarray, faces: np.ndarray, corners: int) -> np.ndarray:
    """Faces (k, nodes of a face) that belong to a single element."""
    own = np.asarray(elements)[:, faces].reshape(-1, faces.shape[1])
    if len(own) == 0:
        return own
    key = np.sort(own[:, :corners], axis=1)
    _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    return own[np.sort(first[count == 1])]


def boundary_of(body: Any) -> tuple[np.ndarray, np.ndarray]:
    """Surface of a body.

    Parameters
    ----------
    body : Body

    Returns
    -------
    triangles : (t, 3) ndarray of int
        Nodes, counter-clockwise seen from outside.
    edges : (e, 2) ndarray of int
        Nodes of the mesh edges on the surface.
    """
    quadratic = np.asarray(body.quadratic_tetrahedra)
    tetrahedra = (_outer(quadratic, _QUADRATIC, 3) if len(quadratic) else _outer(body.tetrahedra, _TETRAHEDRON, 3))
    found = [tetrahedra, _outer(body.hexahedra, _HEXAHEDRON, 4)]
    if not any(len(faces) for faces in found):
        found = [np.asarray(body.triangles).reshape(-1, 3)]  # a rigid solid has no elements
    triangles = [faces[:, _SPLIT[faces.shape[1]]].reshape(-1, 3) for faces in found]
    rims = [np.sort(faces[:, _RIM[faces.shape[1]]].reshape(-1, 2), axis=1) for faces in found]
    return np.concatenate(triangles).astype(np.int64), np.unique(np.concatenate(rims), axis=0).astype(np.int64)


class Skin:
    """Surface of a body, for drawing at any positions of its nodes.

    A node on a crease has a vertex for each smooth part that meets there, so that creases stay sharp.

    Parameters
    ----------
    triangles : (t, 3) ndarray of int
        Nodes.
    edges : (e, 2) ndarray of int
        Nodes of mesh edges, which can be drawn.
    rest : (n, 3) ndarray
        Positions of the nodes at rest, m; they determine the creases.

    Attributes
    ----------
    nodes : (v,) ndarray of int
        Node of each vertex.
    triangles : (t, 3) ndarray of int
        Vertices.
    edges : (e, 2) ndarray of int
        Vertices.
    """

    def __init__(self, triangles: np.ndarray, edges: np.ndarray, rest: np.ndarray) -> None:
        groups = _smooth_parts(triangles, np.asarray(rest, dtype=float))
        _, first, vertices = np.unique(groups, return_index=True, return_inverse=True)
        self.nodes = triangles.reshape(-1)[first]
        self.triangles = vertices.reshape(-1, 3)
        vertex_of = np.zeros(len(rest), dtype=np.int64)
        vertex_of[self.nodes] = np.arange(len(self.nodes))
        self.edges = vertex_of[edges]
        # Triangle corners sorted by vertex, for sums over the triangles at each vertex.
        order = np.argsort(vertices, kind="stable")
        self._triangle = order // 3
        self._start = np.searchsorted(vertices[order], np.arange(len(self.nodes)))

    def shape(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices and their normals.

        Parameters
        ----------
        positions : (n, 3) ndarray
            Of the nodes, m.

        Returns
        -------
        points, normals : (v, 3) ndarrays of float32
            m; unit vectors, or zero for surfaces without area.
        """
        points = np.asarray(positions, dtype=float)[self.nodes]
        if len(points) == 0:
            return np.zeros((0, 3), dtype=np.float32), np.zeros((0, 3), dtype=np.float32)
        areas = _areas(points, self.triangles)
        normals = np.add.reduceat(areas[self._triangle], self._start, axis=0)
        lengths = np.sqrt(np.einsum("ij,ij->i", normals, normals))
        normals /= np.where(lengths > 0.0, lengths, 1.0)[:, None]
        return points.astype(np.float32), normals.astype(np.float32)


def _areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(t, 3): vectors along the outward normals with twice the area as length, m^2."""
    a, b, c = points[triangles[:, 0]], points[triangles[:, 1]], points[triangles[:, 2]]
    return np.cross(b - a, c - a)


def _smooth_parts(triangles: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """(3 t,): equal numbers for corners of triangles that share a node and a normal."""
    count = len(triangles)
    areas = _areas(rest, triangles)
    normals = areas / np.maximum(np.linalg.norm(areas, axis=1), 1e-300)[:, None]
    # Half-edges from corner k of a triangle to the next corner; the neighbour has the reversed half-edge.
    start, end = triangles.reshape(-1), triangles[:, [1, 2, 0]].reshape(-1)
    key, reverse = start * len(rest) + end, end * len(rest) + start
    order = np.argsort(key, kind="stable")
    at = np.minimum(np.searchsorted(key[order], reverse), max(3 * count - 1, 0))
    mate = order[at] if count else at
    half = np.arange(3 * count)
    met = key[mate] == reverse if count else np.zeros(0, dtype=bool)
    half, mate = half[met], mate[met]
    smooth = np.einsum("ij,ij->i", normals[half // 3], normals[mate // 3]) > math.cos(_CREASE)
    half, mate = half[smooth], mate[smooth]

    def following(corner: np.ndarray) -> np.ndarray:
        return corner - corner % 3 + (corner + 1) % 3

    # The start of a half-edge is the end of the neighbour's.
    first = np.concatenate([half, following(half)])
    second = np.concatenate([following(mate), mate])
    labels = np.arange(3 * count)
    while True:
        least = np.minimum(labels[first], labels[second])
        joined = labels.copy()
        np.minimum.at(joined, first, least)
        np.minimum.at(joined, second, least)
        if np.array_equal(joined, labels):
            return labels
        labels = joined
