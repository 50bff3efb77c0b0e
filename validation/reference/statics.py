"""Static equilibrium of a corotational robot with cables, by its own Newton's method.

Energy: strain energy of the tetrahedra + sum over cables of T L(x) - weights . x. A cable of constant
tension T is the load -T dL/dx, its tangent T d2L/dx2 (segment of length l along u: (I - u u^T)/l).
Nothing of Sinew is used except the mesh, which is an argument.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from . import corotational
from . import tetrahedra as geometry


def embed(points, nodes, tetrahedra) -> np.ndarray:
    """Weights (p, n) of the nodes for each point: barycentric in the element that contains it best, found by
    testing all elements."""
    weights = np.zeros((len(points), len(nodes)))
    corners = nodes[tetrahedra]
    edges = corners[:, 1:] - corners[:, :1]
    inverse = np.linalg.inv(np.transpose(edges, (0, 2, 1)))
    for k, point in enumerate(points):
        rest = np.einsum("eij,ej->ei", inverse, point - corners[:, 0])
        all_four = np.column_stack([1 - rest.sum(axis=1), rest])
        best = int(np.argmax(all_four.min(axis=1)))
        if all_four[best].min() < -1e-9:
            raise ValueError(f"point {point} lies outside the mesh")
        weights[k, tetrahedra[best]] = all_four[best]
    return weights


class Robot:
    """A body held at some nodes, with cables.

    Parameters
    ----------
    nodes : array (n, 3), m
    tetrahedra : array (m, 4)
    fixed : array (n,) of bool
    young, poisson : float
        Pa, 1.
    cables : list of (points, world)
        Points (p, 3) m at rest, pull point first; `world`: the pull point is fixed in the world.
    """

    def __init__(self, nodes, tetrahedra, fixed, young, poisson, cables):
        self.nodes, self.tetrahedra = np.array(nodes), np.array(tetrahedra)
        self.free = np.flatnonzero(np.repeat(~np.array(fixed), 3))
        self.material = (young, poisson)
        self.grads, self.volumes = geometry.gradients(self.nodes, self.tetrahedra)
        self.cables = []
        for points, world in cables:
            held = np.array(points[:1]) if world else np.zeros((0, 3))
            self.cables.append((held, embed(points[1:] if world else points, self.nodes,
                                            self.tetrahedra)))

    def way(self, cable, x):
        """Points (p, 3) m of a cable at node positions x."""
        held, weights = self.cables[cable]
        return np.vstack([held, weights @ x])

    def length(self, cable, x) -> float:
        """Length (m) of a cable at node positions x."""
        return float(np.linalg.norm(np.diff(self.way(cable, x), axis=0), axis=1).sum())

    def residual(self, x, loads, tensions):
        """loads - internal forces - T dL/dx, (n, 3) N."""
        inside = corotational.element_forces(x[self.tetrahedra], self.grads, self.volumes,
                                             *self.material)
        result = np.array(loads, dtype=float)
        np.add.at(result, self.tetrahedra, -inside)
        for cable, tension in enumerate(tensions):
            held, weights = self.cables[cable]
            steps = np.diff(self.way(cable, x), axis=0)
            units = steps / np.linalg.norm(steps, axis=1)[:, None]
            slope = np.zeros((len(held) + len(weights), 3))
            slope[1:] += units
            slope[:-1] -= units
            result -= tension * weights.T @ slope[len(held):]
        return result

    def tangent(self, x, tensions):
        """- d residual / dx, sparse (3n, 3n) N/m."""
        blocks = corotational.element_stiffness(x[self.tetrahedra], self.grads, self.volumes,
                                                *self.material, step=1e-7 * np.ptp(self.nodes))
        dofs = (3 * self.tetrahedra[:, :, None] + np.arange(3)).reshape(len(self.tetrahedra), 12)
        rows = np.repeat(dofs, 12, axis=1).ravel()
        columns = np.tile(dofs, (1, 12)).ravel()
        size = 3 * len(self.nodes)
        matrix = scipy.sparse.csr_matrix((blocks.reshape(-1), (rows, columns)), shape=(size, size))
        for cable, tension in enumerate(tensions):
            held, weights = self.cables[cable]
            steps = np.diff(self.way(cable, x), axis=0)
            padded = np.vstack([np.zeros((len(held), len(self.nodes))), weights])
            for step, part in zip(steps, np.diff(padded, axis=0)):
                length = np.linalg.norm(step)
                unit = step / length
                part = scipy.sparse.csr_matrix(part)
                bend = (np.eye(3) - np.outer(unit, unit)) * tension / length
                matrix = matrix + scipy.sparse.kron(part.T @ part, bend)
        return matrix.tocsr()

    def settle(self, loads, tensions, *, load_steps=1, tolerance=1e-11):
        """Node positions (n, 3) m in equilibrium; loads and tensions are applied in equal steps."""
        x = self.nodes.copy()
        scale = np.linalg.norm(loads) + np.abs(tensions).sum()
        for share in np.arange(1, load_steps + 1) / load_steps:
            for _ in range(60):
                residual = self.residual(x, share * np.asarray(loads),
                                         share * np.asarray(tensions)).ravel()[self.free]
                if np.linalg.norm(residual) <= tolerance * scale:
                    break
                matrix = self.tangent(x, share * np.asarray(tensions))[self.free][:, self.free]
                x.ravel()[self.free] += scipy.sparse.linalg.spsolve(matrix.tocsc(), residual)
            else:
                raise RuntimeError("the reference found no equilibrium")
        return x
