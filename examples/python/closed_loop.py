#!/usr/bin/env python3
"""The trunk's tip goes where it is told although its model is wrong: open and closed loop beside each other.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/python/closed_loop.py [closed_loop.png]

The robot is a second simulation with another mesh, 30 % softer, with friction in its cables and a load of 20 g at its
tip. A camera sees the tip 20 ms late and with 0.1 mm of noise.
"""

import sys
from pathlib import Path

import numpy as np
import sinew
from sinew import control

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"
CABLES = [f"{kind}_{k}" for kind in ("long", "short") for k in range(4)]
GOAL = np.array([0.03, 0.0, 0.18])
DIFFERENT = {"mesh": "{shape: trunk, element_size: 5 mm}", "stiffness": 0.7, "friction": 0.1, "load": "20 g"}


def trunk(*, mesh="{shape: trunk}", stiffness=1.0, friction=0.0, load="", more=()):
    """The trunk, hanging, at rest with slack cables; stiffness relative to the example's."""
    settings = ["gravity=0 0 9.81 m/s^2", f"bodies.trunk.mesh={mesh}",
                f"bodies.trunk.material.young_modulus={450 * stiffness} kPa", *more]
    settings += [f"actuators.{name}.command={{tension: 0 N}}" for name in CABLES]
    settings += [f"actuators.{name}.friction={friction}" for name in CABLES if friction]
    if load:
        settings.append(f"masses={{load: {{body: trunk, point: 0 0 190 mm, mass: {load}}}}}")
    sim = sinew.load(SCENE, set=settings)
    sim.solve_static()
    return sim


class Camera:
    """Sees a point late and with white noise.

    Parameters
    ----------
    place : (3,) m
        Where the point is at first.
    noise : float
        m, standard deviation of each coordinate.
    delay : int
        Samples.
    """

    def __init__(self, place, noise=1e-4, delay=2, seed=1):
        self._past = [np.array(place)] * (delay + 1)
        self._noise, self._random = noise, np.random.default_rng(seed)

    def see(self):
        return self._past[0] + self._noise * self._random.normal(size=3)

    def move(self, place):
        self._past = [*self._past[1:], np.array(place)]


def drive(loop, plant, camera, duration, closed=True):
    """Runs a loop with a plant. (steps,) true distances of the tip from its target, m."""
    errors = []
    for _ in range(round(duration / plant.time_step)):
        commands = loop.step({"tip": camera.see()} if closed else None, plant.time)
        loop.send(plant, commands)
        plant.step()
        camera.move(plant.effector("tip").position)
        target = loop.targets["tip"]
        target = target.at(plant.time) if isinstance(target, sinew.Target) else target
        errors.append(np.linalg.norm(plant.effector("tip").position - target))
    return np.array(errors)


def make(kind, command, **more):
    """A loop on a model of its own: 'open', 'resolved rate' or 'predictive'."""
    model = trunk()
    if kind == "predictive":
        return control.PredictiveController(model, {"tip": GOAL}, CABLES, command=command, delay=0.02, **more)
    return control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=6.0, command=command, delay=0.02, hold=0.0, **more)


def main():
    shown = {}
    print("mean distance of the tip from its target in the last second, tensions commanded (mm)")
    for kind in ("open", "resolved rate", "predictive"):
        plant, loop = trunk(**DIFFERENT), make(kind, "effort")
        shown[kind] = errors = drive(loop, plant, Camera(plant.effector("tip").position), 1.6, closed=kind != "open")
        least = f"{loop.least_eigenvalue:.2f} +- {loop.least_eigenvalue_std:.2f}"  # nan where nothing is measured
        print(f"  {kind:14} {1e3 * errors[-100:].mean():6.3f}  {loop.status}, least eigenvalue {least}")
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
