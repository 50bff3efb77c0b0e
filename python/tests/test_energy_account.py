"""The account of energy of dynamic runs: damping where efforts jump, and the work of motors and bases."""

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
                      "bodies": {"b": {"type": "fem", "element": element, "density": 1000.0, "pose": {"position": [-0.05, -0.01, -0.01]},
                                       "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.02},
                                       "material": {"model": "neo-hookean", "young_modulus": 5e5, "poisson_ratio": 0.3},
                                       "velocity": {"angular": [0, 0, 60]}}}})
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


SECOND_ORDER = pytest.mark.parametrize("integrator", ["bdf2", {"type": "generalized-alpha", "spectral_radius": 0.8}], ids=["bdf2", "alpha"])


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


@SECOND_ORDER
def test_the_work_of_a_motor_is_of_second_order(integrator):
    """A mass on a slider under a cosine force: v = F/(m w) sin(w t), and the work is m v^2/2, zero after every half period."""
    mass, force, period = 0.2, 1.0, 0.4
    w = 2 * np.pi / period
    peak = 0.5 * mass * (force / mass / w) ** 2
    errors = []
    for h in (8e-3, 4e-3, 2e-3, 1e-3):
        sim = sinew.load({"sinew": 1, "integrator": integrator, "time_step": h,
                          "bodies": {"b": {"type": "rigid", "shape": {"box": [0.02] * 3}, "mass": mass}},
                          "joints": {"j": {"type": "slider", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": "x"}},
                          "actuators": {"m": {"type": "linear-motor", "joint": "j", "command": {
                              "force": {"sine": {"amplitude": force, "period": period, "phase": np.pi / 2}}}}}})
        error = 0.0
        for _ in range(round(2.0 / h)):
            sim.step()
            assert sim.report.status == "solved"
            error = max(error, abs(sim.ledger["actuator_work"] - peak * np.sin(w * sim.time) ** 2))
        errors.append(error / peak)
    assert orders(errors)[-1] > 1.8 and errors[-1] < 1e-3


def carried(integrator, h, damping):
    """Work, its rest in the account, and the energies every 8 ms, of an elastic block whose base goes out and back in 0.4 s."""
    sim = sinew.load({"sinew": 1, "integrator": integrator, "time_step": h,
                      "bodies": {"b": {"type": "fem", "element": "hex8", "density": 1000.0, "fixed": [{"set": "z_min"}],
                                       "mesh": {"shape": "block", "length": 0.01, "width": 0.01, "height": 0.04, "element_size": 0.01},
                                       "material": {"model": "neo-hookean", "young_modulus": 1e5, "poisson_ratio": 0.4},
                                       "damping": {"stiffness": damping}}}})
    rows = []
    for k in range(1, round(0.8 / h) + 1):
        s = min(k * h / 0.4, 1.0)
        bump = (4 * s * (1 - s)) ** 4
        sway = bump * np.sin(2 * np.pi * s)
        sim.body("b").move_base([0.02 * bump, 0, 0.01 * sway], [0, 0.3 * sway, 0])
        sim.step()
        assert sim.report.status == "solved"
        if k * h / 8e-3 == pytest.approx(round(k * h / 8e-3), abs=1e-9):
            ledger = sim.ledger
            rows.append([ledger[name] for name in ("outside_work", "numerical_loss", "dissipation", "strain_energy", "kinetic_energy")])
    return np.array(rows).T


@SECOND_ORDER
def test_the_account_of_a_body_on_a_moving_base_closes(integrator):
    """The base's work is all that goes in: it is found again as vibration, or was damped."""
    works, losses = [], []
    for h in (4e-3, 2e-3, 1e-3, 5e-4):
        work, loss, _, strain, kinetic = carried(integrator, h, 0.0)
        works.append(work)
        losses.append(np.abs(loss).max())
        # At rest, the base does no work on the block that vibrates on.
        assert np.abs(np.diff(work[50:])).max() < 1e-8 * work.max()
    assert orders(losses)[-1] > 1.8 and losses[-1] < 3e-4 * work.max()
    assert orders([np.abs(a - b).max() for a, b in zip(works, works[1:])])[-1] > 1.8
    assert work[-1] == pytest.approx(strain[-1] + kinetic[-1], abs=3e-4 * work.max())
    work, loss, dissipation, strain, kinetic = carried(integrator, 1e-3, 5e-3)
    assert strain[-1] + kinetic[-1] < 1e-3 * work.max(), "it has come to rest"
    assert work[-1] > 0.1 * work.max() and work[-1] == pytest.approx(dissipation[-1], abs=1e-3 * work.max())


@SECOND_ORDER
def test_the_work_of_a_prescribed_body_is_the_energy_of_what_it_carries(integrator):
    """A block welded to a cart that goes to and fro: m v^2/2, which is zero after every half period."""
    mass, amplitude, period = 0.3, 0.02, 0.4
    w = 2 * np.pi / period
    errors = []
    for h in (4e-3, 2e-3, 1e-3):
        sim = sinew.load({"sinew": 1, "integrator": integrator, "time_step": h,
                          "bodies": {"cart": {"type": "rigid", "shape": {"box": [0.02] * 3}, "motion": {
                                         "x": {"sine": {"mean": amplitude, "amplitude": amplitude, "period": period, "phase": -np.pi / 2}}}},
                                     "b": {"type": "rigid", "shape": {"box": [0.02] * 3}, "mass": mass, "pose": {"position": [0, 0, 0.02]}}},
                          "joints": {"w": {"type": "weld", "bodies": ["cart", "b"]}}})
        # The acceleration jumps at the start, whose error is of second order too, but larger.
        sim.step(round(period / h))
        first, error = sim.ledger["outside_work"], 0.0
        for _ in range(round(2 * period / h)):
            sim.step()
            assert sim.report.status == "solved"
            exact = 0.5 * mass * (amplitude * w * np.sin(w * sim.time)) ** 2
            error = max(error, abs(sim.ledger["outside_work"] - first - exact))
        peak = 0.5 * mass * (amplitude * w) ** 2
        assert abs(first) < 0.02 * peak * (h / 1e-3) ** 2
        errors.append(error / peak)
    assert orders(errors)[-1] > 1.8 and errors[-1] < 1e-3, errors
