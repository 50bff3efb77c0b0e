"""Share of collision detection in a step: two crossed soft tubes of 4200 triangles each are pressed together, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/detection.py

The tubes have 3075 nodes and are fixed at their ends; one moves by 8 mm into the other in 0.3 s; backward Euler, 10 ms. Detection is the
stage of that name in the step report: a search at the beginning of the step, one for each motion that the contact law proposes, and the
check at its end that nothing has passed. Times are medians over the steps with contact.
"""

import warnings

import numpy as np
import sinew

EDGE, STEPS = "3 mm", 40


def tube(position, rotation, held):
    return {"type": "fem", "element": "tet4", "density": "1000 kg/m^3", "pose": {"position": position, "rotation": rotation},
            "material": {"model": "corotational", "young_modulus": "300 kPa", "poisson_ratio": 0.4},
            "fixed": [{"box": box} for box in held],
            "mesh": {"shape": "hollow-cylinder", "outer_radius": "15 mm", "inner_radius": "9 mm", "height": "120 mm",
                     "element_size": EDGE}}  # fmt: skip


def scene(method, itself):
    low = tube("0 0 0 mm", "0 90 0 deg", ["-1 -20 -20 8 20 20 mm", "112 -20 -20 121 20 20 mm"])
    high = tube("60 60 30.2 mm", "90 0 0 deg", ["40 -61 10 80 -52 50 mm", "40 52 10 80 61 50 mm"])
    high["motion"] = {"z": {"ramp": {"to": "-8 mm", "duration": "0.3 s"}}}
    contacts = {"cross": {"between": ["low", "high"], "friction": 0.3}}
    if itself:
        contacts |= {name: {"between": [name, name], "friction": 0.3} for name in ("low", "high")}
    return {"sinew": 1, "gravity": "0 0 0 m/s^2", "integrator": "backward-euler", "time_step": "10 ms",
            "solver": {"method": method}, "bodies": {"low": low, "high": high}, "contacts": contacts}  # fmt: skip


def measure(method, itself):
    sim = sinew.load(scene(method, itself), threads=1)
    rows = []
    for _ in range(STEPS):
        sim.step()
        report = sim.report
        near = sum(len(contact.normal_forces) for contact in sim.contacts.values())
        loaded = sum(int((contact.normal_forces > 1e-9).sum()) for contact in sim.contacts.values())
        step, detection = 1e3 * report.times["total"], 1e3 * report.times["detection"]
        rows.append([step, detection, detection / step, near, loaded, report.iterations])
    step, detection, share, near, loaded, iterations = np.median([row for row in rows if row[4]], axis=0)
    print(f"| {'and themselves' if itself else 'each other'} | {method} | {near:.0f} | {loaded:.0f} | {iterations:.0f} | {step:.1f} | "
          f"{detection:.2f} | {100.0 * share:.1f} % |", flush=True)  # fmt: skip


if __name__ == "__main__":
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| touch | method | points | points with a force | iterations | a step, ms | detection, ms | of the step |\n" + "|---" * 8 + "|")
    for itself in (False, True):
        for method in ("newton", "one-linearisation"):
            measure(method, itself)
