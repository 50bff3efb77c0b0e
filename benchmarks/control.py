"""Closed loops on the trunk with eight cables: processor time of a step and of its parts.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/control.py [--steps 200] [--repeat 3]

Plant and model are the trunk of examples/trunk (703 nodes, 2592 tetrahedra), hanging under gravity; the tip follows a
circle of 30 mm radius in 3 s. A step of the loop contains the work of a robot's computer in each sample: the response W at
the model's state, the quadratic program (8 efforts; over a horizon of 10 steps 80, with limits of tension, length and
rate in each), the condition of convergence, and the model's own step. Times are processor times of one thread over the
steps after the first twenty; of several runs, the one with the lowest median counts. The steps of the plant are not
included. Rate: one over the median.
"""

import argparse
import pathlib
import sys
import time

import numpy as np
import sinew
from sinew import control

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "examples" / "python"))
import closed_loop  # noqa: E402

LOOPS = {"resolved rate": control.ClosedLoop, "predictive, horizon 10": control.PredictiveController}


def timed(function, *arguments):
    start = time.process_time()
    result = function(*arguments)
    return result, time.process_time() - start


def run(make, steps):
    """(steps,) s of the loop's steps, of the response alone, and of the model's step alone."""
    circle = sinew.Circle([0.0, 0.0, 0.18], 0.03, period=3.0)
    plant, model = closed_loop.trunk(), closed_loop.trunk()
    loop = make(model, {"tip": circle}, closed_loop.CABLES)
    times = []
    for _ in range(steps):
        commands, seconds = timed(loop.step, {"tip": plant.effector("tip").position}, plant.time)
        loop.send(plant, commands)
        _, own = timed(plant.step)  # costs the same as the model's step
        times.append((seconds, timed(model.response)[1], own))
    return np.array(times[20:]), loop.error


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    print("| loop | step, ms | 95th percentile | response | model's step | rest | rate, Hz |")
    print("|---|---|---|---|---|---|---|")
    for name, make in LOOPS.items():
        runs = [run(make, options.steps)[0] for _ in range(options.repeat)]
        best = min(runs, key=lambda times: np.median(times[:, 0]))
        step, response, own = 1e3 * np.median(best, axis=0)
        print(f"| {name} | {step:.2f} | {1e3 * np.percentile(best[:, 0], 95):.2f} | {response:.2f} | {own:.2f} "
              f"| {step - response - own:.2f} | {1e3 / step:.0f} |")


if __name__ == "__main__":
    main()
