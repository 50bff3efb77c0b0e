#!/usr/bin/env python3
"""Workspace of the trunk's tip: random tensions, with simulations in parallel threads."""

import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import sinew

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"
SAMPLES = 64


def main():
    start = sinew.load(SCENE)
    cables = list(start.actuators)
    tensions = np.random.default_rng(0).uniform(0.0, 1.0, (SAMPLES, len(cables)))

    def settle(sample):
        sim = start.clone()
        for name, tension in zip(cables, sample):
            sim.actuator(name).tension = sinew.Ramp(0.0, tension, duration=0.2)
        sim.step(25)
        sim.solve_static()
        return sim.effector("tip").position

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        tips = np.array(list(pool.map(settle, tensions)))
    for axis, low, high in zip("xyz", 1e3 * tips.min(axis=0), 1e3 * tips.max(axis=0)):
        print(f"tip {axis} from {low:7.2f} to {high:7.2f} mm")


if __name__ == "__main__":
    main()
