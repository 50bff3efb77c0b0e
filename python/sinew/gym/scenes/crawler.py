"""A silicone quadruped with five air chambers: bellows on a sole that fabric keeps from stretching.

Seen from above, with x to the right; every letter is a bellow, a void of one cell within walls of one cell:

    R R   T T   F F      rear_left,  trunk, front_left
          T T
    R R   T T   F F      rear_right, trunk, front_right

The bellows stand on the sole without touching each other. The bellows of a chamber have the same pressure; the tube between
them is not modelled.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from . import hexahedra

__all__ = ["C10", "C20", "CHAMBERS", "FEET", "LIMITS", "cells", "scene"]

CHAMBERS = ("front_left", "front_right", "trunk", "rear_left", "rear_right")
FEET = ("front_left", "front_right", "rear_left", "rear_right")
WALL, AIR, GAP = 1.5e-3, 4e-3, 3e-3  # m along x: a bellow consists of wall, air, wall
ACROSS = (2e-3, 11e-3, 2e-3, 8e-3, 2e-3, 11e-3, 2e-3)  # m along y: a leg, the slot between the legs, a leg
UPWARDS = (2e-3, 10e-3, 2e-3)  # m: sole, air, roof
BELLOWS = 2  # per leg, and of the trunk
LIMITS = {"leg": (60e3, 300e3), "trunk": (40e3, 200e3)}  # Pa, Pa/s: maximum pressure, maximum rate
C10, C20 = 44e3, 16e3  # Pa, Yeoh's law: 6 C10 is Young's modulus of Dragon Skin 10, 264 kPa; C20 is assumed
TIME_STEP = 0.04  # s


def cells() -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Grid of the mesh.

    Returns
    -------
    solid : (nx, 7, 3) bool
    chamber : (nx, 7, 3) int
        Number of the chamber that a void belongs to, from 1 in the order of CHAMBERS; otherwise 0.
    edges : three arrays of m
        Positions of the grid planes. The body is centred in x and y and stands on z = 0.
    """
    count = 3 * BELLOWS
    along = np.tile([WALL, AIR, WALL, GAP], count)[:-1]
    solid = np.ones((len(along), len(ACROSS), len(UPWARDS)), dtype=bool)
    solid[3::4, :, 1:] = False  # only the sole lies between the bellows
    chamber = np.zeros(solid.shape, dtype=int)
    rear, trunk, front = (slice(4 * BELLOWS * part + 1, 4 * BELLOWS * (part + 1), 4) for part in range(3))
    for number, (part, lanes) in enumerate(((front, slice(5, 6)), (front, slice(1, 2)), (trunk, slice(1, 6)),
                                            (rear, slice(5, 6)), (rear, slice(1, 2))), start=1):  # fmt: skip
        chamber[part, lanes, 1] = number
    solid[chamber > 0] = False
    solid[: 4 * BELLOWS, 3] = solid[-4 * BELLOWS :, 3] = False  # the slots between the legs
    edges = [np.concatenate([[0.0], np.cumsum(widths)]) for widths in (along, ACROSS, UPWARDS)]
    for axis in (0, 1):
        edges[axis] -= 0.5 * edges[axis][-1]
    return solid, chamber, edges


def scene(folder: Path, friction: float) -> dict[str, Any]:
    """The scene; its mesh is written to the folder.

    The body is `crawler`, the actuators are CHAMBERS, and the contacts with the floor are FEET and `belly`, below the trunk.

    Parameters
    ----------
    folder : Path
        It must exist until the scene is loaded.
    friction : float
        Coefficient of all contacts.
    """
    solid, chamber, edges = cells()
    nodes, cubes, places = hexahedra.voxels(solid, edges)
    wall = np.zeros(np.array(solid.shape) + 1, dtype=int)  # number of the chamber whose wall a node belongs to, or 0
    for corner in np.ndindex(2, 2, 2):
        i, j, k = (np.argwhere(chamber) + corner).T
        wall[i, j, k] = chamber[chamber > 0]
    hexahedra.write(folder / "crawler.vtk", nodes, cubes, {"chamber": wall[tuple(places.T)]})
    leg, last = 4 * BELLOWS - 1, len(edges[0]) - 1  # x planes: front of a rear leg, front of the robot

    def touching(first: int, end: int, lanes: tuple[int, ...]) -> list[list[float]]:
        return [[edges[0][i], edges[1][j], 0.0] for i in (first, (first + end) // 2, end) for j in lanes]

    left, right = (4, 7), (0, 3)
    points = {"front_left": touching(last - leg, last, left), "front_right": touching(last - leg, last, right),
              "rear_left": touching(0, leg, left), "rear_right": touching(0, leg, right),
              "belly": touching(leg + 2, last - leg - 2, right + left)}  # fmt: skip
    bounds = {name: LIMITS["trunk" if name == "trunk" else "leg"] for name in CHAMBERS}
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": TIME_STEP,
        "solver": {"tolerance": 1e-5},  # with 1e-8, steps take longer and the gait covers 1 % less distance
        "bodies": {"crawler": {
            "type": "fem", "mesh": {"file": str(folder / "crawler.vtk")}, "density": "1070 kg/m^3",
            "material": {"model": "yeoh", "c10": C10, "c20": C20, "poisson_ratio": 0.49,
                         "viscosity": [{"relative_modulus": 0.2, "relaxation_time": "50 ms"}]},
        }},
        "membranes": {"fabric": {
            "body": "crawler", "surface": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
            "thickness": "0.1 mm", "young_modulus": "100 MPa", "poisson_ratio": 0.3,
        }},
        "contacts": {name: {"body": "crawler", "surface": {"plane": {}}, "points": at, "friction": friction}
                     for name, at in points.items()},
        "actuators": {name: {
            "type": "chamber", "body": "crawler", "surface": {"set": f"chamber:{k}"},
            "limits": {"pressure": {"min": 0.0, "max": bounds[name][0], "rate": bounds[name][1]}}, "command": {"pressure": 0.0},
        } for k, name in enumerate(CHAMBERS, start=1)},
    }  # fmt: skip
