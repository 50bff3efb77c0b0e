"""Share of collision detection in a step: two crossed soft tubes of 4200 triangles each are pressed together, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/detection.py

The tubes have 3075 nodes and are fixed at their ends; one moves by 8 mm into the other in 0.3 s; backward Euler, 10 ms. A step refits
both trees and searches once at its beginning and once for each motion that the contact law proposes. The step report has no stage
for these searches alone. They are therefore measured separately, with sinew.collision on the surfaces after each step, and counted
1 + iterations times. Times are processor times, medians over the steps with contact. `perf record` over the same steps shows the
actual time of a step in detection (symbols of sinew::collision and sim::TouchingSurfaces).
"""

import time
import warnings

import numpy as np
import sinew

EDGE, STEPS, SLACK = "3 mm", 40, 0.5
REACH = 0.01  # relative to the size of the scene


def tube(position, rotation, held):
    return {"type": "fem", "element": "tet4", "density": "1000 kg/m^3", "position": position, "rotation": rotation,
            "material": {"model": "corotational", "young_modulus": "300 kPa", "poisson_ratio": 0.4},
            "fixed": [{"box": box} for box in held],
            "mesh": {"shape": "hollow-cylinder", "outer_radius": "15 mm", "inner_radius": "9 mm", "height": "120 mm",
                     "element_size": EDGE}}  # fmt: skip


def scene(method, itself):
    low = tube("0 0 0 mm", "0 90 0 deg", ["-1 -20 -20 8 20 20 mm", "112 -20 -20 121 20 20 mm"])
    high = tube("60 60 30.2 mm", "90 0 0 deg", ["40 -61 10 80 -52 50 mm", "40 52 10 80 61 50 mm"])
    high["base"] = {"z": {"ramp": {"to": "-8 mm", "duration": "0.3 s"}}}
    contacts = {"cross": {"between": ["low", "high"], "friction": 0.3}}
    if itself:
        contacts |= {name: {"between": [name, name], "friction": 0.3} for name in ("low", "high")}
    return {"sinew": 1, "gravity": "0 0 0 m/s^2", "integrator": "backward-euler", "time_step": "10 ms",
            "solver": {"method": method}, "bodies": {"low": low, "high": high}, "contacts": contacts}  # fmt: skip


def boundary(tetrahedra):
    """Triangles that belong to a single tetrahedron, with outward normals."""
    faces = np.vstack([tetrahedra[:, list(corners)] for corners in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def spent(call):
    start = time.process_time()
    result = call()
    return 1e3 * (time.process_time() - start), result


def measure(method, itself):
    sim = sinew.load(scene(method, itself), threads=1)
    bodies = [sim.body(name) for name in ("low", "high")]
    surfaces = [sinew.collision.Surface(body.rest_positions, boundary(body.tetrahedra)) for body in bodies]
    triangles = [len(surface.triangles) for surface in surfaces]
    reach = REACH * np.ptp(np.vstack([body.rest_positions for body in bodies]), axis=0).max()
    near = lambda *pair: sinew.collision.proximity(*pair, distance=reach, slack=SLACK)
    rows = []
    for _ in range(STEPS):
        step, _ = spent(sim.step)
        refit, moved = spent(lambda: [s.moved(body.positions) for s, body in zip(surfaces, bodies)])
        search, pairs = spent(lambda: near(*moved))
        if itself:
            search += sum(spent(lambda: near(surface))[0] for surface in moved)
        loaded = sum(int((contact.normal_forces > 1e-9).sum()) for contact in sim.contacts.values())
        rows.append([step, refit, search, (1 + sim.report.iterations) * (refit + search) / step, len(pairs.distances),
                     loaded, sim.report.iterations])  # fmt: skip
    step, refit, search, share, pairs, loaded, iterations = np.median([row for row in rows if row[5]], axis=0)
    print(f"| {triangles[0]}, {triangles[1]} | {'and themselves' if itself else 'each other'} | {method} | {pairs:.0f} | {loaded:.0f} | "
          f"{iterations:.0f} | {step:.1f} | {refit:.2f} | {search:.2f} | {100.0 * share:.1f} % |", flush=True)  # fmt: skip


if __name__ == "__main__":
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| triangles | touch | method | pairs near | points with a force | iterations | a step, ms | refit, ms | search, ms | "
          "of the step |\n" + "|---" * 10 + "|")  # fmt: skip
    for itself in (False, True):
        for method in ("newton", "one-linearisation"):
            measure(method, itself)
