"""Forces of linear and corotational tetrahedra: an independent implementation in NumPy and SciPy.

P = R (2 mu (S - I) + lambda tr(S - I) I), F = R S by scipy.linalg.polar, and the linear law with the
small strain in place of S - I (Etzmuss, Keckeisen and Strasser 2003; Mueller and Gross 2004, eq. 6).
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse

from . import tetrahedra as geometry


def lame(young: float, poisson: float) -> tuple[float, float]:
    """lambda, mu (Pa)."""
    return (young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson)))


def stress(deformation: np.ndarray, young: float, poisson: float, model: str) -> np.ndarray:
    """First Piola-Kirchhoff stress (3, 3) Pa of a deformation gradient."""
    lam, mu = lame(young, poisson)
    if model == "linear":
        rotation = np.eye(3)
        strain = 0.5 * (deformation + deformation.T) - np.eye(3)
    else:
        rotation, stretch = scipy.linalg.polar(deformation)
        if np.linalg.det(rotation) < 0:
            raise ValueError("inverted element")
        strain = stretch - np.eye(3)
    return rotation @ (2 * mu * strain + lam * np.trace(strain) * np.eye(3))


def forces(positions, nodes, tetrahedra, young, poisson, model="corotational") -> np.ndarray:
    """Internal forces (n, 3) N: the gradient of the strain energy."""
    grads, volumes = geometry.gradients(nodes, tetrahedra)
    deformation = np.einsum("eai,eaj->eij", positions[tetrahedra], grads)
    result = np.zeros_like(nodes)
    for e, nodes_of in enumerate(tetrahedra):
        piola = stress(deformation[e], young, poisson, model)
        result[nodes_of] += volumes[e] * grads[e] @ piola.T
    return result


def linear_stiffness(nodes, tetrahedra, young, poisson) -> scipy.sparse.csr_matrix:
    """Small-strain stiffness (3n, 3n) N/m: V (lambda g_a g_b^T + mu g_b g_a^T + mu g_a.g_b I)."""
    lam, mu = lame(young, poisson)
    grads, volumes = geometry.gradients(nodes, tetrahedra)
    outer = np.einsum("e,eai,ebj->eaibj", volumes, grads, grads)
    dots = np.einsum("e,eai,ebi->eab", volumes, grads, grads)
    blocks = (lam * outer + mu * outer.transpose(0, 1, 4, 3, 2)
              + mu * np.einsum("eab,ij->eaibj", dots, np.eye(3)))
    dofs = (3 * tetrahedra[:, :, None] + np.arange(3)).reshape(len(tetrahedra), 12)
    rows = np.repeat(dofs, 12, axis=1).ravel()
    columns = np.tile(dofs, (1, 12)).ravel()
    size = 3 * len(nodes)
    return scipy.sparse.csr_matrix((blocks.reshape(-1), (rows, columns)), shape=(size, size))


def element_forces(corners, grads, volumes, young, poisson) -> np.ndarray:
    """Forces (m, 4, 3) in N of all corotational tetrahedra for corner positions (m, 4, 3) in m; the
    rotation from the singular value decomposition F = U s V^T is R = U V^T."""
    lam, mu = lame(young, poisson)
    deformation = np.einsum("eai,eaj->eij", corners, grads)
    left, stretches, right = np.linalg.svd(deformation)
    if np.any(np.linalg.det(deformation) <= 0):
        raise ValueError("inverted element")
    trace = stretches.sum(axis=1) - 3
    principal = 2 * mu * (stretches - 1) + lam * trace[:, None]
    piola = np.einsum("eik,ek,ekj->eij", left, principal, right)
    return np.einsum("e,eij,eaj->eai", volumes, piola, grads)


def element_stiffness(corners, grads, volumes, young, poisson, step) -> np.ndarray:
    """Tangents (m, 4, 3, 4, 3) N/m by central differences over `step` (m) of element_forces()."""
    result = np.empty((len(corners), 4, 3, 4, 3))
    for b in range(4):
        for j in range(3):
            moved = corners.copy()
            moved[:, b, j] += step
            ahead = element_forces(moved, grads, volumes, young, poisson)
            moved[:, b, j] -= 2 * step
            behind = element_forces(moved, grads, volumes, young, poisson)
            result[:, :, :, b, j] = (ahead - behind) / (2 * step)
    return result
