"""Cameras and views."""

from __future__ import annotations

import dataclasses
import difflib
import math
from typing import Union

import numpy as np
from numpy.typing import ArrayLike

from ..errors import Error

__all__ = ["Camera", "VIEWS", "axes_of_view", "camera_of", "fit"]

# Directions from the target to the camera: components to the right, to the front and up, see axes_of_view().
VIEWS = {"corner": (0.45, 0.80, 0.36), "front": (0.0, 1.0, 0.0), "side": (1.0, 0.0, 0.0), "top": (0.0, 0.0, 1.0)}
_FIELD_OF_VIEW = 0.55  # rad, slightly telephoto, for little distortion
_MIN_SIZE = 1e-6  # m, smallest size of a scene


@dataclasses.dataclass(frozen=True)
class Camera:
    """Position and direction of the camera.

    Parameters
    ----------
    position : (3,) array_like
        m.
    target : (3,) array_like
        Point in the middle of the picture, m.
    up : (3,) array_like
        Direction that points up in the picture; any length.
    field_of_view : float
        Angle from the lower to the upper edge of the picture, rad.

    Raises
    ------
    Error
        wrong-shape, not-finite, out-of-range (also if `up` is along the line of sight).
    """

    position: tuple[float, float, float]
    target: tuple[float, float, float]
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)
    field_of_view: float = _FIELD_OF_VIEW

    def __post_init__(self) -> None:
        for name in ("position", "target", "up"):
            value = np.asarray(getattr(self, name), dtype=float)
            if value.shape != (3,):
                raise Error("wrong-shape", f"Camera({name})", f"it has shape {value.shape}", "give x, y and z")
            if not np.isfinite(value).all():
                raise Error("not-finite", f"Camera({name})", f"it is {value}", "give numbers")
            object.__setattr__(self, name, tuple(value.tolist()))
        if not 0.01 <= self.field_of_view <= 3.0:
            raise Error("out-of-range", "Camera(field_of_view)", f"it is {self.field_of_view} rad", "give 0.01 to 3 rad")
        forward = np.subtract(self.target, self.position)
        if np.linalg.norm(np.cross(forward, self.up)) <= 1e-9 * np.linalg.norm(forward) * np.linalg.norm(self.up):
            raise Error("out-of-range", "Camera", "up is zero or along the line of sight, or position and target are one",
                        "choose another up")

    def axes(self) -> np.ndarray:
        """(3, 3) unit vectors: rows point right, up, and out of the picture towards the camera."""
        back = _unit(np.subtract(self.position, self.target))
        right = _unit(np.cross(self.up, back))
        return np.stack([right, np.cross(back, right), back])

    def matrix(self, size: tuple[int, int], near: float, far: float) -> np.ndarray:
        """(4, 4) matrix from (x, y, z, 1), m, to OpenGL's clip coordinates.

        Parameters
        ----------
        size : (int, int)
            Width and height of the picture, pixels.
        near, far : float
            Clipping distances along the line of sight, m.
        """
        view = np.eye(4)
        view[:3, :3] = self.axes()
        view[:3, 3] = -self.axes() @ self.position
        focal = 1.0 / math.tan(0.5 * self.field_of_view)
        lens = np.zeros((4, 4))
        lens[0, 0], lens[1, 1] = focal * size[1] / size[0], focal
        lens[2, 2], lens[2, 3] = (near + far) / (near - far), 2.0 * near * far / (near - far)
        lens[3, 2] = -1.0
        return lens @ view

    def project(self, points: ArrayLike, size: tuple[int, int]) -> np.ndarray:
        """Positions of points in a picture.

        Parameters
        ----------
        points : (n, 3) array_like
            m.
        size : (int, int)
            Width and height of the picture, pixels.

        Returns
        -------
        (n, 2) ndarray
            Pixels from the left and from the upper edge; NaN behind the camera. The pixel in row r and column c extends
            from (c, r) to (c + 1, r + 1).
        """
        seen = (np.asarray(points, dtype=float) - self.position) @ self.axes().T
        depth = np.where(seen[:, 2] < 0.0, -seen[:, 2], np.nan)
        focal = 0.5 * size[1] / math.tan(0.5 * self.field_of_view)
        return np.stack([0.5 * size[0] + focal * seen[:, 0] / depth, 0.5 * size[1] - focal * seen[:, 1] / depth], axis=1)


def axes_of_view(up: np.ndarray) -> np.ndarray:
    """(3, 3): rows point right, forward (towards the viewer of "front"), and up; for z up: x, -y and z."""
    up = _unit(up)
    # x points right unless it is (nearly) vertical.
    right = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    right = _unit(right - up * (right @ up))
    return np.stack([right, np.cross(right, up), up])


def fit(points: np.ndarray, up: np.ndarray, view: str, size: tuple[int, int], left: float = 0.0, margin: float = 1.2) -> Camera:
    """The closest camera that sees all points.

    Parameters
    ----------
    points : (n, 3) ndarray
        m.
    up : (3,) ndarray
        Direction that points up in the picture.
    view : str
        One of VIEWS.
    size : (int, int)
        Width and height of the picture, pixels.
    left : float
        Fraction of the picture at its left edge that stays free.
    margin : float
        Size of the picture relative to its content.
    """
    axes = axes_of_view(up)
    back = _unit(np.array(VIEWS[view]) @ axes)
    lifted = -axes[1] if view == "top" else axes[2]
    right = _unit(np.cross(lifted, back))
    frame = np.stack([right, np.cross(back, right), back])
    seen = points @ frame.T
    tangent = math.tan(0.5 * _FIELD_OF_VIEW) / margin
    above = np.array([tangent * size[0] / size[1], tangent])  # slopes of the right and upper planes of the view frustum
    below = above * [1.0 - 2.0 * left, 1.0]
    # Opposite frustum planes that touch the points determine the distance and the centre.
    depth = seen[:, 2:]
    high, low = (seen[:, :2] + above * depth).max(axis=0), (seen[:, :2] - below * depth).min(axis=0)
    distance = max(((high - low) / (above + below)).max(), depth.max() + _MIN_SIZE, _MIN_SIZE)
    middle = 0.5 * (high - above * distance + low + below * distance)
    position = np.array([*middle, distance]) @ frame
    target = np.array([*middle, 0.5 * (depth.max() + depth.min())]) @ frame
    if np.linalg.norm(position - target) < _MIN_SIZE:
        position = target + _MIN_SIZE * back
    return Camera(tuple(position), tuple(target), tuple(lifted))


def camera_of(camera: Union[Camera, str, None], points: np.ndarray, up: np.ndarray, size: tuple[int, int], left: float = 0.0) -> Camera:
    """A Camera unchanged, or for None or the name of a view one that is fitted to the points. Raises unknown-name, wrong-type."""
    if isinstance(camera, Camera):
        return camera
    if camera is None:
        camera = "corner"
    if not isinstance(camera, str):
        raise Error("wrong-type", "camera", f"a value of type {type(camera).__name__} is not a camera",
                    "give a sinew.render.Camera, the name of a view, or None")
    if camera not in VIEWS:
        near = difflib.get_close_matches(camera, VIEWS, 1)
        raise Error("unknown-name", "camera", f"there is no view {camera!r}",
                    f"did you mean {near[0]!r}?" if near else f"use one of {', '.join(VIEWS)}")
    return fit(points, up, camera, size, left)


def _unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)
