#!/usr/bin/python3
"""Error of a robot's stiffness versus the time of a step, for several elements and refinements: writes
docs/images/pareto.png and prints the tables of docs/performance.md.

    /usr/bin/python3 benchmarks/pareto.py [--data FOLDER]

Three robots: the conical arm (tip pushed aside), a pneumatic module (chamber under pressure) and, with a
folder of published meshes, the trunk (tip pushed aside). Loads are small, so one number gives the stiffness;
its reference is extrapolated from the two finest meshes of the best elements. Steps are timed at that load on
one thread, with one linearisation each and backward Euler; the fastest of up to 40 counts, because the machine
may have other load.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "build" / "release" / "python"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import sinew  # noqa: E402

STEPS = 40
RUBBER = {"model": "neo-hookean", "young_modulus": 72e3, "poisson_ratio": 0.49}
STIFF = {"model": "neo-hookean", "young_modulus": 450e3, "poisson_ratio": 0.45}
SMALL = {"model": "corotational", "young_modulus": 450e3, "poisson_ratio": 0.45}


def scene(mesh, element, material, fixed, actuator, tip):
    return {"sinew": 1, "time_step": 0.01, "integrator": "backward-euler", "solver": {"ordering": "metis"},
            "bodies": {"robot": {"type": "fem", "mesh": mesh, "element": element, "material": material,
                                 "density": 1070.0, "fixed": fixed, "damping": {"stiffness": 0.01}}},
            "actuators": {"load": {"body": "robot", **actuator}},
            "effectors": {"tip": {"body": "robot", "point": tip, "outside": "nearest"}}}


def measure(tree, command, value):
    """Displacement of the tip (mm), shortest time of a step (ms) and number of nodes."""
    sim = sinew.load(tree)
    start = sim.effector("tip").position.copy()
    setattr(sim.actuator("load"), command, value)
    sim.solve_static()
    moved = sim.effector("tip").position - start
    times = []
    while len(times) < 3 or (len(times) < STEPS and sum(times) < 5.0):
        begin = time.perf_counter()
        sim.step()
        times.append(time.perf_counter() - begin)
    return 1e3 * abs(moved[0]), 1e3 * min(times), len(sim.body("robot").rest_positions)


def arm(element, size):
    mesh = {"shape": "cone", "base_radius": 0.017, "tip_radius": 0.008, "height": 0.26, "element_size": size * 1e-3}
    push = {"type": "force", "point": [0, 0, 0.26], "direction": [1, 0, 0]}
    return measure(scene(mesh, element, RUBBER, [{"set": "bottom"}], push, [0, 0, 0.26]), "force", 1e-5)


def module(element, size):
    mesh = {"shape": "chambered-cylinder", "radius": 0.0125, "height": 0.065, "chamber_radius": 0.0037,
            "chamber_offset": 0.0073, "chamber_top": 0.06, "element_size": size * 1e-3}
    air = {"type": "chamber", "surface": {"set": "chamber"}, "cap": True}
    return measure(scene(mesh, element, RUBBER, [{"set": "bottom"}], air, [0, 0, 0.065]), "pressure", 10.0)


def trunk(path, element, material):
    push = {"type": "force", "point": "0 0 195 mm", "direction": [1, 0, 0], "outside": "nearest"}
    tree = scene({"file": str(path), "unit": "mm"}, element, material, [{"box": "-20 -20 0 20 20 20 mm"}], push,
                 "0 0 195 mm")
    return measure(tree, "force", 1e-5)


def refined(path, times, folder):
    """Mesh file of the trunk after `times` refinements of each tetrahedron into eight."""
    sys.path.insert(0, str(ROOT / "validation"))
    import meshio
    mesh = meshio.read(path)
    points, cells = mesh.points, mesh.cells_dict["tetra"]
    for _ in range(times):
        points, cells = split(points, cells)
    out = folder / f"trunk_{times}.vtu"
    meshio.write_points_cells(out, points, [("tetra", cells)])
    return out


def split(points, cells):
    """Splits each tetrahedron into eight at the midpoints of its edges."""
    import numpy as np
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    pairs = np.sort(np.concatenate([cells[:, e] for e in edges]), axis=1)
    ends, number = np.unique(pairs, axis=0, return_inverse=True)
    middle = (number.reshape(6, -1).T + len(points))
    points = np.vstack([points, 0.5 * (points[ends[:, 0]] + points[ends[:, 1]])])
    c, m = cells, middle
    stack = [(c[:, 0], m[:, 0], m[:, 2], m[:, 3]), (m[:, 0], c[:, 1], m[:, 1], m[:, 4]),
             (m[:, 2], m[:, 1], c[:, 2], m[:, 5]), (m[:, 3], m[:, 4], m[:, 5], c[:, 3]),
             (m[:, 0], m[:, 1], m[:, 2], m[:, 4]), (m[:, 0], m[:, 2], m[:, 3], m[:, 4]),
             (m[:, 2], m[:, 3], m[:, 4], m[:, 5]), (m[:, 1], m[:, 2], m[:, 4], m[:, 5])]
    return points, np.concatenate([np.column_stack(s) for s in stack])


COLOURS = {"tet4": "#c8501e", "tet4-patch": "#d9a21b", "tet10": "#3a8a4d", "hex8": "#1f5fa8"}


def chart(axis, title, results, reference):
    for element, rows in results.items():
        kind = element.split(",")[0]
        axis.loglog([r[2] for r in rows], [max(100 * abs(r[1] / reference - 1), 0.02) for r in rows],
                    "o-" if "," not in element else "s--", color=COLOURS[kind], label=element)
    axis.axhline(5, color="#222222", lw=1, ls=":")
    axis.set(title=title, xlabel="time of a step, one core (ms)", ylabel="error of the tip's motion (%)")
    axis.grid(color="#e4e4e4")
    axis.legend(frameon=False)


def table(title, results, reference):
    print(f"\n**{title}**, converged motion {reference:.4g} (mm under the load)\n")
    print("| element | size or refinement | nodes | motion, mm | error | step, ms |\n|---|---|---|---|---|---|")
    for element, rows in results.items():
        for label, motion, step, nodes in rows:
            print(f"| {element} | {label} | {nodes} | {motion:.4g} | {100 * (motion / reference - 1):+.1f} % | "
                  f"{step:.2f} |")


def sweep(measure_one, sizes):
    return {element: [(f"{s:g} mm", *measure_one(element, s)) for s in list_of]
            for element, list_of in sizes.items()}


def extrapolated(rows):
    """Richardson extrapolation of order 2 from two meshes; the finer one has half the cell size."""
    return rows[-1][1] + (rows[-1][1] - rows[-2][1]) / 3


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data")
    data = parser.parse_args().data
    charts = []
    sizes = {"tet4": (13, 6.5, 3.25), "tet4-patch": (13, 6.5, 3.25), "tet10": (13, 6.5, 4),
             "hex8": (13, 6.5, 4.3, 3.25, 1.625)}
    found = sweep(arm, sizes)
    charts.append(("Conical arm", found, extrapolated(found["hex8"])))
    sizes = {"tet4": (4, 2.5, 1.5), "tet4-patch": (4, 2.5, 1.5), "tet10": (6, 4, 3, 2.5),
             "hex8": (4, 2.5, 1.6, 0.8)}
    found = sweep(module, sizes)
    charts.append(("Pneumatic module", found, extrapolated(found["hex8"])))
    source = data / "trunk" / "trunk.vtk"
    if source.exists():
        with tempfile.TemporaryDirectory() as name:
            paths = [refined(source, k, pathlib.Path(name)) for k in range(3)]
            label = ("as published", "cut in 8", "in 64")
            found = {"tet4": [(label[k], *trunk(paths[k], "tet4", SMALL)) for k in range(3)],
                     "tet4-patch": [(label[k], *trunk(paths[k], "tet4-patch", STIFF)) for k in range(3)],
                     "tet10": [(label[k], *trunk(paths[k], "tet10", STIFF)) for k in range(2)]}
            fine = found["tet10"]
            charts.append(("Published trunk", found, fine[1][1] + (fine[1][1] - fine[0][1]) / 3))
    figure, axes = plt.subplots(1, len(charts), figsize=(4.6 * len(charts), 4.0), constrained_layout=True)
    for axis, (title, results, reference) in zip(axes, charts):
        chart(axis, title, results, reference)
        table(title, results, reference)
    figure.savefig(ROOT / "docs" / "images" / "pareto.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main()
