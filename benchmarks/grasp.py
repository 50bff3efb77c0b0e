"""Trunks that wrap around a cup and squeeze it, the published meshes: a step, everything included, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/grasp.py ../shared/data

The cup (1255 nodes, 3800 tetrahedra) is held at its bottom, without gravity. One trunk (709 nodes) lies beside it, or two at
different heights on either side, each bent around it by the cable on its inner side; backward Euler, 10 ms. Medians of processor
time over the steps in which a trunk has taken hold, with converged steps and with one linearisation a step.
"""

import pathlib
import sys
import tempfile
import time

import meshio
import numpy as np
import sinew

HEIGHTS = {1: [45e-3], 2: [28e-3, 62e-3]}  # m above the cup's bottom
HELD, WIDE, BEGINS = 20e-3, 14e-3, -20e-3  # m: how much of a trunk is held, from its axis to the cup, along it before the cup
PULL, SECONDS, STEPS = "45 mm", 1.5, 180
TAKEN_HOLD = 20  # places in the law


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
    bodies = {"cup": {**cup, "density": 1070.0, "material": {**law, "young_modulus": 1e6}, "fixed": {"box": [-0.1, -0.1, -1e-3, 0.1, 0.1, 2e-3]}}}
    contacts, cables = {}, {}
    for k, height in enumerate(HEIGHTS[trunks]):
        side = 1.0 - 2.0 * k
        apart = 21.5e-3 + 13.5 / 79.0 * height + WIDE
        # Along y beside the cup, the inner side of the mesh (-x) towards it; the second one turned by half a turn about z.
        lay = lambda x, side=side, apart=apart, height=height: np.column_stack(
            [side * (x[:, 0] + apart), side * (x[:, 2] + BEGINS), height - x[:, 1]])  # fmt: skip
        trunk = tetrahedra(data / "trunk" / "trunk.vtk", lay, folder / f"trunk_{k}.vtu")
        ends = sorted([side * (BEGINS - 1e-6), side * (BEGINS + HELD + 1e-6)])
        bodies[f"trunk_{k}"] = {**trunk, "mass": 0.042, "material": {**law, "young_modulus": 450e3},
                                "fixed": {"box": [-0.2, ends[0], -0.2, 0.2, ends[1], 0.2]}}  # fmt: skip
        cables[f"cable_{k}"] = {"type": "cable", "body": f"trunk_{k}", "pull": "body", "outside": "nearest", "points": lay(route()).tolist(),
                                "command": {"displacement": {"ramp": {"to": PULL, "duration": f"{SECONDS} s"}}}}  # fmt: skip
        contacts[f"grip_{k}"] = {"between": [f"trunk_{k}", "cup"], "friction": 0.6}
    return {"sinew": 1, "gravity": "0 0 0 m/s^2", "integrator": "backward-euler", "time_step": "10 ms", "solver": {"method": method},
            "bodies": bodies, "actuators": cables, "contacts": contacts}  # fmt: skip


def measure(data, trunks, method):
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(scene(data, pathlib.Path(folder), trunks, method), threads=1)
    rows = []
    for _ in range(STEPS):
        start = time.process_time()
        sim.step()
        taken = 1e3 * (time.process_time() - start)
        loaded = sum(int((contact.normal_forces > 1e-9).sum()) for contact in sim.contacts.values())
        rows.append((taken, len(sim.contact_problem().q) // 3, loaded, sim.report.iterations))
    rows = np.array([row for row in rows if row[1] >= TAKEN_HOLD])
    taken, places, loaded, iterations = np.median(rows, axis=0)
    print(f"| {trunks} | {method} | {places:.0f} to {rows[:, 1].max():.0f} | {loaded:.0f} | {iterations:.0f} | {taken:.1f} | "
          f"{np.percentile(rows[:, 0], 95):.1f} |", flush=True)  # fmt: skip


def main():
    data = pathlib.Path(sys.argv[1])
    print("| trunks | method | places in the law | with a force | iterations | a step, ms | 95th percentile |\n|---|---|---|---|---|---|---|")
    for trunks in (1, 2):
        for method in ("one-linearisation", "newton"):
            measure(data, trunks, method)


if __name__ == "__main__":
    main()
