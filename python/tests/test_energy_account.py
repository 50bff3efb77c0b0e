"""The account of energy of dynamic runs: damping where efforts jump."""

import numpy as np
import pytest
import sinew


def arm(integrator, step, torques, hold):
    """A light, damped arm of constant curvature, whose torque takes a new value every `hold` seconds."""
    segment = {"length": 0.03, "mass": 0.01, "stiffness": 0.02, "damping": 2e-4}
    steps = [[k * hold + (1e-7 if k else 0), torque] for k, torque in enumerate(torques)]
    return sinew.load({"sinew": 1, "integrator": integrator, "time_step": step,
                       "bodies": {"a": {"type": "pcc", "segments": [segment | {"bending": "spatial"}, segment]}},
                       "actuators": {"t": {"type": "torque", "body": "a", "segment": 1, "command": {"torque": {"steps": steps}}}}})


def path_of(sim, count, every):
    path, flags = [], 0
    for k in range(1, count + 1):
        sim.step()
        flags += sim.report.status == "gaining-energy"
        if k % every == 0:
            path.append(sim.body("a").positions.ravel().copy())
    return np.array(path), flags


@pytest.mark.parametrize("integrator", ["bdf2", "generalized-alpha", "backward-euler"])
def test_a_damped_arm_whose_torque_jumps_gains_no_energy(integrator):
    """Each jump gives velocities that change sign in the next step; the motion is that of a quarter of the step."""
    random = np.random.default_rng(7)
    torques = random.uniform(-5e-3, 8e-3, 12)
    hold, step = 5e-3, 6.25e-4
    coarse, flags = path_of(arm(integrator, step, torques, hold), 96, 1)
    fine, _ = path_of(arm(integrator, step / 4, torques, hold), 384, 4)
    amplitude = np.abs(fine - fine[0]).max()
    assert np.abs(coarse - fine).max() < 0.05 * amplitude
    assert flags == 0


def test_a_run_that_gains_energy_is_flagged():
    """A soft beam that swings with one corotated linearisation in each step."""
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "integrator": "bdf2", "time_step": 0.02,
                      "solver": {"method": "one-linearisation", "tangent": "corotated"},
                      "bodies": {"b": {"type": "fem", "element": "tet4", "density": 1000.0,
                                       "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
                                       "material": {"model": "corotational", "young_modulus": 3e5, "poisson_ratio": 0.4},
                                       "fixed": [{"box": [-1e-6, -1, -1e-6, 1e-6, 1, 1e-6]}]}}})
    flags = 0
    try:
        for _ in range(100):
            sim.step()
            flags += sim.report.status == "gaining-energy"
    except sinew.Error:
        flags += 1
    assert flags > 0
