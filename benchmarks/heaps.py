"""Heaps of random rigid bodies that fall on a table: time of a step, deepest penetration, flagged steps.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/heaps.py [--bodies 5] [--heaps 8] [--step 2e-3]

Boxes, balls, capsules and cylinders of 10 g to 1 kg, mu = 0.5, a contact for every pair. The time is that of a step called
from Python, including reading the gaps.
"""

import argparse
import time
import warnings

import numpy as np
import sinew

DURATION = 0.6  # s


def random_body(rng, height):
    size = rng.uniform(0.01, 0.02)
    shapes = [{"box": list(rng.uniform(0.02, 0.04, 3))},
              {"sphere": {"radius": size}},
              {"capsule": {"radius": 0.6 * size, "length": 2.0 * size}},
              {"cylinder": {"radius": size, "height": 2.0 * size}}]
    axis = rng.normal(size=3)
    return {"type": "rigid", "shape": shapes[rng.integers(4)], "mass": float(10.0 ** rng.uniform(-2.0, 0.0)),
            "pose": {"position": [*rng.uniform(-0.015, 0.015, 2), height],
                     "rotation": list(axis * rng.uniform(0.0, 3.0) / np.linalg.norm(axis))}}


def heap(seed, count, step):
    rng = np.random.default_rng(seed)
    table = {"type": "rigid", "shape": {"box": [0.6, 0.6, 0.02]}, "fixed": True, "pose": {"position": [0.0, 0.0, -0.01]}}
    fallers = {f"body{k}": random_body(rng, 0.04 + 0.06 * k) for k in range(count)}
    return sinew.load({"sinew": 1, "integrator": "backward-euler", "time_step": step, "gravity": [0.0, 0.0, -9.81],
                       "bodies": {"table": table, **fallers}, "contacts": {"all": {"between": "all", "friction": 0.5}}})


def measure(seed, count, step):
    """Time per step (ms), deepest penetration (m), number of flagged steps, energy gained (J)."""
    sim = heap(seed, count, step)
    steps = round(DURATION / step)
    deepest, flagged = 0.0, 0
    start = time.perf_counter()
    for _ in range(steps):
        sim.step()
        flagged += sim.report.flagged
        deepest = max(deepest, -min(contact.gap for contact in sim.contacts.values()))
    return 1e3 * (time.perf_counter() - start) / steps, deepest, flagged, sim.report.energy_gained


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bodies", type=int, default=5)
    parser.add_argument("--heaps", type=int, default=8)
    parser.add_argument("--step", type=float, default=2e-3, help="s")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    print(f"{'heap':>4} {'ms/step':>8} {'overlap (mm)':>13} {'flagged':>8} {'gained (J)':>11}")
    for seed in range(options.heaps):
        spent, deepest, flagged, gained = measure(seed, options.bodies, options.step)
        print(f"{seed:4d} {spent:8.2f} {1e3 * deepest:13.3f} {flagged:8d} {gained:11.1e}", flush=True)
