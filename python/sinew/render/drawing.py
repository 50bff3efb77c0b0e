"""Draws triangles, rods, balls and planes into an array of pixels."""

from __future__ import annotations

import dataclasses
from typing import Any, Optional

import numpy as np

from .camera import Camera, axes_of_view
from .context import Context
from .marks import Marks

__all__ = ["DrawList", "Patch", "Triangles", "draw"]

# Direction towards the light source: components to the right, to the front and up, see axes_of_view().
_SUN = np.array([-0.38, 0.42, 0.82])
_SUN = _SUN / np.linalg.norm(_SUN)
_HIDDEN = 0.38  # opacity of marks behind or inside bodies
_EDGE = (0.10, 0.12, 0.15, 0.45)
_INK, _TINT = (0.35, 0.40, 0.46), (0.80, 0.83, 0.86)
_SHADE = 0.34  # opacity of the darkest shadow


class Triangles:
    """Surfaces of all bodies on the graphics card.

    Parameters
    ----------
    context : Context
    triangles, edges : (t, 3) and (e, 2) ndarrays of int
        Vertices.
    colours : (v, 3) ndarray
        sRGB, 0 to 1, for vertices without a value.
    """

    def __init__(self, context: Context, triangles: np.ndarray, edges: np.ndarray, colours: np.ndarray) -> None:
        gl, count = context.gl, len(colours)
        self.count = len(triangles)
        self._moving = gl.buffer(reserve=max(28 * count, 28), dynamic=True)
        self._data = np.zeros((count, 7), dtype="f4")
        still = gl.buffer(np.ascontiguousarray(colours, dtype="f4").tobytes() or b"\0" * 12)
        sides = gl.buffer(np.ascontiguousarray(triangles, dtype="i4").tobytes() or b"\0" * 12)
        lines = gl.buffer(np.ascontiguousarray(edges, dtype="i4").tobytes() or b"\0" * 8)
        moving = (self._moving, "3f 3f 1f", "position", "normal", "value")
        place = (self._moving, "3f 4x4", "position")
        self.faces = gl.vertex_array(context.body, [moving, (still, "3f", "colour")], sides)
        self.outline = gl.vertex_array(context.plain, [place], sides)
        self.edges = gl.vertex_array(context.plain, [place], lines)
        self._buffers = [self._moving, still, sides, lines]

    def write(self, points: np.ndarray, normals: np.ndarray, values: np.ndarray) -> None:
        """Uploads positions (v, 3) m, unit normals (v, 3), and values (v,): 0 to 1 in the colour map, or -1 for none."""
        self._data[:, :3], self._data[:, 3:6], self._data[:, 6] = points, normals, values
        if len(self._data):
            self._moving.write(self._data.tobytes())

    @property
    def points(self) -> np.ndarray:
        """(v, 3) float32, m: the last uploaded positions."""
        return self._data[:, :3]

    def release(self) -> None:
        """Frees the memory of the graphics card."""
        for part in (self.faces, self.outline, self.edges, *self._buffers):
            part.release()


@dataclasses.dataclass
class Patch:
    """Visible part of a plane.

    Attributes
    ----------
    origin, normal : (3,) ndarrays
        A crossing of grid lines, m; unit normal.
    middle : (3,) ndarray
        Centre of the patch on the plane, m.
    reach : float
        Half of its side, m.
    cell : float
        Grid spacing, m.
    solid : float
        Opacity of the plane itself.
    first_axis : (3,) ndarray
        Unit vector along grid lines.
    """

    origin: np.ndarray
    normal: np.ndarray
    middle: np.ndarray
    reach: float
    cell: float
    solid: float
    first_axis: np.ndarray


@dataclasses.dataclass
class DrawList:
    """Content of a picture.

    Attributes
    ----------
    background : (3,) sRGB
    up : (3,) ndarray
    triangles : Triangles
    palette : moderngl.Texture
        Colour map of the values.
    solids, marks : Marks
        Marks are faintly visible through bodies.
    patches : list of Patch
    lit, edges : bool
        Whether to use lighting instead of plain colours; whether to draw the edges of the mesh.
    """

    background: tuple[float, float, float]
    up: np.ndarray
    triangles: Triangles
    palette: Any
    solids: Marks
    marks: Marks
    patches: list[Patch]
    lit: bool = True
    edges: bool = False


def draw(context: Context, draw_list: DrawList, camera: Camera, size: tuple[int, int]) -> np.ndarray:
    """Draws a picture (height, width, 3) uint8."""
    import moderngl

    gl = context.gl
    target, single = context.frames(size)
    solids, marks = _Uploaded(context, draw_list.solids), _Uploaded(context, draw_list.marks)
    points = [draw_list.triangles.points, solids.points, marks.points]
    matrix = _bytes(camera.matrix(size, *_depths(points, draw_list.patches, camera)))
    sun = _SUN @ axes_of_view(draw_list.up)
    for program in (context.body, context.mark):
        program["eye"].value, program["up"].value, program["sun"].value = camera.position, tuple(draw_list.up), tuple(sun)
    for program in (context.body, context.mark, context.plane):
        program["matrix"].write(matrix)
    shadow = _cast_shadow(context, draw_list.triangles, solids, sun) if draw_list.patches else None
    target.use()
    target.clear(*draw_list.background, 1.0)
    gl.enable_only(moderngl.DEPTH_TEST)
    gl.depth_func = "<="
    gl.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
    if draw_list.triangles.count:
        draw_list.palette.use(0)
        context.body["palette"].value, context.body["lit"].value = 0, draw_list.lit
        draw_list.triangles.faces.render()
    solids.render(1.0)
    target.depth_mask = False
    gl.enable(moderngl.BLEND)
    if draw_list.edges and draw_list.triangles.count:
        context.plain["matrix"].write(matrix)
        context.plain["nearer"].value, context.plain["colour"].value = 2e-4, _EDGE
        draw_list.triangles.edges.render(moderngl.LINES)
    for patch in draw_list.patches:
        _draw_patch(context, patch, camera, shadow)
    gl.enable(moderngl.CULL_FACE)
    gl.depth_func = ">"
    marks.render(_HIDDEN)
    gl.depth_func = "<="
    gl.disable(moderngl.BLEND)
    target.depth_mask = True
    marks.render(1.0)
    solids.release()
    marks.release()
    gl.copy_framebuffer(single, target)
    pixels = np.frombuffer(single.read(components=3, alignment=1), dtype=np.uint8)
    return pixels.reshape(size[1], size[0], 3)[::-1].copy()


def _depths(points: list[np.ndarray], patches: list[Patch], camera: Camera) -> tuple[float, float]:
    """Clipping distances along the line of sight that contain everything."""
    back = camera.axes()[2]
    depths = [-(part - np.array(camera.position, dtype="f4")) @ back for part in points if len(part)]
    depths += [-(patch.middle - camera.position) @ back + patch.reach * np.array([-1.5, 1.5]) for patch in patches]
    if not depths:
        return 0.01, 1.0
    near, far = min(part.min() for part in depths), max(part.max() for part in depths)
    far = 1.1 * max(far, 1e-6)
    return max(0.9 * near, 2e-3 * far), far


def _cast_shadow(context: Context, triangles: Triangles, solids: _Uploaded, sun: np.ndarray) -> Optional[bytes]:
    """Draws bodies and solids as seen from the light source; returns the matrix from the world to positions on that texture."""
    points = np.concatenate([triangles.points, solids.points])
    if len(points) == 0:
        return None
    first = np.cross(sun, np.eye(3)[np.argmin(np.abs(sun))])
    axes = np.stack([first / np.linalg.norm(first), np.cross(sun, first / np.linalg.norm(first)), sun])
    seen = points @ axes[:2].T.astype("f4")
    low, high = seen.min(axis=0), seen.max(axis=0)
    half = 0.56 * float((high - low).max()) + 1e-9
    world = np.eye(4)
    world[:2, :3] = axes[:2] / half
    world[:2, 3] = -0.5 * (low + high) / half
    world[2, :3] = 0.0
    context.shadow_frame.use()
    context.shadow_frame.clear(0.0, 0.0, 0.0, 0.0)
    context.gl.enable_only(0)
    context.plain["matrix"].write(_bytes(world))
    context.plain["nearer"].value, context.plain["colour"].value = 0.0, (1.0, 1.0, 1.0, 1.0)
    if triangles.count:
        triangles.outline.render()
    solids.render_outline()
    context.shadow.build_mipmaps()
    place = np.eye(4)
    place[0, 0] = place[1, 1] = place[0, 3] = place[1, 3] = 0.5
    return _bytes(place @ world)


def _draw_patch(context: Context, patch: Patch, camera: Camera, shadow: Optional[bytes]) -> None:
    import moderngl

    plane = context.plane
    second = np.cross(patch.normal, patch.first_axis)
    above = float((np.array(camera.position) - patch.origin) @ patch.normal) > 0.0
    context.shadow.use(1)
    plane["shadow"].value = 1
    plane["shadow_matrix"].write(shadow if shadow is not None else _bytes(np.eye(4)))
    for name, value in (("middle", patch.middle), ("origin", patch.origin), ("first_axis", patch.first_axis), ("second_axis", second)):
        plane[name].value = tuple(float(x) for x in value)
    plane["reach"].value, plane["cell"].value, plane["solid"].value = patch.reach, patch.cell, patch.solid
    # Seen from below, a floor is translucent.
    plane["visible"].value, plane["shade"].value = (1.0 if above else 0.3), (_SHADE if above and shadow is not None else 0.0)
    plane["ink"].value, plane["tint"].value = _INK, _TINT
    context.patch.render(moderngl.TRIANGLE_STRIP)


class _Uploaded:
    """Marks on the graphics card while a frame is drawn."""

    def __init__(self, context: Context, marks: Marks) -> None:
        self._program, self._parts = context.mark, []
        self.points = marks.vertices[:, :3]
        if len(self.points):
            vertices = context.gl.buffer(marks.vertices.tobytes())
            triangles = context.gl.buffer(marks.triangles.tobytes())
            array = context.gl.vertex_array(context.mark, [(vertices, "3f 3f 3f", "position", "normal", "colour")], triangles)
            outline = context.gl.vertex_array(context.plain, [(vertices, "3f 6x4", "position")], triangles)
            self._parts = [array, outline, vertices, triangles]

    def render(self, opacity: float) -> None:
        if self._parts:
            self._program["opacity"].value = opacity
            self._parts[0].render()

    def render_outline(self) -> None:
        if self._parts:
            self._parts[1].render()

    def release(self) -> None:
        for part in self._parts:
            part.release()


def _bytes(matrix: np.ndarray) -> bytes:
    """Bytes of a matrix in GLSL's column-major order."""
    return np.ascontiguousarray(matrix.T, dtype="f4").tobytes()
