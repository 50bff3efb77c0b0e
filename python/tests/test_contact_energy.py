"""Effect of steps on the energy of pivoting rigid bodies."""

import numpy as np
import pytest
import sinew

G, SIZE = 9.81, (0.06, 0.04, 0.02)
FLOOR = {"plane": {"normal": [0.0, 0.0, 1.0]}}


def box(position, rotation, velocity):
    return {"type": "rigid", "shape": {"box": list(SIZE)}, "density": 1000.0, "velocity": velocity,
            "pose": {"position": list(position), "rotation": list(rotation)}}


def make(bodies, contacts, step, integrator):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": [0.0, 0.0, -G], "bodies": bodies,
                       "contacts": contacts})


def changes(sim, duration):
    """(steps - 1,) changes of kinetic and gravity energy per step, relative to weight times the longest edge of a box."""
    energy = []
    for _ in range(round(duration / sim.time_step)):
        sim.step()
        energy.append(sim.ledger["kinetic_energy"] + sim.ledger["gravity_energy"])
    mass = sum(sim.body(name).mass for name in sim.bodies if name.startswith("box"))
    return np.diff(energy) / (mass * G * SIZE[0])


def test_a_pivoting_box_gains_in_proportion_to_the_step():
    """The gap is enforced at the end of a step, so f does the work f r (w h)^2/2 per step; the sum is of first order in h."""
    most, sums = [], []
    for step in (2e-3, 1e-3, 5e-4):
        spinning = box([0.0, 0.0, 0.05], [0.0, 0.5, 0.0], {"linear": [0.0, 0.0, 0.0], "angular": [0.0, 20.0, 0.0]})
        sim = make({"box": spinning}, {"floor": {"body": "box", "surface": FLOOR}}, step, "backward-euler")
        change = changes(sim, 0.3)
        most.append(change.max())
        sums.append(change[change > 0.0].sum())
    assert most[-1] > 1e-7
    assert np.log2(np.divide(most[:-1], most[1:])) == pytest.approx(2.0, abs=0.1)
    assert np.log2(np.divide(sums[:-1], sums[1:])) == pytest.approx(1.0, abs=0.1)
    assert sums[0] < 1e-3
