"""The published trunk lies on a plane and is dragged over it by a cable: complete time of a step in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/lean.py ../shared/data [--runs 3]

The trunk (709 nodes, 1972 tetrahedra, eight cables) leans with one flank on a plane that touches this flank at rest; gravity,
9.81 m/s^2, is normal to the plane. One long cable beside the flank is pulled by 0 to 5 mm once per second, which makes the trunk
slide to and fro (mu = 0.3); the other seven cables are slack. Direct simulation, 10 ms, two seconds. Times are medians of processor
time over the steps after the first half second; of several runs, the lowest median counts. `no plane` is the same motion without
contact and gravity.

The second table is for inverse control: a controller moves the tip by 15 mm to either side along the plane, with a period of two
seconds, with all eight cables, quasi-static. `error` is the median distance of the tip from its target.
"""

import argparse
import pathlib
import tempfile
import time
import warnings

import meshio
import numpy as np
import sinew

STEPS, FIRST = 200, 50
HELD = 20e-3  # m, clamped length of the trunk
SLOPE = 8.0 / 195.0  # slope of its flanks
STAGES = ("detection", "assembly", "rows", "factorisation", "law", "correction")
# Flanks, with the index of the long cable in them. The number of touching points differs.
FLANKS = {"+y": 0, "+x": 3}
SETTINGS = {
    "one linearisation, corotated": ("backward-euler", {"method": "one-linearisation", "tangent": "corotated"}),
    "one linearisation": ("backward-euler", {"method": "one-linearisation"}),
    "Newton, the default": ("backward-euler", {"method": "newton"}),
    "Newton, quasi-static": ("quasi-static", {"method": "newton"}),
}


def cable_points():
    """Published routes of the four long and four short cables (m): a pull point on the body, then guides."""
    across, along = np.array([-8.0, 195.0]) / np.hypot(8.0, 195.0)
    pulls = [(0, 10, 0), (-10, 0, 0), (0, -10, 0), (10, 0, 0)]
    guides = [(0.0, 10.0 + 17.5 * j * across, z + 17.5 * j * along) for j in range(10) for z in (21.0, 27.0)]
    ways = {}
    for k in range(4):
        c, s = np.cos(1.57 * k), np.sin(1.57 * k)
        way = 1e-3 * np.vstack([pulls[k], np.array(guides) @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])])
        ways[f"long_{k}"], ways[f"short_{k}"] = way, way[:10]
    return ways


def outward(flank):
    """Unit normal of a plane below the flank, pointing out of the solid half space."""
    angle = 0.5 * np.pi * (FLANKS[flank] + 1)
    return -np.array([np.cos(angle), np.sin(angle), SLOPE]) / np.hypot(1.0, SLOPE)


def scene(mesh, file, flank, integrator, solver, plane):
    normal = outward(flank)
    nodes = 1e-3 * mesh.points
    lowest = (nodes[nodes[:, 2] > HELD + 1e-6] @ normal).min()
    drag = {"displacement": {"sine": {"mean": "2.5 mm", "amplitude": "2.5 mm", "period": "1 s", "phase": -0.5 * np.pi}}}
    beside = f"long_{(FLANKS[flank] + 1) % 4}"
    cables = {name: {"type": "cable", "body": "trunk", "pull": "body", "outside": "nearest", "points": way.tolist(),
                     "command": drag if name == beside else {"tension": 0.0}} for name, way in cable_points().items()}  # fmt: skip
    made = {"sinew": 1, "gravity": (-9.81 * normal).tolist() if plane else [0.0, 0.0, 0.0], "integrator": integrator,
            "time_step": "10 ms", "solver": solver, "actuators": cables,
            "bodies": {"trunk": {"type": "fem", "mesh": {"file": str(file)}, "element": "tet4", "mass": 0.042,
                                 "material": {"model": "corotational", "young_modulus": 450e3, "poisson_ratio": 0.45},
                                 "fixed": {"box": [-0.02, -0.02, -1e-6, 0.02, 0.02, HELD]}}}}  # fmt: skip
    if plane:
        surface = {"plane": {"point": (lowest * normal).tolist(), "normal": normal.tolist()}}
        made["contacts"] = {"lean": {"body": "trunk", "surface": surface, "friction": 0.3}}
    return made


def run(mesh, flank, integrator, solver, plane):
    """One row per step: ms, points in the contact problem, points with a force, iterations, relative residual, ms of the stages."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "trunk.vtu"
        meshio.write(file, meshio.Mesh(1e-3 * mesh.points, [("tetra", mesh.cells_dict["tetra"])]))
        sim = sinew.load(scene(mesh, file, flank, integrator, solver, plane), threads=1)
    rows = []
    for _ in range(STEPS):
        start = time.process_time()
        sim.step()
        taken = 1e3 * (time.process_time() - start)
        loaded = sum(int((contact.normal_forces > 1e-9).sum()) for contact in sim.contacts.values())
        report = sim.report
        stages = [1e3 * report.times[stage] for stage in STAGES]
        rows.append([taken, len(sim.contact_problem().q) // 3, loaded, report.iterations, report.relative_residual, *stages])
    return np.array(rows[FIRST:])


def measure(mesh, flank, name, runs, plane=True):
    integrator, solver = SETTINGS[name]
    rows = min((run(mesh, flank, integrator, solver, plane) for _ in range(runs)), key=lambda found: np.median(found[:, 0]))
    taken, points, loaded, iterations, residual, *stages = np.median(rows, axis=0)
    what = f"{3 * points:.0f} | {loaded:.0f} ({rows[:, 2].min():.0f} to {rows[:, 2].max():.0f})" if plane else "0 | 0"
    print(f"| {flank if plane else 'no plane'} | {name} | {what} | {iterations:.0f} | {residual:.0e} | "
          + " | ".join(f"{stage:.3f}" for stage in stages) + f" | {taken:.2f} | {np.percentile(rows[:, 0], 95):.2f} |",
          flush=True)  # fmt: skip


def steer(mesh, flank, friction, method):
    """One row per step: ms, points in the contact problem, points with a force, iterations, distance of the tip from its target (m)."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "trunk.vtu"
        meshio.write(file, meshio.Mesh(1e-3 * mesh.points, [("tetra", mesh.cells_dict["tetra"])]))
        made = scene(mesh, file, flank, "quasi-static", {"method": method}, True)
        for cable in made["actuators"].values():
            cable |= {"command": {"tension": 0.0}, "limits": {"tension": {"max": 20.0}}}
        made["contacts"]["lean"]["friction"] = friction
        made["effectors"] = {"tip": {"body": "trunk", "point": [0.0, 0.0, 0.195]}}
        sim = sinew.load(made, threads=1)
    normal = outward(flank)
    sideways = np.cross(normal, [0.0, 0.0, 1.0])
    sim.step(10)
    start = sim.effector("tip").position
    ik = sinew.InverseController(sim, targets={"tip": start})
    rows = []
    for step in range(STEPS):
        shift = 0.015 * np.sin(np.pi * 0.01 * (step + 1))
        ik.targets["tip"] = start + shift * sideways - 0.5 * shift**2 / 0.175 * np.array([0.0, 0.0, 1.0])
        begin = time.process_time()
        ik.step()
        taken = 1e3 * (time.process_time() - begin)
        loaded = int((sim.contact("lean").normal_forces > 1e-9).sum())
        rows.append([taken, len(sim.contact_problem().q) // 3, loaded, sim.report.iterations, ik.error])
    return np.array(rows[FIRST:])


def measure_steered(mesh, flank, friction, method, runs):
    rows = min((steer(mesh, flank, friction, method) for _ in range(runs)), key=lambda found: np.median(found[:, 0]))
    taken, points, loaded, iterations, error = np.median(rows, axis=0)
    print(f"| {flank} | {friction} | {method} | {3 * points:.0f} | {loaded:.0f} ({rows[:, 2].min():.0f} to {rows[:, 2].max():.0f}) "
          f"| {iterations:.0f} | {1e3 * error:.4f} | {taken:.2f} | {np.percentile(rows[:, 0], 95):.2f} |", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=3)
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)  # about residuals of one linearisation, which are printed
    mesh = meshio.read(given.data / "trunk" / "trunk.vtk")
    print("| flank | method | rows of the law | points with a force | iterations | residual | " + " | ".join(STAGES)
          + " | a step, ms | 95th percentile |\n" + "|---" * 14 + "|")  # fmt: skip
    for name in SETTINGS:
        measure(mesh, "+y", name, given.runs, plane=False)
        for flank in FLANKS:
            measure(mesh, flank, name, given.runs)
    print("\n| flank | friction | method | rows of the law | points with a force | iterations | error, mm | a step, ms "
          "| 95th percentile |\n" + "|---" * 9 + "|")  # fmt: skip
    for flank in FLANKS:
        for friction in (0.0, 0.3):
            for method in ("one-linearisation", "newton"):
                measure_steered(mesh, flank, friction, method, given.runs)


if __name__ == "__main__":
    main()
