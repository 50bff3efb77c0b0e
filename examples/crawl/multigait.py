#!/usr/bin/env python3
"""The published multigait robot crawls: a silicone quadruped with five air chambers and a stiffer bottom layer.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/crawl/multigait.py MESHES [--out FOLDER] [--friction MU ...] [--zones MM]

The folder MESHES contains multigait.vtk and cavity_*.stl (mm), which are not part of Sinew; docs/locomotion.md gives their
source. The chambers of the rear legs, the centre and the front legs fill one after the other and empty in the same order.
Writes multigait.png to FOLDER and, for each coefficient of friction, a CSV of the motion. A cycle takes some minutes on one
core. 75 points of the sole can touch the floor; with --zones, all of its 2592 nodes can, aggregated in zones of this size (mm),
which takes longer.
"""

import argparse
import tempfile
from pathlib import Path

import meshio
import numpy as np
import sinew
from crawl import pressure

CHAMBERS = {"rear_left": 0, "rear_right": 0, "center": 1, "front_left": 2, "front_right": 2}  # index in the gait
PRESSURE, PERIOD, STEP = 26e3, 3.0, 0.02  # Pa, s, s
SPACING = 10.0  # mm, between the points of the sole that can touch the floor
FRICTION = (0.2, 0.5, 0.7, 1.0)


def sole_points(nodes):
    """(n, 3) mm: for each grid point of SPACING, the nearest node of the flat bottom, including the outermost ones."""
    bottom = nodes[np.abs(nodes[:, 2]) < 0.1]
    squares = {}
    for node in bottom:
        square = tuple(np.round(node[:2] / SPACING).astype(int))
        off = np.linalg.norm(node[:2] - SPACING * np.array(square))
        if square not in squares or off < squares[square][0]:
            squares[square] = (off, node)
    return np.array([node for _, node in squares.values()])


def floor(nodes, friction, zones=None):
    """Contact of the sole with the floor: of selected points (nodes in mm), or of all nodes, in zones of this size (mm)."""
    contact = {"body": "robot", "surface": {"plane": {}}, "friction": friction}
    if zones is None:
        return {**contact, "points": (1e-3 * sole_points(nodes)).tolist()}
    sole = {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1], "within": "0.1 mm"}}
    return {**contact, "nodes": sole, "aggregate": 1e-3 * zones}


def scene(data, folder, friction, zones=None):
    """The scene as a dict. Millimetres of the files become metres, with the middle of the robot at the origin."""
    mesh = meshio.read(data / "multigait.vtk")
    cells = mesh.cells_dict["tetra"]
    used, cells = np.unique(cells, return_inverse=True)
    middle = np.append(mesh.points[:, :2].mean(axis=0), 0.0)
    nodes = mesh.points[used] - middle
    meshio.write(folder / "robot.vtu", meshio.Mesh(1e-3 * nodes, [("tetra", cells.reshape(-1, 4))]))
    for name in CHAMBERS:
        cavity = meshio.read(data / f"cavity_{name}.stl")
        triangles = [("triangle", cavity.cells_dict["triangle"])]
        meshio.write(folder / f"{name}.stl", meshio.Mesh(1e-3 * (cavity.points - middle), triangles))
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": STEP,
        "bodies": {"robot": {
            "type": "fem", "mesh": {"file": str(folder / "robot.vtu")}, "element": "tet4", "mass": "35 g",
            "material": {"model": "neo-hookean", "young_modulus": "70 kPa", "poisson_ratio": 0.05},
            "damping": {"mass": 0.1, "stiffness": 0.1},
        }},
        "membranes": {"layer": {"body": "robot", "surface": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
                                "thickness": "1 mm", "young_modulus": "5 MPa", "poisson_ratio": 0.49}},
        "contacts": {"floor": floor(nodes, friction, zones)},
        "actuators": {name: {"type": "chamber", "body": "robot", "surface": {"file": str(folder / f"{name}.stl")}}
                      for name in CHAMBERS},
    }  # fmt: skip


def crawl(data, friction, cycles=1, log=None, zones=None):
    """(steps, 3): time (s), mean displacement towards the front (m), largest height (m)."""
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(scene(data, Path(folder), friction, zones))
    for name, place in CHAMBERS.items():
        sim.actuator(name).pressure = pressure(place, cycles, period=PERIOD, full=PRESSURE)
    robot = sim.body("robot")
    rows = [(0.0, 0.0, robot.positions[:, 2].max())]
    start = robot.positions[:, 0].mean()
    while sim.time < cycles * PERIOD - 0.5 * STEP:
        sim.step()
        if sim.report.flagged:
            raise RuntimeError(f"the step to {sim.time:.3f} s is {sim.report.status}")
        # The front is in the direction of -x in the files.
        rows.append((sim.time, start - robot.positions[:, 0].mean(), robot.positions[:, 2].max()))
        if log:
            print(*rows[-1], sim.report.iterations, sim.report.substeps, file=log, flush=True)
    return np.array(rows)


def draw(path, runs):
    import matplotlib.pyplot as plt

    figure, (motion, figures) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for friction, rows in runs.items():
        motion.plot(rows[:, 0], 1e3 * rows[:, 1], label=f"friction {friction:g}")
    motion.set(xlabel="time (s)", ylabel="moved (mm)", title="mean position of the nodes")
    motion.legend(frameon=False)
    figures.plot(list(runs), [1e3 * rows[-1, 1] for rows in runs.values()], "o-", color="tab:green")
    figures.set(xlabel="coefficient of friction", ylabel="distance per cycle (mm)", title=f"one cycle of {PERIOD:g} s")
    figure.savefig(path, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=Path, help="folder with multigait.vtk and cavity_*.stl")
    parser.add_argument("--out", type=Path, default=Path("out/multigait"))
    parser.add_argument("--friction", type=float, nargs="+", default=FRICTION)
    parser.add_argument("--zones", type=float, metavar="MM", help="all nodes of the sole touch, in zones of this size, such as 10")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    runs = {}
    for friction in arguments.friction:
        with open(arguments.out / f"log_{friction:g}.txt", "w") as log:
            runs[friction] = crawl(arguments.data, friction, log=log, zones=arguments.zones)
        table = arguments.out / f"friction_{friction:g}.csv"
        np.savetxt(table, runs[friction], delimiter=",", header="time_s,moved_m,height_m", comments="")
        print(f"friction {friction:g}: {1e3 * runs[friction][-1, 1]:.2f} mm", flush=True)
    draw(arguments.out / "multigait.png", runs)


if __name__ == "__main__":
    main()
