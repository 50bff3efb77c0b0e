"""Rotation vectors: differences and products, by unit quaternions (w, x, y, z)."""

from __future__ import annotations

import numpy as np

__all__ = ["difference", "product"]


def _quaternion(vector: np.ndarray) -> np.ndarray:
    angle = np.linalg.norm(vector)
    return np.concatenate([[np.cos(angle / 2.0)], 0.5 * np.sinc(angle / (2.0 * np.pi)) * vector])


def _vector(q: np.ndarray) -> np.ndarray:
    q = q if q[0] >= 0.0 else -q
    sine = np.linalg.norm(q[1:])
    return 2.0 * q[1:] if sine < 1e-12 else 2.0 * np.arctan2(sine, q[0]) / sine * q[1:]


def _multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.concatenate([[a[0] * b[0] - a[1:] @ b[1:]], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(3,) rad: of R(first) R(second)."""
    return _vector(_multiply(_quaternion(first), _quaternion(second)))


def difference(to: np.ndarray, start: np.ndarray) -> np.ndarray:
    """(3,) rad: the rotation about world axes from R(start) to R(to), the shorter way."""
    return product(to, -start)
