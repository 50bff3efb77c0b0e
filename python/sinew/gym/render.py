"""Pictures of environments, drawn by Matplotlib without a window, and the live view."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ..errors import Error
from .task import unknown

__all__ = ["MODES", "Picture"]

MODES = ("rgb_array", "human")
_SIZE = 4.0, 4.0  # inches, at 100 dots per inch


def mode_checked(mode: Optional[str]) -> Optional[str]:
    """The render mode itself; raises unknown-name."""
    if mode is not None and mode not in MODES:
        raise unknown("render_mode", "render mode", mode, MODES)
    return mode


def surface_of(tetrahedra: np.ndarray) -> np.ndarray:
    """Triangles (k, 3) that belong to one tetrahedron only."""
    faces = np.concatenate([tetrahedra[:, [1, 2, 3]], tetrahedra[:, [0, 3, 2]], tetrahedra[:, [0, 1, 3]], tetrahedra[:, [0, 2, 1]]])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


class Picture:
    """Draws environments in one of the render modes.

    "rgb_array" draws when `frame` is called: the surface of the body, or its axis, and the goal. "human" shows environment 0
    in the browser (sinew.view) after every step.
    """

    def __init__(self, mode: Optional[str]) -> None:
        self._mode = mode
        self._axes: Any = None
        self._faces: Optional[np.ndarray] = None
        self._view: Any = None
        self._shown: Any = None

    def after_reset(self, episode: Any) -> None:
        """Opens the view, of the robot at hand."""
        if self._mode == "human":
            if self._shown is not episode.robot:
                from .._core import view

                self.close()
                self._shown, self._view = episode.robot, view(episode.robot.sim, block=False)
                self._view.__enter__()
            self._view.update()

    def after_step(self, episode: Any) -> None:
        """Shows the state."""
        if self._mode == "human":
            self.after_reset(episode)

    def close(self) -> None:
        """Closes the view."""
        if self._view is not None:
            self._view.__exit__(None, None, None)
            self._view = self._shown = None

    def frame(self, episode: Any) -> np.ndarray:
        """(height, width, 3) of uint8."""
        try:
            from matplotlib.backends.backend_agg import FigureCanvasAgg
            from matplotlib.figure import Figure
            from mpl_toolkits.mplot3d.art3d import Poly3DCollection
        except ImportError:
            raise Error("tool-missing", "render", 'the render mode "rgb_array" needs Matplotlib, which is not installed',
                        "install python3-matplotlib, or pip install sinew[plot]") from None
        if self._axes is None:
            figure = Figure(figsize=_SIZE, dpi=100)
            FigureCanvasAgg(figure)
            self._axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d")
        axes, body = self._axes, episode.robot.body
        axes.clear()
        deformable = len(body.tetrahedra) > 0
        if deformable:
            if self._faces is None:
                self._faces = surface_of(np.asarray(body.tetrahedra))
            triangles = np.asarray(body.positions)[self._faces]
            axes.add_collection3d(Poly3DCollection(triangles, facecolor="#e8a06a", edgecolor="#8a5a34", linewidth=0.2))
        else:
            axes.plot(*axis_of(body).T, color="#c06020", linewidth=6)
        if episode.goal is not None:
            axes.scatter(*episode.goal, color="#2060c0", s=40)
        # A trunk hangs along +z, the way of its gravity; an arm along -z.
        extent, middle = (0.11, 0.10) if deformable else (0.56, 0.0)
        axes.set_xlim(-extent, extent)
        axes.set_ylim(-extent, extent)
        axes.set_zlim(*((middle + extent, middle - extent) if deformable else (middle - extent, middle + extent)))
        axes.set_box_aspect((1.0, 1.0, 1.0), zoom=1.5)
        axes.set_axis_off()
        axes.view_init(elev=12.0, azim=-70.0 if deformable else -90.0)
        axes.figure.canvas.draw()
        return np.asarray(axes.figure.canvas.buffer_rgba())[..., :3].copy()


def axis_of(body: Any) -> np.ndarray:
    """Points (k, 3) m along the axis of an arm."""
    return np.vstack([np.zeros(3), np.asarray(body.arm.endpoints(body.coordinates))])
