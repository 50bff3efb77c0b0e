#!/usr/bin/env python3
"""The tip of the trunk reaches its target although the model is wrong: comparison of open and closed loops.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/python/closed_loop.py [closed_loop.png]

The robot is a second simulation with another mesh, 30 % softer, with friction in its cables and a load of 20 g at its
tip. A camera measures the tip with a delay of 20 ms and a noise of 0.1 mm.
"""

import sys
from pathlib import Path

import numpy as np
import sinew
from sinew import control

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"
CABLES = [f"{kind}_{k}" for kind in ("long", "short") for k in range(4)]
GOAL = np.array([0.03, 0.0, 0.18])
CAMERA = "sensors={camera: {type: marker, body: trunk, point: 0 0 195 mm, noise: 0.1 mm, delay: 20 ms, seed: 1}}"
DIFFERENT = {"mesh": "{shape: trunk, element_size: 6 mm}", "stiffness": 0.7, "friction": 0.1, "load": "20 g"}


def trunk(*, mesh="{shape: trunk}", stiffness=1.0, friction=0.0, load="", more=()):
    """The hanging trunk at rest with slack cables; `stiffness` is relative to the example."""
    # In a control loop, the next step removes what a step leaves out of balance. Exact equilibrium in every step may take hundreds of
    # iterations with friction in the cables.
    settings = ["gravity=0 0 9.81 m/s^2", "solver={equilibrium: following}", f"bodies.trunk.mesh={mesh}",
                f"bodies.trunk.material.young_modulus={450 * stiffness} kPa", *more]
    settings += [f"actuators.{name}.command={{tension: 0 N}}" for name in CABLES]
    settings += [f"actuators.{name}.friction={friction}" for name in CABLES if friction]
    if load:
        settings.append(f"masses={{load: {{body: trunk, point: 0 0 190 mm, mass: {load}}}}}")
    sim = sinew.load(SCENE, set=settings)
    sim.solve_static()
    return sim


def drive(loop, plant, duration):
    """Runs a loop with a plant. Returns the true distances of the tip from its target, (steps,) m."""
    errors = []
    for _ in range(round(duration / plant.time_step)):
        loop.send(plant, loop.step(time=plant.time))
        plant.step()
        target = loop.targets["tip"]
        target = target.at(plant.time) if isinstance(target, sinew.Target) else target
        errors.append(np.linalg.norm(plant.effector("tip").position - target))
    return np.array(errors)


def make(kind, command, plant, **more):
    """A loop with its own model and the camera of the plant: 'open' (no camera), 'resolved rate' or 'predictive'."""
    model, sensors = trunk(), None if kind == "open" else {"tip": plant.sensor("camera")}
    if kind == "predictive":
        return control.PredictiveController(model, {"tip": GOAL}, CABLES, command=command, sensors=sensors, **more)
    return control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=6.0, command=command, sensors=sensors, hold=0.0, **more)


def main():
    shown = {}
    print("mean distance of the tip from its target in the last second, tensions commanded (mm)")
    for kind in ("open", "resolved rate", "predictive"):
        plant = trunk(**DIFFERENT, more=[CAMERA])
        loop = make(kind, "effort", plant)
        shown[kind] = errors = drive(loop, plant, 1.6)
        least = f", least eigenvalue {loop.least_eigenvalue:.2f} +- {loop.least_eigenvalue_std:.2f}"
        print(f"  {kind:14} {1e3 * errors[-100:].mean():6.3f}  {loop.status}{'' if kind == 'open' else least}")
    if len(sys.argv) > 1:
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(7, 4))
        for label, errors in shown.items():
            axes.semilogy(0.01 * np.arange(1, len(errors) + 1), 1e3 * errors, label=label)
        axes.set(xlabel="time (s)", ylabel="tip from its target (mm)")
        axes.legend()
        figure.tight_layout()
        figure.savefig(sys.argv[1], dpi=90)


if __name__ == "__main__":
    main()
