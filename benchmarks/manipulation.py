"""Two published trunks hold the published soft cup, and an inverse controller tries to carry it along a circle, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/manipulation.py ../shared/data [--radius 1] [--methods newton]

The scene of benchmarks/grasp.py with two trunks, the published eight cables in each (at most 100 mm/s and 20 N), stiffness damping
of 0.05 s and a free cup (54 g). A fixture, nine held displacements, holds the cup until the trunks have squeezed it, and then lets
go. 0.3 s later the controller takes all sixteen cables. It is asked for the place of the cup, the mean of its nodes, for its
rotation, and for at least 0.8 N of normal force of each trunk. Backward Euler, 10 ms. Processor time from when the controller has
held the cup; stages in wall time. A run ends at the first step that cannot be solved, see docs/performance.md. Coevoet et al.
(RoboSoft 2019) report 185 ms for one trunk with 81 contacts that stick.
"""

import argparse
import pathlib
import sys
import tempfile
import time
import warnings

import grasp
import meshio
import numpy as np
import sinew
from lean import cable_points

TRUNKS, PULL = 2, "44 mm"
SQUEEZED, FREE = 160, 30  # steps
TURN_STEPS = 200  # of the circle
STEP = 0.01  # s
LEAST, ARM = 0.8, 30e-3  # N; m: a rotation of 1 rad counts as much as a way of this length
STAGES = ("detection", "assembly", "rows", "factorisation", "law", "correction")


def fixture(nodes):
    """Three points of the cup's bottom, held in all directions."""
    low = nodes[nodes[:, 2] < 1e-4]
    points = [low[np.argmax(low @ [np.cos(turn), np.sin(turn), 0.0])] for turn in 2.0 * np.pi * np.arange(3) / 3.0]
    return {f"fixture_{i}{axis}": {"type": "force", "body": "cup", "point": points[i].tolist(), "direction": np.eye(3)[axis].tolist(),
                                   "command": {"displacement": 0.0}} for i in range(3) for axis in range(3)}  # fmt: skip


def scene(data, folder, method):
    grasp.PULL = PULL
    made = grasp.scene(data, folder, TRUNKS, method)
    del made["bodies"]["cup"]["fixed"]
    actuators = made["actuators"]
    for k, height in enumerate(grasp.HEIGHTS[TRUNKS]):
        made["bodies"][f"trunk_{k}"]["damping"] = {"mass": 0.1, "stiffness": 0.05}
        side, apart = 1.0 - 2.0 * k, 21.5e-3 + 13.5 / 79.0 * height + grasp.WIDE
        lay = lambda x, side=side, apart=apart, height=height: np.column_stack(
            [side * (x[:, 0] + apart), side * (x[:, 2] + grasp.BEGINS), height - x[:, 1]])  # fmt: skip
        for name, way in cable_points().items():
            if name == "long_1":  # the one that squeezes: grasp.scene() has it
                continue
            actuators[f"{name}_{k}"] = {"type": "cable", "body": f"trunk_{k}", "pull": "body", "outside": "nearest",
                                        "points": lay(way).tolist(), "command": {"tension": 0.0}}  # fmt: skip
    for cable in actuators.values():
        cable["limits"] = {"tension": {"max": 20.0}, "displacement": {"rate": "100 mm/s"}}
    nodes = 1e-3 * meshio.read(data / "grasp" / "cup.vtk").points
    actuators |= fixture(nodes)
    rim = nodes[nodes[:, 2] > 78e-3]
    frame = [rim[np.argmin(rim[:, 0])], rim[np.argmax(rim[:, 0])], rim[np.argmax(rim[:, 1])]]
    made["effectors"] = {"cup": {"body": "cup", "points": nodes.tolist()},
                         "turn": {"body": "cup", "orientation": [point.tolist() for point in frame]}}  # fmt: skip
    return made


def hold(data, method):
    """The simulation when the trunks hold the released cup."""
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(scene(data, pathlib.Path(folder), method), threads=1)
    sim.step(SQUEEZED)
    for name, actuator in sim.actuators.items():
        if name.startswith("fixture"):
            actuator.force = 0.0
    sim.step(FREE)
    return sim


def carry(sim, radius):
    """One row per step: ms, points in the law, with a force, sticking, iterations, mm off the path, degrees turned, N, ms of stages.

    Ends at the first step that cannot be solved.
    """
    cup, turn, grips = sim.effector("cup"), sim.effector("turn"), list(sim.contacts.values())
    start, rotation = cup.position.copy(), turn.value.copy()
    ik = sinew.InverseController(
        sim, targets={"cup": start, "turn": rotation}, weights={"turn": ARM**2},
        actuators=[name for name in sim.actuators if not name.startswith("fixture")],
        contacts={grip.name: {"normal_force": {"min": LEAST}} for grip in grips})  # fmt: skip
    rows = []
    for step in range(TURN_STEPS):
        share = (step + 1) / TURN_STEPS
        angle = 2.0 * np.pi * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        asked = start + radius * np.array([0.0, np.sin(angle), 1.0 - np.cos(angle)])
        ik.targets["cup"] = asked
        begin = time.process_time()
        try:
            sim.step()
        except sinew.RunError as error:
            print(f"step {step} of {TURN_STEPS}: {error}", file=sys.stderr)
            break
        taken = time.process_time() - begin
        states = [state for grip in grips for state in grip.states]
        rows.append([1e3 * taken, len(sim.contact_problem().friction), sum(int((grip.normal_forces > 1e-9).sum()) for grip in grips),
                     states.count("stick"), sim.report.iterations, 1e3 * np.linalg.norm(cup.position - asked),
                     np.degrees(np.linalg.norm(turn.value - rotation)), min(grip.normal_force for grip in grips),
                     *(1e3 * sim.report.times[stage] for stage in STAGES)])  # fmt: skip
    return np.array(rows)


def measure(data, method, radius):
    try:
        rows = carry(hold(data, method), radius)
    except sinew.RunError as error:
        print(f"{method}, before the circle: {error}", file=sys.stderr)
        return
    if len(rows) == 0:  # carry() has told why
        return
    taken, places, loaded, stick, iterations, off, turned, _, *stages = np.median(rows, axis=0)
    print(f"| {method} | {len(rows)} | {places:.0f} ({rows[:, 1].min():.0f} to {rows[:, 1].max():.0f}) | {loaded:.0f} | {stick:.0f} | "
          f"{iterations:.0f} | {off:.3f} | {np.percentile(rows[:, 5], 95):.3f} | {rows[:, 5].max():.3f} | {turned:.2f} | "
          f"{rows[:, 7].min():.2f} | " + " | ".join(f"{stage:.2f}" for stage in stages)
          + f" | {taken:.1f} | {np.percentile(rows[:, 0], 95):.1f} |", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--radius", type=float, default=1.0, help="of the circle, mm")
    parser.add_argument("--methods", nargs="+", default=["one-linearisation", "newton"])
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| method | steps | points in the law | with a force | stick | iterations | off its path, mm | 95 % | most | turned, degrees | "
          "least force, N | " + " | ".join(STAGES) + " | a step, ms | 95 % |\n" + "|---" * 19 + "|")  # fmt: skip
    for method in given.methods:
        measure(given.data, method, 1e-3 * given.radius)


if __name__ == "__main__":
    main()
