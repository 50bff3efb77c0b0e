"""Pictures of environments without a window, and the live view."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ..render import Renderer
from ..render.moment import moment_of
from .task import unknown

__all__ = ["MODES", "Picture"]

MODES = ("rgb_array", "human")
_SIZE = 400, 400  # pixels


def mode_checked(mode: Optional[str]) -> Optional[str]:
    """Returns the render mode. Raises unknown-name."""
    if mode is not None and mode not in MODES:
        raise unknown("render_mode", "render mode", mode, MODES)
    return mode


class Picture:
    """Renders environments in one of the render modes.

    "rgb_array" draws robot and goal with sinew.render when `frame` is called. "human" shows environment 0 in the browser
    (sinew.view) after every step.
    """

    def __init__(self, mode: Optional[str]) -> None:
        self._mode = mode
        self._renderer: Optional[Renderer] = None
        self._view: Any = None
        self._shown: Any = None

    def after_reset(self, episode: Any) -> None:
        """Opens the view of the current robot."""
        if self._mode == "human":
            if self._shown is not episode.robot:
                from .._core import view

                self._close_view()
                self._shown, self._view = episode.robot, view(episode.robot.sim, block=False)
                self._view.__enter__()
            self._view.update()

    def after_step(self, episode: Any) -> None:
        """Shows the present state."""
        if self._mode == "human":
            self.after_reset(episode)

    def close(self) -> None:
        """Closes the view and releases buffers."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
        self._close_view()

    def _close_view(self) -> None:
        if self._view is not None:
            self._view.__exit__(None, None, None)
            self._view = self._shown = None

    def frame(self, episode: Any) -> np.ndarray:
        """(height, width, 3) uint8. Raises tool-missing."""
        sim, task = episode.robot.sim, episode.task
        if self._renderer is None:
            self._renderer = Renderer(sim, _SIZE, task.camera)
            self._renderer.see(task.picture_points(episode.robot))
        # All environments have the same surfaces: one renderer draws them all.
        self._renderer.goals = episode.goal
        return self._renderer.frame(moment_of(sim, self._renderer.outline))
