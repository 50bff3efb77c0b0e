"""Strains and stresses of elements and their nodal averages.

    body.element_field("von_mises_stress")          # (m,) Pa
    body.nodal_field("max_stretch")                 # (n,), as the view colours it
    F = body.deformation_gradients                  # (m, 3, 3)
    sigma = body.cauchy_stresses                    # (m, 3, 3) Pa
    sinew.fields.principal_values(sigma)            # (m, 3) Pa
    sinew.fields.to_nodes(body, sigma)              # (n, 3, 3) Pa, volume-weighted means

The functions work on any tensors. FIELDS lists the fields of a body with units and equations.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

__all__ = ["FIELDS", "green_strain", "log_strain", "principal_stretches", "principal_values", "to_nodes", "von_mises"]

#: Fields of Body.element_field() and Body.nodal_field(): name -> (unit, definition).
FIELDS: dict[str, tuple[str, str]] = _core._element_fields()


def principal_stretches(deformation: ArrayLike) -> NDArray:
    """Singular values of F, largest first.

    Parameters
    ----------
    deformation : (..., 3, 3) array_like

    Returns
    -------
    (..., 3) ndarray
    """
    return np.linalg.svd(np.asarray(deformation, float), compute_uv=False)


def green_strain(deformation: ArrayLike) -> NDArray:
    """Green's strain E = (F^T F - I)/2.

    Parameters
    ----------
    deformation : (..., 3, 3) array_like

    Returns
    -------
    (..., 3, 3) ndarray
    """
    f = np.asarray(deformation, float)
    return 0.5 * (np.swapaxes(f, -1, -2) @ f - np.eye(3))


def log_strain(deformation: ArrayLike) -> NDArray:
    """Logarithmic (Hencky) strain ln U of the right stretch.

    Parameters
    ----------
    deformation : (..., 3, 3) array_like

    Returns
    -------
    (..., 3, 3) ndarray
    """
    f = np.asarray(deformation, float)
    squares, axes = np.linalg.eigh(np.swapaxes(f, -1, -2) @ f)
    return np.einsum("...ij,...j,...kj->...ik", axes, 0.5 * np.log(squares), axes)


def von_mises(stress: ArrayLike) -> NDArray:
    """sqrt(3/2 s : s) of the deviator s.

    Parameters
    ----------
    stress : (..., 3, 3) array_like
        Cauchy stress, Pa.

    Returns
    -------
    (...,) ndarray
    """
    s = np.asarray(stress, float)
    deviator = s - np.trace(s, axis1=-2, axis2=-1)[..., None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * np.sum(deviator**2, axis=(-2, -1)))


def principal_values(stress: ArrayLike) -> NDArray:
    """Eigenvalues of a symmetric tensor, largest first.

    Parameters
    ----------
    stress : (..., 3, 3) array_like

    Returns
    -------
    (..., 3) ndarray
    """
    s = np.asarray(stress, float)
    return np.linalg.eigvalsh(0.5 * (s + np.swapaxes(s, -1, -2)))[..., ::-1]


def to_nodes(body, values: ArrayLike) -> NDArray:
    """Averages element values at the nodes, weighted by the volumes of the adjacent elements.

    Parameters
    ----------
    body : Body
    values : (m, ...) array_like
        One value per element, tetrahedra before hexahedra.

    Returns
    -------
    (n, ...) ndarray
        NaN at nodes without elements.
    """
    return body.nodal_means(np.asarray(values, float))
