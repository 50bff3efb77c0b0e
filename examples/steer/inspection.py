#!/usr/bin/env python3
"""A trunk inspects two places behind a tube that it leans on: inverse control through contact, without friction and with it.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/inspection.py [--out FOLDER]

The trunk of examples/trunk with its eight cables, and a tube of 12 mm radius across its way. The tip goes to a place
beyond the tube, along a line to another one and back. Nobody tells the controller when to touch: the quadratic program
of every step takes the trunk as it answers while it leans, slides and sticks. FOLDER gets inspection.png.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import sinew
import yaml

HERE = Path(__file__).resolve().parent
FIRST, SECOND = np.array([0.046, -0.022, 0.165]), np.array([0.046, 0.022, 0.165])  # m
TUBE = {"type": "rigid", "fixed": True, "shape": {"capsule": {"length": "120 mm", "radius": "12 mm"}},
        "pose": {"position": "30 0 95 mm", "rotation": {"axis": "1 0 0", "angle": "90 deg"}}}  # fmt: skip
ARRIVE, TRAVEL, STEP = 1.5, 2.0, 0.01  # s


def scene(friction):
    tree = yaml.safe_load((HERE.parent / "trunk" / "trunk.yaml").read_text())
    for actuator in tree["actuators"].values():
        actuator["points"]["file"] = str(HERE.parent / "trunk" / actuator["points"]["file"])
        actuator["command"] = {"tension": "0 N"}
    tree["bodies"]["tube"] = TUBE
    tree["contacts"] = {"tube": {"between": ["trunk", "tube"], "friction": friction}}
    return tree


def target(time):
    """There, across and back: (3,) m."""
    share = np.clip((time - ARRIVE) / TRAVEL, 0.0, 2.0)
    return FIRST + (1.0 - abs(1.0 - share)) * (SECOND - FIRST)


def inspect(friction):
    """Columns of numbers, one row a step, and the simulation at its end."""
    sim = sinew.load(scene(friction))
    ik = sinew.InverseController(sim, targets={"tip": FIRST})
    rows = []
    for _ in range(round((ARRIVE + 2.0 * TRAVEL) / STEP)):
        ik.targets["tip"] = target(sim.time + STEP)
        start = time.process_time()
        status = ik.step()
        spent = time.process_time() - start
        contact = sim.contact("tube")
        states = np.array(contact.states, dtype=str)  # may be empty
        rows.append((sim.time, ik.error, spent, len(sim.contact_problem().friction), np.sum(states == "stick"),
                     np.sum(states == "slip"), contact.normal_force, contact.gap, status == "on-target"))  # fmt: skip
    return np.array(rows, dtype=float), sim


def report(friction, rows):
    late = rows[rows[:, 0] > ARRIVE]
    touching = late[:, 4] + late[:, 5]
    print(f"friction {friction}: error {1e3 * np.median(late[:, 1]):.4f} mm (largest {1e3 * late[:, 1].max():.3f}), "
          f"{np.median(late[:, 3]):.0f} points take part ({late[:, 3].max():.0f}), {np.median(touching):.0f} carry force "
          f"({touching.max():.0f}), force {np.median(late[:, 6]):.2f} N, gap >= {1e6 * np.nanmin(late[:, 7]):.3f} um, "
          f"{1e3 * np.median(late[:, 2]):.2f} ms a step (95 %: {1e3 * np.quantile(late[:, 2], 0.95):.2f})")  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="folder for inspection.png")
    out = parser.parse_args().out
    results = {friction: inspect(friction) for friction in (0.0, 0.3)}
    for friction, (rows, _) in results.items():
        report(friction, rows)
    if out is None:
        return
    out.mkdir(parents=True, exist_ok=True)
    draw(results, out / "inspection.png")


def draw(results, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(13, 4), width_ratios=[1.2, 1, 1])
    sim = results[0.3][1]
    axes[0].imshow(sinew.render(sim, size=(700, 700)))
    axes[0].set_axis_off()
    for friction, (rows, _) in results.items():
        axes[1].semilogy(rows[:, 0], 1e3 * np.maximum(rows[:, 1], 1e-9), label=f"friction {friction}")
        axes[2].plot(rows[:, 0], rows[:, 6], label=f"friction {friction}")
    axes[1].set(xlabel="time [s]", ylabel="distance of the tip from its target [mm]")
    axes[2].set(xlabel="time [s]", ylabel="normal force on the tube [N]")
    axes[1].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
