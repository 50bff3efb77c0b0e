"""Scenes shared by several cases, as dicts."""

from __future__ import annotations

import csv
import pathlib

import numpy as np
import sinew

from .case import REPOSITORY, shared_data

# A fixed ordering: the default picks the fastest one, which may change the last bits from run to run.
SOLVER = {"ordering": "amd"}
TRUNK_FOLDER = REPOSITORY / "examples" / "trunk"
LIMITS = {
    "long": {"tension": {"min": "0 N", "max": "20 N"},
             "displacement": {"min": "-70 mm", "max": "70 mm", "rate": "100 mm/s"}},
    "short": {"tension": {"min": "0 N", "max": "20 N"},
              "displacement": {"min": "-40 mm", "max": "40 mm", "rate": "100 mm/s"}},
}


def write_block(folder: pathlib.Path, size, cells) -> pathlib.Path:
    """A block mesh from the origin as VTU, with sets x_min ... z_max. Lengths in m."""
    path = folder / f"block_{'_'.join(str(c) for c in cells)}.vtu"
    sinew.mesh.block(size, cells).write(str(path))
    return path


def body_scene(mesh: pathlib.Path, *, young: float, poisson: float, model: str = "corotational",
               fixed: list | None = None, density: float | None = None, **world) -> dict:
    """A scene with one body called 'body'; further keys of the scene as keyword arguments."""
    body = {
        "type": "fem",
        "mesh": {"file": str(mesh), "unit": "m"},
        "material": {"model": model, "young_modulus": young, "poisson_ratio": poisson},
    }
    if fixed:
        body["fixed"] = fixed
    if density is not None:
        body["density"] = density
    solver = {**SOLVER, **world.pop("solver", {})}
    return {"sinew": 1, "integrator": "quasi-static", "solver": solver, **world,
            "bodies": {"body": body}}


def _trunk_scene(body: dict, cables: dict, tip_forces: bool, world: dict) -> dict:
    actuators = {
        name: {"type": "cable", "body": "trunk", "points": points,
               "limits": LIMITS[name.split("_")[0]], **more}
        for name, (points, more) in cables.items()
    }
    if tip_forces:
        for axis, direction in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1])):
            actuators[f"tip_{axis}"] = {"type": "force", "body": "trunk",
                                        "point": "0 0 195 mm", "direction": direction}
    solver = {**SOLVER, **world.pop("solver", {})}
    return {"sinew": 1, "time_step": "10 ms", "integrator": "quasi-static", "solver": solver,
            **world, "bodies": {"trunk": body}, "actuators": actuators,
            "effectors": {"tip": {"body": "trunk", "point": "0 0 195 mm"}}}


def own_trunk(*, tip_forces: bool = False, model: str = "corotational", **world) -> dict:
    """The trunk of examples/trunk: built-in mesh, eight cables, effector 'tip', no gravity."""
    body = {
        "type": "fem", "mesh": {"shape": "trunk"}, "mass": "42 g",
        "material": {"model": model, "young_modulus": "450 kPa", "poisson_ratio": 0.45},
        "fixed": [{"box": "-25 -25 0 25 25 20 mm"}],
    }
    cables = {}
    for kind in ("long", "short"):
        for k in range(4):
            with open(TRUNK_FOLDER / f"{kind}_{k}.csv", newline="") as file:
                rows = [[float(x) * 1e-3 for x in row] for row in list(csv.reader(file))[1:]]
            cables[f"{kind}_{k}"] = (rows, {})
    return _trunk_scene(body, cables, tip_forces, world)


def published_trunk(*, tip_forces: bool = False, model: str = "corotational",
                    **world) -> dict | None:
    """The trunk of Coevoet's and later publications, mesh trunk.vtk (SofaDefrost/SofaGym), or None
    if the mesh is not present."""
    mesh = shared_data("trunk", "trunk.vtk")
    if mesh is None:
        return None
    body = {
        "type": "fem", "mesh": {"file": str(mesh), "unit": "mm"},
        "mass": "42 g", "mass_distribution": "even",
        "material": {"model": model, "young_modulus": "450 kPa", "poisson_ratio": 0.45},
        "fixed": [{"box": "-20 -20 0 20 20 20 mm"}],
    }
    along = np.array([0.0, -8.0, 195.0]) / np.hypot(8.0, 195.0)
    cables = {}
    for k in range(4):
        c, s = np.cos(1.57 * k), np.sin(1.57 * k)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        points = [np.array([[0, 10, 0], [-10, 0, 0], [0, -10, 0], [10, 0, 0]], float)[k]]
        for j in range(10):
            for height in (21.0, 27.0):
                points.append(turn @ [0, 10 + 17.5 * j * along[1], height + 17.5 * j * along[2]])
        points = (np.array(points) * 1e-3).tolist()
        more = {"pull": "body", "outside": "nearest"}
        cables[f"long_{k}"] = (points, more)
        cables[f"short_{k}"] = (points[:10], more)
    return _trunk_scene(body, cables, tip_forces, world)
