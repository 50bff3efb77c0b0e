"""Trunks that take hold of a cup, the published meshes: a step, everything included, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/grasp.py ../shared/data

The cup (1255 nodes, 3800 tetrahedra) stands on a table; one or three trunks (709 nodes each) hang beside it and are bent
towards it by a cable each, backward Euler, 10 ms. Medians of processor time while they close, with converged steps and
with one linearisation a step.
"""

import pathlib
import sys
import tempfile
import time

import meshio
import numpy as np
import sinew

APART, TOP, HELD = 54e-3, 205e-3, 20e-3  # m: feet from the cup's axis and above the table, how much of a trunk is held
STEPS = 60


def route():
    """The published way of a long cable, turned to the inner side (m): its pull point, then twenty guides."""
    across, along = -8.0 / np.hypot(8.0, 195.0), 195.0 / np.hypot(8.0, 195.0)
    guides = [(10.0 + 17.5 * j * across, z + 17.5 * j * along) for j in range(10) for z in (21.0, 27.0)]
    return np.array([(-r, 0.0, z) for r, z in [(10.0, 0.0), *guides]]) * 1e-3


def tetrahedra(path, place, out):
    mesh = meshio.read(path)
    meshio.write(out, meshio.Mesh(place(1e-3 * mesh.points), [("tetra", mesh.cells_dict["tetra"])]))
    return {"type": "fem", "mesh": {"file": str(out)}, "element": "tet4"}


def scene(data, folder, trunks, method):
    law = {"model": "corotational", "poisson_ratio": 0.45}
    cup = tetrahedra(data / "grasp" / "cup.vtk", lambda x: x, folder / "cup.vtu")
    table = {"type": "rigid", "shape": {"box": "200 200 10 mm"}, "fixed": True, "pose": {"position": "0 0 -5.01 mm"}}
    bodies = {"table": table, "cup": {**cup, "density": 1070.0, "material": {**law, "young_modulus": 1e6}}}
    contacts = {"stand": {"between": ["cup", "table"], "friction": 0.6}}
    cables = {}
    for k in range(trunks):
        c, s = np.cos(2.0 * np.pi * k / 3.0), np.sin(2.0 * np.pi * k / 3.0)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        hang = lambda x, turn=turn: (x * [1.0, -1.0, -1.0] + [APART, 0.0, TOP]) @ turn.T
        trunk = tetrahedra(data / "trunk" / "trunk.vtk", hang, folder / f"trunk_{k}.vtu")
        bodies[f"trunk_{k}"] = {**trunk, "mass": 0.042, "material": {**law, "young_modulus": 450e3},
                                "fixed": {"box": [-0.2, -0.2, TOP - HELD - 1e-6, 0.2, 0.2, TOP + 1e-6]}}  # fmt: skip
        cables[f"cable_{k}"] = {"type": "cable", "body": f"trunk_{k}", "pull": "body", "outside": "nearest", "points": hang(route()).tolist(),
                                "command": {"displacement": {"ramp": {"to": "15 mm", "duration": "0.6 s"}}}}  # fmt: skip
        contacts[f"grip_{k}"] = {"between": [f"trunk_{k}", "cup"], "friction": 0.6}
    return {"sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": "10 ms", "solver": {"method": method},
            "bodies": bodies, "actuators": cables, "contacts": contacts}  # fmt: skip


def measure(data, trunks, method):
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(scene(data, pathlib.Path(folder), trunks, method), threads=1)
    taken, places, loaded, iterations = [], [], [], []
    for _ in range(STEPS):
        start = time.process_time()
        sim.step()
        taken.append(1e3 * (time.process_time() - start))
        places.append(len(sim.contact_problem().q) // 3)
        loaded.append(sum(int((contact.normal_forces > 1e-9).sum()) for contact in sim.contacts.values()))
        iterations.append(sim.report.iterations)
    middle = lambda values: float(np.median(values))
    print(f"| {trunks} | {method} | {middle(places):.0f} | {middle(loaded):.0f} | {middle(iterations):.0f} | {middle(taken):.1f} | "
          f"{np.percentile(taken, 95):.1f} |", flush=True)  # fmt: skip


def main():
    data = pathlib.Path(sys.argv[1])
    print("| trunks | method | places in the law | with a force | iterations | a step, ms | 95th percentile |\n|---|---|---|---|---|---|---|")
    for trunks in (1, 3):
        for method in ("one-linearisation", "newton"):
            measure(data, trunks, method)


if __name__ == "__main__":
    main()
