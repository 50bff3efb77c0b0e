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


@pytest.mark.filterwarnings("ignore:.*gaining-energy")
@pytest.mark.parametrize("radius", [0.95, 1.0])
@pytest.mark.parametrize("element", ["hex8", "tet4"])
def test_solved_steps_that_gain_energy_are_flagged(element, radius):
    """A soft bar that spins freely, with 15 steps a turn: generalized-alpha at high radii puts energy in, although each step is solved."""
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, 0], "time_step": 0.007,
                      "integrator": {"type": "generalized-alpha", "spectral_radius": radius},
                      "bodies": {"b": {"type": "fem", "element": element, "density": 1000.0, "position": [-0.05, -0.01, -0.01],
                                       "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.02},
                                       "material": {"model": "neo-hookean", "young_modulus": 5e5, "poisson_ratio": 0.3},
                                       "initial_velocity": {"angular": [0, 0, 60]}}}})
    body = sim.body("b")
    start, above = body.kinetic_energy, 0
    for _ in range(200):
        sim.step()
        if sim.report.status == "gaining-energy":
            break
        above = above + 1 if body.kinetic_energy + body.strain_energy > 1.2 * start else 0
        assert above < 2
    assert sim.report.status == "gaining-energy"


def test_a_linearisation_that_puts_energy_in_stops():
    """A soft beam that swings with one corotated linearisation in each step, which leaves most forces out of balance."""
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "integrator": "bdf2", "time_step": 0.02,
                      "solver": {"method": "one-linearisation", "tangent": "corotated"},
                      "bodies": {"b": {"type": "fem", "element": "tet4", "density": 1000.0,
                                       "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
                                       "material": {"model": "corotational", "young_modulus": 3e5, "poisson_ratio": 0.4},
                                       "fixed": [{"box": [-1e-6, -1, -1e-6, 1e-6, 1, 1e-6]}]}}})
    with pytest.raises(sinew.RunError, match="one linearisation leaves .* out of balance"):
        sim.run(2.0)
