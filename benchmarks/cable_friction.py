"""Default steps of cables with friction: how many random robots stop, and the iterations that their steps take.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/cable_friction.py [--robots 100]

The robots are those of validation/cases/default_steps.py, with a coefficient of friction of 0.05 to 0.3 in every cable.
"""

import argparse
import pathlib
import sys
import warnings

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "validation"))

import sinew  # noqa: E402
from cases.default_steps import random_robot  # noqa: E402


def run(seed):
    """Iterations of the robot's steps, and whether it stopped."""
    scene, lasts = random_robot(np.random.default_rng(seed))
    random = np.random.default_rng(10000 + seed)
    for cable in scene["actuators"].values():
        cable["friction"] = float(random.uniform(0.05, 0.3))
    sim, iterations = sinew.load(scene), 0
    try:
        while sim.time < lasts - 1e-9:
            sim.step()
            iterations += sim.report.iterations
    except sinew.RunError:
        return iterations, True
    return iterations, False


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", type=int, default=100)
    count = parser.parse_args().robots
    warnings.simplefilter("ignore")
    results = [run(seed) for seed in range(count)]
    iterations, stopped = (sum(column) for column in zip(*results))
    print(f"{count} robots: {iterations} iterations, {stopped} stopped")


if __name__ == "__main__":
    main()
