"""Forces of linear and corotational tetrahedra, written anew in NumPy and SciPy.

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
