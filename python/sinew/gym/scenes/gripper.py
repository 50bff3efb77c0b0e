"""Three soft fingers with one cable each, and a soft cup: examples/grasp/grasp.py on a coarser mesh."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from . import hexahedra

__all__ = ["CUP_FLOOR", "CUP_HEIGHT", "CUP_MODULUS", "FINGERS", "scene", "write_cup"]

FINGERS = 3
CUP_RADII, CUP_HEIGHT, CUP_WALL, CUP_FLOOR = (18e-3, 35e-3), 78.6e-3, 4e-3, 5e-3  # m; outer radii at the floor and at the rim
CUP_MODULUS = 1e6  # Pa, Young's modulus
QUARTER, LAYERS = 4, 5  # cells along a quarter of the cup's circle, layers from its floor to its rim
APART, ABOVE, HELD = 50e-3, 220e-3, 20e-3  # m: distance of the feet from the axis, their height above the table, clamped length of a finger


def write_cup(path: Path) -> None:
    """Writes the cup, with one hexahedron through its floor and one through its wall, standing on z = 0 around the z axis."""
    hexahedra.write(path, *hexahedra.cup(QUARTER, LAYERS, CUP_RADII, CUP_HEIGHT, CUP_WALL, CUP_FLOOR))


def scene(folder: Path, friction: float) -> dict[str, Any]:
    """The scene; the mesh of the cup is written to the folder.

    Bodies: cup, and finger_0 to finger_2 around it, 120 degrees apart, with cable_0 to cable_2 on their inner sides.
    Contacts: table, and grip_0 to grip_2 between a finger (first) and the cup.

    Parameters
    ----------
    folder : Path
        It must exist until the scene is loaded.
    friction : float
        Coefficient of all contacts.
    """
    write_cup(folder / "cup.vtk")
    bodies: dict[str, Any] = {
        "cup": {
            "type": "fem", "mesh": {"file": str(folder / "cup.vtk")}, "density": "1070 kg/m^3",
            "material": {"model": "neo-hookean", "young_modulus": CUP_MODULUS, "poisson_ratio": 0.45},
        }
    }  # fmt: skip
    contacts: dict[str, Any] = {"table": {"body": "cup", "surface": {"plane": {}}, "friction": friction}}
    cables = {}
    depth = np.append(0.0, np.linspace(21e-3, 190e-3, 20))  # m, cable points below the foot
    inwards = np.interp(depth, depth[[1, -1]], [10e-3, 3.5e-3])  # m, distance of the cable from the finger's axis
    for k in range(FINGERS):
        turn = 2.0 * np.pi * k / FINGERS
        outwards = np.array([np.cos(turn), np.sin(turn), 0.0])
        route = (APART - inwards)[:, None] * outwards + (ABOVE - depth)[:, None] * [0.0, 0.0, 1.0]
        bodies[f"finger_{k}"] = {
            "type": "fem", "mesh": {"shape": "trunk", "element_size": "10 mm"}, "element": "tet4-patch", "mass": "42 g",
            "material": {"model": "neo-hookean", "young_modulus": "600 kPa", "poisson_ratio": 0.45},
            "pose": {"position": (APART * outwards + [0.0, 0.0, ABOVE]).tolist(),
                     "rotation": [np.pi * np.cos(turn / 2), np.pi * np.sin(turn / 2), 0.0]},  # upside down, then about z
            "fixed": {"box": [-0.2, -0.2, ABOVE - HELD - 1e-6, 0.2, 0.2, ABOVE + 1e-6]},
        }  # fmt: skip
        cables[f"cable_{k}"] = {
            "type": "cable", "body": f"finger_{k}", "pull": "body", "points": route.tolist(),
            "limits": {"displacement": {"min": "0 mm", "max": "10 mm", "rate": "20 mm/s"}, "tension": {"min": "0 N"}},
            "command": {"displacement": "0 mm"},
        }  # fmt: skip
        contacts[f"grip_{k}"] = {"between": [f"finger_{k}", "cup"], "friction": friction}
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": "20 ms",
        "bodies": bodies, "actuators": cables, "contacts": contacts,
    }  # fmt: skip
