"""Volume meshes: read them, make simple shapes, write VTU, VTK and STL. Lengths in m."""

from __future__ import annotations

import os
from typing import Union

from numpy.typing import ArrayLike

from . import _core
from ._core import Mesh

__all__ = ["Mesh", "block", "cone", "cylinder", "hollow_cylinder", "read", "trunk"]


def read(
    path: Union[str, os.PathLike[str]],
    unit: Union[str, float, None] = None,
    *,
    several_components: bool = False,
) -> Mesh:
    """Reads and checks a mesh: VTK legacy, VTU or Gmsh, told apart by content.

    Parameters
    ----------
    path : path-like
        The file.
    unit : str or float, optional
        What one unit of the file is: "mm", or 0.001 (m). Without it the file is in m, and a robot
        of an unlikely size is refused.
    several_components : bool
        Whether the mesh may consist of unconnected parts.

    Returns
    -------
    Mesh

    Raises
    ------
    Error
        What is wrong with the file or the mesh, with the place and the remedy.
    """
    return _core.read_mesh(os.fspath(path), unit, several_components)


def block(
    size: ArrayLike = (0.1, 0.02, 0.02),
    cells: ArrayLike = (10, 2, 2),
    corner: ArrayLike = (0.0, 0.0, 0.0),
) -> Mesh:
    """A box of cubes of six tetrahedra each; node sets x_min, x_max, ... z_max.

    Parameters
    ----------
    size : (3,) array_like
        m.
    cells : (3,) array_like of int
        Cells along x, y, z.
    corner : (3,) array_like
        The least corner, m.
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

    `groove_depth` is the depth of a groove over the local crest radius, 0 to 0.6.
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
