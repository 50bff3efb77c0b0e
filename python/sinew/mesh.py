"""Volume meshes: read files, create primitive shapes, write VTU, VTK and STL. Lengths in m."""

from __future__ import annotations

import os
from typing import Union

from numpy.typing import ArrayLike

from . import _core
from ._core import Mesh

__all__ = [
    "Mesh",
    "block",
    "capsule",
    "chambered_cylinder",
    "cone",
    "cylinder",
    "hollow_cylinder",
    "read",
    "ribbed_finger",
    "sphere",
    "trunk",
]


def read(
    path: Union[str, os.PathLike[str]],
    unit: Union[str, float, None] = None,
    *,
    several_components: bool = False,
) -> Mesh:
    """Reads and checks a mesh file. The format, legacy VTK, VTU or Gmsh, is detected from the content.

    Parameters
    ----------
    path : path-like
        The file.
    unit : str or float, optional
        Length unit of the file: "mm", or 0.001 (m). By default m; implausibly large meshes are
        then rejected.
    several_components : bool
        Whether the mesh may have several unconnected components.

    Returns
    -------
    Mesh

    Raises
    ------
    Error
        If the file or the mesh is invalid: with location and remedy.
    """
    return _core.read_mesh(os.fspath(path), unit, several_components)


def block(
    size: ArrayLike = (0.1, 0.02, 0.02),
    cells: ArrayLike = (10, 2, 2),
    corner: ArrayLike = (0.0, 0.0, 0.0),
) -> Mesh:
    """A box of hexahedral cells, each split into six tetrahedra; node sets x_min, x_max, ... z_max.

    Parameters
    ----------
    size : (3,) array_like
        m.
    cells : (3,) array_like of int
        Cells along x, y, z.
    corner : (3,) array_like
        Corner with the smallest coordinates, m.
    """
    return _core.mesh_block(size, cells, corner)


def cylinder(
    *, radius: float = 0.01, height: float = 0.1, rings: int = 2, layers: int = 10
) -> Mesh:
    """A cylinder along +z from z = 0 (m); node sets bottom, top, side."""
    return _core.mesh_cylinder(radius=radius, height=height, rings=rings, layers=layers)


def cone(
    *,
    bottom_radius: float = 0.02,
    top_radius: float = 0.01,
    height: float = 0.1,
    rings: int = 2,
    layers: int = 10,
) -> Mesh:
    """A frustum along +z from z = 0 (m); node sets bottom, top, side."""
    return _core.mesh_cone(
        bottom_radius=bottom_radius,
        top_radius=top_radius,
        height=height,
        rings=rings,
        layers=layers,
    )


def hollow_cylinder(
    *,
    inner_radius: float = 0.008,
    outer_radius: float = 0.012,
    height: float = 0.05,
    through: int = 2,
    around: int = 24,
    layers: int = 12,
) -> Mesh:
    """A tube along +z from z = 0 (m); node sets bottom, top, inner, outer."""
    return _core.mesh_hollow_cylinder(
        inner_radius=inner_radius,
        outer_radius=outer_radius,
        height=height,
        through=through,
        around=around,
        layers=layers,
    )


def chambered_cylinder(
    *,
    radius: float = 0.0125,
    height: float = 0.065,
    chamber_radius: float = 0.0037,
    chamber_offset: float = 0.0073,
    chamber_bottom: float = 0.0,
    chamber_top: float = 0.06,
    core: int = 3,
    through: int = 4,
    layers: int = 26,
) -> Mesh:
    """A cylinder along +z from z = 0 (m) with a cylindrical chamber beside its axis, along +x.

    Node sets bottom, top, side and chamber (the wall of the chamber). `core` rings of cells fill the
    cross-section of the chamber above and below it, `through` rings its wall.
    """
    return _core.mesh_chambered_cylinder(
        radius=radius,
        height=height,
        chamber_radius=chamber_radius,
        chamber_offset=chamber_offset,
        chamber_bottom=chamber_bottom,
        chamber_top=chamber_top,
        core=core,
        through=through,
        layers=layers,
    )


def sphere(*, radius: float = 0.015, rings: int = 3) -> Mesh:
    """A ball about the origin (m) of 12 rings^3 tetrahedra; node sets surface, top, bottom.

    The polyhedron has the volume of the ball; its corners are slightly outside of `radius`.
    """
    return _core.mesh_sphere(radius=radius, rings=rings)


def capsule(
    *, radius: float = 0.01, length: float = 0.04, rings: int = 2, layers: int = 4
) -> Mesh:
    """A cylinder of `length` along z (m) with hemispherical ends, centred at the origin.

    Node sets surface, side, top, bottom. The volume is exact, as for sphere().
    """
    return _core.mesh_capsule(radius=radius, length=length, rings=rings, layers=layers)


def ribbed_finger(
    size: ArrayLike = (0.1, 0.02, 0.02),
    *,
    spine: float = 0.006,
    gap: float = 0.005,
    ribs: int = 7,
    rib_cells: int = 2,
    gap_cells: int = 1,
    width_cells: int = 3,
    spine_cells: int = 1,
    rib_rise_cells: int = 2,
) -> Mesh:
    """A cable-driven finger: a spine along +x from the origin, with ribs towards +z.

    Node sets x_min, x_max, ... z_max.

    Parameters
    ----------
    size : (3,) array_like
        Length, width, height of spine and ribs together, m.
    spine : float
        Thickness of the spine, m.
    gap : float
        Gap between two ribs, m; the ribs share the remaining length.
    ribs : int
        Number of ribs, 2 or more, with one at each end.
    rib_cells, gap_cells, width_cells, spine_cells, rib_rise_cells : int
        Cells along a rib, along a gap, across the width, through the spine, from the spine to the top.

    Returns
    -------
    Mesh

    Raises
    ------
    Error
        out-of-range if the gaps leave no room for ribs or the spine fills the height.
    """
    return _core.mesh_ribbed_finger(
        size,
        spine=spine,
        gap=gap,
        ribs=ribs,
        rib_cells=rib_cells,
        gap_cells=gap_cells,
        width_cells=width_cells,
        spine_cells=spine_cells,
        rib_rise_cells=rib_rise_cells,
    )


def trunk(
    *,
    height: float = 0.195,
    bottom_radius: float = 0.020,
    top_radius: float = 0.0085,
    groove_depth: float = 0.25,
    bellows: int = 9,
    layers_per_bellow: int = 4,
    rings: int = 2,
) -> Mesh:
    """A tapered trunk with bellows along +z from z = 0 (m); node sets bottom, top, side.

    `groove_depth` is the depth of a groove divided by the local crest radius, 0 to 0.6.
    """
    return _core.mesh_trunk(
        height=height,
        bottom_radius=bottom_radius,
        top_radius=top_radius,
        groove_depth=groove_depth,
        bellows=bellows,
        layers_per_bellow=layers_per_bellow,
        rings=rings,
    )
