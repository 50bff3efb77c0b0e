"""Renders a series of pictures of a robot."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Mapping
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ..errors import Error
from . import colours
from .arguments import checked_range, checked_size, goal_points
from .camera import Camera, axes_of_view, camera_of
from .context import context, current
from .drawing import DrawList, Patch, Triangles, draw
from .geometry import Skin, boundary_of
from .marks import Marks
from .moment import Moment, moment_of
from .scene import Surface, outline_of

__all__ = ["Renderer"]

_BODIES = tuple(colours.parse(c, "") for c in ("#d9a066", "#7fa6c9", "#9cb380"))  # also distinguishable by lightness
_PLAIN = colours.parse("#b4bac2", "")  # colour of bodies without the displayed field
_TAUT, _SLACK, _SPRING = (colours.parse(c, "") for c in ("#0072b2", "#8a8f98", "#6b7480"))
_GOAL, _EFFECTOR, _FORCE, _SURFACE = (colours.parse(c, "") for c in ("#d55e00", "#262b33", "#cc3311", "#8796a5"))
# Sizes relative to the scene.
_CABLE, _BALL, _SHAFT, _ARROW = 0.0045, 0.011, 0.0042, 0.22
_FAR = 10.0  # in sizes of the robot: planes farther away than this may lie outside the picture
_MIN_FORCE = 0.01  # forces below this fraction of the largest are not drawn


class Renderer:
    """Renders a simulation repeatedly; surfaces, camera and buffers are created once.

    The camera is fitted to the first picture and then fixed. The scale of force arrows and the colour range grow with the
    largest values so far.

    Parameters
    ----------
    sim : Simulation
    size : (int, int)
        Width and height, pixels.
    camera : Camera or str, optional
        A Camera, or "corner" (default), "front", "side" or "top", which are fitted to the scene. The picture's up is
        against gravity, +z without gravity.
    field : str, optional
        Field to colour the bodies by: "displacement", or a name in sinew.fields.FIELDS.
    field_range : (float, float), optional
        Range of the colour map, in the unit of the field. By default the range of the values so far.
    colour_map : str
        "viridis" or "cividis".
    colour_bar : bool
        Whether to draw a colour bar.
    goals : mapping or array_like, optional
        Points to mark in addition to the controller's targets: (n, 3) m, or by name.
    background : str or (3,) array_like
        "#rrggbb", or red, green and blue from 0 to 1.
    floor : bool
        Whether to draw a grid below a robot without a contact plane.
    lighting : bool
        False: unlit colours, exactly as in the colour bar.
    edges : bool
        Whether to draw the edges of the mesh.
    cables, contacts, effectors : bool
        Whether to draw them; `contacts` are the contact forces on bodies, and the contact surfaces.

    Attributes
    ----------
    camera : Camera or str or None
        As given; may be assigned. After the first picture, a Camera.

    Raises
    ------
    Error
        tool-missing, unknown-name, out-of-range, wrong-type, wrong-shape.

    Examples
    --------
    >>> with sinew.render.Renderer(sim, field="max_stretch") as renderer:
    ...     for _ in range(100):
    ...         sim.step()
    ...         picture = renderer.frame()        # (480, 640, 3) uint8
    """

    def __init__(
        self,
        sim: Any,
        size: tuple[int, int] = (640, 480),
        camera: Union[Camera, str, None] = None,
        *,
        field: Optional[str] = None,
        field_range: Optional[tuple[float, float]] = None,
        colour_map: str = "viridis",
        colour_bar: bool = True,
        goals: Union[Mapping[str, ArrayLike], ArrayLike, None] = None,
        background: Union[str, ArrayLike] = "#eef1f4",
        floor: bool = True,
        lighting: bool = True,
        edges: bool = False,
        cables: bool = True,
        contacts: bool = True,
        effectors: bool = True,
    ) -> None:
        self.sim, self.camera, self.size = sim, camera, checked_size(size)
        self.field, self._range = field, checked_range(field_range)
        self._fixed_range = field_range is not None
        if field is not None:
            colours.unit_of(field)  # raises unknown-name
        self.colour_map, self._bar = colour_map, colour_bar
        self._palette = colours.table(colour_map)
        self.goals = goals
        self._background = colours.parse(background, "background")
        self._floor, self._lit, self._edges = floor, lighting, edges
        self._cables, self._contacts, self._effectors = cables, contacts, effectors
        self.outline = outline_of(sim)
        self._largest_force = 0.0
        self._context = context()
        self._build()

    def _build(self) -> None:
        bodies = self.sim.bodies
        self._skins = {name: Skin(*boundary_of(body), body.rest_positions) for name, body in bodies.items()}
        counts = [len(skin.nodes) for skin in self._skins.values()]
        starts = np.concatenate([[0], np.cumsum(counts)]).astype(int)
        self._parts = {name: slice(a, b) for name, a, b in zip(self._skins, starts[:-1], starts[1:])}
        paint = np.zeros((starts[-1], 3))
        for k, (name, part) in enumerate(self._parts.items()):
            paint[part] = _BODIES[k % len(_BODIES)] if self.field is None else _PLAIN
        shifted = [(skin.triangles + a, skin.edges + a) for skin, a in zip(self._skins.values(), starts)]
        triangles, edges = (np.concatenate([np.zeros((0, n), dtype=int), *part]) for n, part in zip((3, 2), zip(*shifted)))
        self._triangles = Triangles(self._context, triangles, edges, paint)
        rest = np.concatenate([np.asarray(body.rest_positions) for body in bodies.values()])
        self._scale = max(float(np.linalg.norm(np.ptp(rest, axis=0))), 1e-6)
        self._axes = axes_of_view(self.outline.up)
        self._rest = rest
        self._ground, self._reach = None, 0.0

    def frame(self, moment: Optional[Moment] = None) -> np.ndarray:
        """Picture of the present state of the simulation, or of a moment of a recorded run: (height, width, 3) uint8.

        Raises
        ------
        Error
            wrong-shape, not-finite for goals; closed; simulation-busy.
        """
        if self._triangles is None:
            raise Error("closed", "Renderer.frame", "the renderer is closed", "make a new one")
        # Contexts belong to threads: rebuild the buffers if another thread draws now.
        if context() is not self._context:
            self._context = context()
            self._build()
        if moment is None:
            moment = moment_of(self.sim, self.outline, self.field)
        low, high = self._write(moment)
        solids, marks = Marks(), Marks()
        self._add_marks(moment, marks)
        surfaces = self._surfaces(moment)
        for surface in surfaces:
            _add_solid(solids, surface)
        if self._ground is None or not isinstance(self.camera, Camera):
            self.see(self.extent(moment))
        draw_list = DrawList(self._background, self.outline.up, self._triangles, self._context.palette(self.colour_map, self._palette),
                      solids, marks, self._patches(surfaces), self._lit, self._edges)
        picture = draw(self._context, draw_list, self.camera, self.size)
        if self.field is not None and self._bar and moment.values:
            colours.put_bar(picture, str(self.field), low, high, self.colour_map, self._background)
        return picture

    def see(self, points: ArrayLike) -> None:
        """Fits the camera to points (n, 3) m, such as all positions that a robot will reach, unless it is a Camera already.

        The floor grid lies below these points and below the robot at rest.
        """
        points = np.asarray(points, dtype=float)
        left = min(0.3, 0.2 * self.size[1] / self.size[0]) if self._bar and self.field is not None else 0.0
        self.camera = camera_of(self.camera, points, self.outline.up, self.size, left)
        self._reach = 1.5 * max(self._scale, 0.6 * float(np.linalg.norm(np.ptp(points, axis=0))))
        # Height of the floor grid, whose lines pass through the origin.
        self._ground = min(float((part @ self.outline.up).min()) for part in (points, self._rest)) * self.outline.up

    def extent(self, moment: Moment) -> np.ndarray:
        """(n, 3) m: points of everything drawn at a moment, for see(); a plane contributes its point nearest to the robot."""
        solids = Marks()
        for surface in self._surfaces(moment):
            _add_solid(solids, surface)
        parts = [*moment.positions.values(), *moment.effectors.values(), *moment.goals.values(), *goal_points(self.goals)]
        parts += [solids.vertices[:, :3], *(moment.cables.values() if self._cables else ())]
        middle = np.concatenate(list(moment.positions.values())).mean(axis=0)
        for plane in (surface for surface in self._surfaces(moment) if surface.kind == "plane"):
            height = float((middle - plane.points[0]) @ plane.normal)
            parts.append(middle - height * plane.normal if height < _FAR * self._scale else middle)
        everything = np.concatenate([np.atleast_2d(part) for part in parts])
        return everything[np.isfinite(everything).all(axis=1)]

    def restart(self, camera: Union[Camera, str, None] = None) -> None:
        """Resets the camera, the scale of forces and the colour range to their initial state."""
        self.camera, self._largest_force, self._ground = camera, 0.0, None
        if not self._fixed_range:
            self._range = None

    def widen(self, moments: Iterable[Moment]) -> None:
        """Widens the colour range to the values of moments, unless it was given."""
        for values in (v for moment in moments for v in moment.values.values() if len(v) and not self._fixed_range):
            low, high = float(values.min()), float(values.max())
            self._range = (low, high) if self._range is None else (min(self._range[0], low), max(self._range[1], high))

    def close(self) -> None:
        """Releases the graphics memory. May be called repeatedly."""
        # Buffers in the context of another thread are freed with that thread.
        if getattr(self, "_triangles", None) is not None and current() is self._context:
            self._triangles.release()
        self._triangles = None

    def __del__(self) -> None:
        if not sys.is_finalizing():
            self.close()

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def _write(self, moment: Moment) -> tuple[float, float]:
        """Moves the surfaces and updates the colour range."""
        self.widen([moment])
        low, high = self._range or (0.0, 0.0)
        count = self._triangles.points.shape[0]
        points, normals, amounts = np.zeros((count, 3), "f4"), np.zeros((count, 3), "f4"), np.full(count, -1.0, "f4")
        for name, part in self._parts.items():
            skin = self._skins[name]
            points[part], normals[part] = skin.shape(moment.positions[name])
            if name in moment.values:
                amounts[part] = np.clip((moment.values[name][skin.nodes] - low) / (high - low if high > low else 1.0), 0.0, 1.0)
        self._triangles.write(points, normals, amounts)
        return low, high

    def _add_marks(self, moment: Moment, marks: Marks) -> None:
        size = self._scale
        springs = {name for name, part in self.sim.actuators.items() if part.type == "spring"}
        for name, points in moment.cables.items() if self._cables else ():
            marks.tube(points, _CABLE * size, _SPRING if name in springs else _SLACK if name in moment.slack else _TAUT)
        if self._effectors:
            for point in moment.effectors.values():
                marks.ball(point[None], _BALL * size, _EFFECTOR)
            for point in [*moment.goals.values(), *goal_points(self.goals)]:
                marks.ball(point[None], 1.25 * _BALL * size, _GOAL)
        if self._contacts and len(moment.forces):
            self._add_forces(moment, marks)

    def _add_forces(self, moment: Moment, marks: Marks) -> None:
        lengths = np.linalg.norm(moment.forces, axis=1)
        self._largest_force = max(self._largest_force, float(lengths.max()))
        drawn = lengths > max(_MIN_FORCE * self._largest_force, 1e-12)
        if not drawn.any():
            return
        arrows = moment.forces[drawn] * (_ARROW * self._scale / self._largest_force)
        marks.arrows(moment.touching[drawn], arrows, _SHAFT * self._scale, _FORCE)

    def _surfaces(self, moment: Moment) -> list[Surface]:
        found = self.outline.surfaces.items() if self._contacts else ()
        return [surface.moved(moment.poses[name]) for name, surface in found]

    def _patches(self, surfaces: list[Surface]) -> list[Patch]:
        planes = [surface for surface in surfaces if surface.kind == "plane"]
        # Several contacts often share one floor plane.
        found: list[Patch] = []
        for plane in planes:
            point, normal = plane.points[0], plane.normal
            same = [np.allclose(normal, p.normal) and abs((point - p.origin) @ normal) < 1e-6 * self._scale for p in found]
            if not any(same):
                found.append(self._patch(plane.points[0], plane.normal, 0.55))
        if not found and self._floor:
            found.append(self._patch(self._ground, self.outline.up, 0.0))
        return found

    def _patch(self, origin: np.ndarray, normal: np.ndarray, solid: float) -> Patch:
        about = self._reach / 12.0
        cell = 10.0 ** math.floor(math.log10(about))
        cell *= next(k for k in (5.0, 2.0, 1.0) if k * cell <= about)
        first = self._axes[0] if abs(normal @ self._axes[0]) < 0.9 else self._axes[2]
        first = first - normal * (first @ normal)
        points = self._triangles.points
        middle = points.mean(axis=0).astype(float) if len(points) else self._ground
        middle = middle - normal * ((middle - origin) @ normal)
        return Patch(origin, normal, middle, self._reach, cell, solid, first / np.linalg.norm(first))


def _add_solid(solids: Marks, surface: Surface) -> None:
    """Adds a ball or a capsule; planes are patches."""
    if surface.kind == "plane":
        return
    solids.ball(surface.points, surface.radius, _SURFACE)
    if len(surface.points) > 1:
        solids.rod(surface.points[:1], surface.points[1:], (surface.radius, surface.radius), _SURFACE)
