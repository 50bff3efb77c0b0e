"""Counts the iterations of the steps of random robots, and how many of them stop; for cable_friction.py and taut_cables.py."""

import argparse
import warnings

import sinew


def run(scene, lasts):
    """Iterations of a scene's steps until a time (s), and whether it stopped before."""
    sim, iterations = sinew.load(scene), 0
    try:
        while sim.time < lasts - 1e-9:
            sim.step()
            iterations += sim.report.iterations
    except sinew.RunError:
        return iterations, True
    return iterations, False


def main(description, robots, name, make):
    """Prints the sums over `--robots` robots (default: `robots`), called `name`; make(seed) is a scene and how long it lasts."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("--robots", type=int, default=robots)
    count = parser.parse_args().robots
    warnings.simplefilter("ignore")
    results = [run(*make(seed)) for seed in range(count)]
    iterations, stopped = (sum(column) for column in zip(*results))
    print(f"{count} {name}: {iterations} iterations, {stopped} stopped")
