"""The law of contact alone, on the problems of consecutive steps: sinew.qp.solve_cones, warm and cold, to 1e-8, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/law.py [../shared/data] [--large]

A block has landed on the incline of examples/contact/incline.yaml (mu = 0.5), slides and stops, with 100 points, and with --large
with 361 and 484; two published trunks squeeze a cup, about 100 places (benchmarks/grasp.py), where the data are. Steps are sorted
by what their points do: more than nine tenths of those with a force slide, more than 99 % stick, or the block stops.
`warm` starts from the forces of the step before; steps that do not have its number of points are left out. `call` is the same call
for a problem in which nothing touches: it reads and symmetrises W, which a step of a simulation does not do, and is taken away
from the other times. Processor time, medians over the steps, each the least of three calls. `in the step` is the law within the
step of the simulation: all its Newton iterations, and the rounds that planes and distant points ask for.
"""

import argparse
import pathlib
import sys
import tempfile
import time
import warnings

import grasp
import numpy as np
import sinew

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOLERANCE, CALLS = 1e-8, 3
BLOCKS, LARGE_BLOCKS = ["4.4 mm"], ["2.2 mm", "1.9 mm"]
LANDED, BLOCK_STEPS = 30, 40
SQUEEZED, SQUEEZE_STEPS = 120, 40


def least_time(call):
    """Milliseconds, and what the last call returned."""
    times = []
    for _ in range(CALLS):
        begin = time.thread_time()
        result = call()
        times.append(1e3 * (time.thread_time() - begin))
    return min(times), result


def phase(states):
    """What the points of a step do."""
    slips, loaded = states.count("slip"), len(states) - states.count("open")
    return "slides" if slips > 0.9 * loaded else "sticks" if slips < 0.01 * loaded else "some slide"


def measure(name, sim, before, steps):
    sim.step(before)
    last, phases, left_out, unsolved = sim.contact_problem().r, {}, 0, 0
    for _ in range(steps):
        sim.step()
        problem = sim.contact_problem()
        start, last = last, problem.r
        if len(start) != len(last) or not len(last):
            left_out += 1
            continue
        apart = np.abs(problem.q)
        apart.reshape(-1, 3)[:, 1:] = 0.0
        solve = lambda q, x=None: sinew.qp.solve_cones(problem.W, q, problem.friction, TOLERANCE, x)
        call, _ = least_time(lambda: solve(apart))
        warm, found = least_time(lambda: solve(problem.q, start))
        cold, other = least_time(lambda: solve(problem.q))
        unsolved += (found.status != "solved") + (other.status != "solved")
        states = found.states
        phases.setdefault(phase(states), []).append(
            [len(states), len(states) - states.count("open"), call, warm - call, found.iterations, cold - call, other.iterations,
             1e3 * sim.report.times["law"], sim.report.iterations])  # fmt: skip
    for kind, rows in phases.items():
        rows = np.array(rows)
        points, loaded, call, warm, warm_steps, cold, cold_steps, law, iterations = np.median(rows, axis=0)
        print(f"| {name}, {kind} | {points:.0f} | {loaded:.0f} | {len(rows)} | {call:.2f} | **{warm:.2f}** | {rows[:, 3].max():.2f} | "
              f"{warm_steps:.0f} | {cold:.1f} | {cold_steps:.0f} | {law:.2f} ({iterations:.0f}) |", flush=True)  # fmt: skip
    if left_out or unsolved:
        print(f"{name}: {left_out} steps left out, {unsolved} calls did not solve", file=sys.stderr)


def block(size):
    return sinew.load(ROOT / "examples" / "contact" / "incline.yaml", threads=1, set={"bodies.block.mesh.element_size": size})


def squeezed_cup(data):
    with tempfile.TemporaryDirectory() as folder:
        return sinew.load(grasp.scene(data, pathlib.Path(folder), 2, "one-linearisation"), threads=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path, nargs="?")
    parser.add_argument("--large", action="store_true", help="361 and 484 points, minutes")
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| problems | points | with a force | steps | call, ms | warm, ms | most | its iterations | cold, ms | its iterations | "
          "in the step, ms (iterations) |\n" + "|---" * 11 + "|")  # fmt: skip
    for size in BLOCKS + (LARGE_BLOCKS if given.large else []):
        measure("block", block(size), LANDED, BLOCK_STEPS)
    if given.data and (given.data / "grasp" / "cup.vtk").exists():
        measure("trunks and cup", squeezed_cup(given.data), SQUEEZED, SQUEEZE_STEPS)


if __name__ == "__main__":
    main()
