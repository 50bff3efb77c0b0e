"""The law of contact alone, on the problems of consecutive steps: sinew.qp.solve_cones, warm and cold, to 1e-8, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/law.py [../shared/data] [--large]

A block (mu = 0.3: it slides; mu = 0.5: it slides and stops) lands on the incline of examples/contact/incline.yaml with 100 points,
and with --large with 361 and 484; two published trunks squeeze a cup, about 100 places (benchmarks/grasp.py), where the data are.
`warm` starts from the forces of the step before; steps that do not have its number of points are left out. `call` is the same call
for a problem in which nothing touches: it reads and symmetrises W, which a step of a simulation does not do, and is taken away
from the other times. Processor time, medians over the steps, each the least of three calls. `in the step` is the law within the
step of the simulation: all its Newton iterations, and the rounds that planes and distant points ask for.
"""

import argparse
import pathlib
import tempfile
import time
import warnings

import grasp
import numpy as np
import sinew

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOLERANCE, CALLS = 1e-8, 3
BLOCKS = [("4.4 mm", 0.3), ("4.4 mm", 0.5)]
LARGE_BLOCKS = [("2.2 mm", 0.3), ("2.2 mm", 0.5), ("1.9 mm", 0.3), ("1.9 mm", 0.5)]
LANDED, BLOCK_STEPS = 15, 45
SQUEEZED, SQUEEZE_STEPS = 120, 40


def least_time(call):
    """Milliseconds, and what the last call returned."""
    times = []
    for _ in range(CALLS):
        begin = time.thread_time()
        result = call()
        times.append(1e3 * (time.thread_time() - begin))
    return min(times), result


def measure(name, sim, before, steps):
    sim.step(before)
    last, rows, open_steps, unsolved = sim.contact_problem().r, [], 0, 0
    for _ in range(steps):
        sim.step()
        problem = sim.contact_problem()
        start, last = last, problem.r
        if len(start) != len(last) or not len(last):
            open_steps += 1
            continue
        apart = np.abs(problem.q)
        apart.reshape(-1, 3)[:, 1:] = 0.0
        solve = lambda q, x=None: sinew.qp.solve_cones(problem.W, q, problem.friction, TOLERANCE, x)
        call, _ = least_time(lambda: solve(apart))
        warm, found = least_time(lambda: solve(problem.q, start))
        cold, other = least_time(lambda: solve(problem.q))
        unsolved += (found.status != "solved") + (other.status != "solved")
        states = found.states
        rows.append([len(states), len(states) - states.count("open"), states.count("slip"), call, warm - call, found.iterations,
                     cold - call, other.iterations, 1e3 * sim.report.times["law"], sim.report.iterations])  # fmt: skip
    if not rows:
        print(f"| {name} | no two steps with the same points |", flush=True)
        return
    rows = np.array(rows)
    points, loaded, slips, call, warm, warm_steps, cold, cold_steps, law, iterations = np.median(rows, axis=0)
    print(f"| {name} | {points:.0f} | {loaded:.0f}, {slips:.0f} | {len(rows)} ({open_steps}) | {call:.2f} | **{warm:.2f}** | "
          f"{np.percentile(rows[:, 4], 95):.2f} | {warm_steps:.0f} | {cold:.1f} | {cold_steps:.0f} | {law:.2f} ({iterations:.0f}) | "
          f"{unsolved} |", flush=True)  # fmt: skip


def block(size, friction):
    return sinew.load(ROOT / "examples" / "contact" / "incline.yaml", threads=1,
                      set={"bodies.block.mesh.element_size": size, "contacts.incline.friction": friction})  # fmt: skip


def squeezed_cup(data):
    with tempfile.TemporaryDirectory() as folder:
        return sinew.load(grasp.scene(data, pathlib.Path(folder), 2, "one-linearisation"), threads=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path, nargs="?")
    parser.add_argument("--large", action="store_true", help="361 and 484 points, minutes")
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| problems | points | with a force, of which slide | steps (left out) | call, ms | warm, ms | 95th percentile | its steps | "
          "cold, ms | its steps | in the step, ms (iterations) | not solved |\n" + "|---" * 12 + "|")  # fmt: skip
    for size, friction in BLOCKS + (LARGE_BLOCKS if given.large else []):
        measure(f"block, mu = {friction:g}", block(size, friction), LANDED, BLOCK_STEPS)
    if given.data and (given.data / "grasp" / "cup.vtk").exists():
        measure("two trunks and a cup", squeezed_cup(given.data), SQUEEZED, SQUEEZE_STEPS)


if __name__ == "__main__":
    main()
