"""Graphics context of a thread, without a window; kept and reused."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
import threading
from typing import Any, Optional

import numpy as np

from ..errors import Error
from . import shaders

__all__ = ["Context", "context", "current"]

_SAMPLES = 4  # per pixel, for smooth edges
_SHADOW = 256  # pixels along a side of the shadow texture
_KEPT = 8  # number of picture sizes whose buffers are kept

_own = threading.local()


class Context:
    """Programs and buffers shared by all pictures of a thread.

    Attributes
    ----------
    gl : moderngl.Context
    body, plain, mark, plane : moderngl.Program
    """

    def __init__(self) -> None:
        self._owner = os.getpid(), threading.get_ident()
        try:
            import moderngl
        except ImportError:
            raise Error("tool-missing", "render", "pictures need ModernGL, which is not installed",
                        "install python3-moderngl, or pip install sinew[render]") from None
        try:
            self.gl = moderngl.create_context(standalone=True, backend="egl", require=330)
        except Exception as problem:  # the type depends on the driver
            raise Error("tool-missing", "render", f"no graphics context could be created: {problem}",
                        "install libegl1 and libgl1-mesa-dri, whose software renderer needs no graphics card") from None
        self.body, self.plain, self.mark, self.plane = (
            self.gl.program(vertex_shader=vertex.strip(), fragment_shader=fragment.strip())
            for vertex, fragment in (shaders.BODY, shaders.PLAIN, shaders.MARK, shaders.PLANE)
        )
        self.samples = min(_SAMPLES, self.gl.max_samples)
        self._pictures: dict[tuple[int, int], tuple[Any, Any]] = {}
        self._palettes: dict[str, Any] = {}
        self.shadow = self.gl.texture((_SHADOW, _SHADOW), 1)
        self.shadow_frame = self.gl.framebuffer(color_attachments=[self.shadow])
        self.corners = self.gl.buffer(np.array([[-1, -1], [1, -1], [-1, 1], [1, 1]], dtype="f4").tobytes())
        self.patch = self.gl.vertex_array(self.plane, [(self.corners, "2f", "corner")])

    def frames(self, size: tuple[int, int]) -> tuple[Any, Any]:
        """Framebuffers of a size: a multisampled one for drawing and one with single samples for reading. Raises out-of-range."""
        if size not in self._pictures:
            most = self.gl.info["GL_MAX_RENDERBUFFER_SIZE"]
            if max(size) > most:
                raise Error("out-of-range", "size", f"it is {size}", f"give at most {most} pixels a side")
            while len(self._pictures) >= _KEPT:
                for frame in self._pictures.pop(next(iter(self._pictures))):
                    frame.release()
            gl = self.gl
            self._pictures[size] = (
                gl.framebuffer([gl.renderbuffer(size, 4, samples=self.samples)], gl.depth_renderbuffer(size, samples=self.samples)),
                gl.framebuffer([gl.renderbuffer(size, 4)]),
            )
        return self._pictures[size]

    def palette(self, name: str, colours: np.ndarray) -> Any:
        """A colour map (256, 3) uint8 as a texture."""
        if name not in self._palettes:
            self._palettes[name] = self.gl.texture((len(colours), 1), 3, np.ascontiguousarray(colours).tobytes(), alignment=1)
        return self._palettes[name]

    def __del__(self) -> None:
        # Runs at the end of the thread: a context stays in memory as long as it is current in a thread.
        gl = getattr(self, "gl", None)
        if gl is None or sys.is_finalizing() or self._owner != (os.getpid(), threading.get_ident()):
            return
        gl.release()
        with contextlib.suppress(OSError):
            ctypes.CDLL("libEGL.so.1").eglReleaseThread()


def current() -> Optional[Context]:
    """The context of this thread and process, if there is one."""
    return getattr(_own, "context", None) if getattr(_own, "process", None) == os.getpid() else None


def context() -> Context:
    """The context of this thread and process, created at the first call.

    Raises
    ------
    Error
        tool-missing: ModernGL is not installed, or the machine has neither a graphics driver nor Mesa's software renderer.
    """
    # After a fork, the child needs a new context.
    if current() is None:
        _own.context, _own.process = Context(), os.getpid()
    return _own.context
