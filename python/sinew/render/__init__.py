"""Offscreen rendering of pictures and videos, without a display or a browser.

    picture = sinew.render(sim)                              # (480, 640, 3) uint8
    picture = sinew.render(sim, camera="side", field="von_mises_stress")
    sinew.render.video("swing.webp", sim, duration=2.0)      # steps and draws
    sinew.render.video("swing.mp4", "out/swing")             # a recorded run

The module itself is a function: `sinew.render(sim)` is `sinew.render.render(sim)`. docs/rendering.md is the guide.
"""

from __future__ import annotations

import sys
import threading
import types
import weakref
from typing import Any, Optional, Union

import numpy as np

from .camera import Camera
from .recording import Recording
from .renderer import Renderer
from .video import video

__all__ = ["Camera", "Recording", "Renderer", "png", "render", "video"]

_kept = threading.local()


def render(sim: Any, size: tuple[int, int] = (640, 480), camera: Union[Camera, str, None] = None, **options: Any) -> np.ndarray:
    """Renders a picture of the current state of a simulation.

    Parameters
    ----------
    sim : Simulation
    size : (int, int)
        Width and height, pixels.
    camera : Camera or str, optional
        A Camera, or "corner" (default), "front", "side" or "top", which are fitted to the scene. The picture's up is
        opposite to gravity, or +z without gravity.
    **options
        As for Renderer: field, field_range, goals, background, edges, lighting ...

    Returns
    -------
    (height, width, 3) ndarray of uint8
        Red, green and blue, from the upper left on. The same state gives the same bits.

    Raises
    ------
    Error
        tool-missing: ModernGL or a graphics driver is missing. unknown-name: field, camera or colour map. out-of-range,
        wrong-shape, wrong-type, not-finite; simulation-busy.
    """
    # Keeps the last renderer of this thread, without its simulation, because surfaces take longer to create than to draw.
    goals, key = options.pop("goals", None), repr((size, sorted(options.items())))
    last = getattr(_kept, "last", None)
    if last is not None and last[0]() is sim and last[1] == key:
        renderer = last[2]
        renderer.restart(camera)
    else:
        if last is not None:
            last[2].close()
        _kept.last = None
        renderer = Renderer(sim, size, camera, **options)
        _kept.last = weakref.ref(sim), key, renderer
    renderer.sim, renderer.goals = sim, goals
    try:
        return renderer.frame()
    finally:
        renderer.sim = renderer.goals = None


def png(picture: np.ndarray) -> bytes:
    """Encodes a picture (height, width, 3) uint8 as a PNG file. Raises tool-missing without Pillow."""
    import io

    from .video import need_pillow

    file = io.BytesIO()
    need_pillow().fromarray(picture).save(file, "PNG")
    return file.getvalue()


class _Callable(types.ModuleType):
    """A module that can be called like the function of its name."""

    def __call__(self, sim: Any, size: tuple[int, int] = (640, 480), camera: Union[Camera, str, None] = None, **options: Any) -> np.ndarray:
        return render(sim, size, camera, **options)


_Callable.__call__.__doc__ = render.__doc__
sys.modules[__name__].__class__ = _Callable


def _repr_png_(sim: Any) -> Optional[bytes]:
    """PNG of a simulation for a notebook; None (the notebook then shows text) if nothing can be drawn."""
    from ..errors import Error

    try:
        return png(render(sim))
    except Error:
        return None
