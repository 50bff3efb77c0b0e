"""Bending actuators from Python."""

import re
from pathlib import Path

import numpy as np
import pytest
import sinew
from sinew import pcc

SIZES = {"length": 0.1, "chamber_radius": 6e-3, "wall_thickness": 2e-3}


def actuator(**changes):
    return pcc.BendingActuator(**{**SIZES, "modulus": 0.2e6, **changes})


def wave(amplitude, period=5.0, step=0.02):
    time = np.arange(0.0, period, step)
    return time, amplitude / 2 * (1 - np.cos(2 * np.pi * time / period))


def test_equation_of_motion_from_its_own_energies():
    model = actuator(inclination=0.7, order=None)
    theta, rate, pressure, h = 0.9, 4.0, 50e3, 1e-3

    def potential(q):
        energy = model.energies(q, 0.0, pressure)
        return energy["strain"] + energy["gravity"] - pressure * model.chamber_volume(q)

    slope = (potential(theta + h) - potential(theta - h)) / (2 * h)
    turn = (model.inertia(theta + h) - model.inertia(theta - h)) / (2 * h)
    expected = -(slope + turn * rate**2 / 2) / model.inertia(theta)
    assert model.acceleration(theta, rate, pressure) == pytest.approx(expected, rel=1e-6)
    stiffness = (potential(theta + h) - 2 * potential(theta) + potential(theta - h)) / h**2
    assert model.stiffness(theta, pressure) == pytest.approx(stiffness, rel=1e-5)
    assert model.energies(theta, rate, pressure)["kinetic"] == pytest.approx(
        model.inertia(theta) * rate**2 / 2)


def test_arguments_broadcast():
    model = actuator()
    theta = np.linspace(-0.5, 1.5, 5)
    found = model.acceleration(theta[:, None], 0.0, np.array([0.0, 50e3]))
    assert found.shape == (5, 2)
    assert found[3, 1] == model.acceleration(theta[3], 0.0, 50e3)
    assert isinstance(model.acceleration(0.1, 0.0, 0.0), float)
    assert model.point(theta).shape == (5, 2)
    assert model.point(0.5).shape == (2,)
    assert model.point(0.5, np.linspace(0, 1, 7)).shape == (7, 2)
    with pytest.raises(sinew.Error) as error:
        model.acceleration([1.0, 2.0], [0.0, 0.0, 0.0], 0.0)
    assert error.value.kind == "wrong-shape"


def test_the_tip_is_on_the_arc():
    model = actuator()
    assert model.point(0.0) == pytest.approx([0, -0.1])
    assert model.point(np.pi / 2) == pytest.approx([0.1 / (np.pi / 2), -0.1 / (np.pi / 2)])
    assert actuator(inclination=np.pi / 2).point(np.pi / 2)[1] > 0  # level: bends upwards


def test_simulate_and_step_by_step_agree():
    model = actuator(stiffness_damping=5e-3)
    time, pressure = wave(60e3)
    run = model.simulate(time, pressure, longest_step=0.02)
    motion = pcc.BendingMotion(model)
    for k, (t, p) in enumerate(zip(time[1:], pressure[1:]), 1):
        angle = motion.step(t - time[k - 1], p)
        assert angle == pytest.approx(run["angle"][k], abs=1e-12)
    assert motion.tip == pytest.approx(run["tip"][-1])
    assert motion.time == pytest.approx(time[-1])
    assert run["tip"].shape == (len(time), 2)
    # The pressure changes so slowly that the actuator stays in equilibrium.
    assert run["angle"] == pytest.approx(model.equilibrium(pressure), abs=0.02)


def test_taylor_and_exact_models():
    model = actuator()
    exact = pcc.BendingActuator(**{**model.parameters, "order": None})
    theta = np.linspace(0, 1.2, 50)
    bound = model.taylor_error(0.0, 1.2, 0.0)
    off = np.abs(exact.energies(theta, 0.0, 0.0)["strain"] - model.energies(theta, 0.0, 0.0)["strain"])
    assert 0.2 * bound["strain"] < off.max() <= bound["strain"]
    assert np.abs(exact.inertia(theta) - model.inertia(theta)).max() <= bound["inertia"]
    assert exact.taylor_error(0.0, 1.2, 0.0)["torque"] == 0.0


def test_parameters_make_the_same_again():
    model = actuator(inclination=0.3, filling_density=1000.0, mass_line="section", order=7)
    again = pcc.BendingActuator(**model.parameters)
    assert again.acceleration(0.4, 2.0, 30e3) == model.acceleration(0.4, 2.0, 30e3)
    first, second = model.parameters, again.parameters
    assert first.pop("modulus").value(0.0) == second.pop("modulus").value(0.0)
    assert first == second


def test_published_modulus_within_its_range():
    modulus = pcc.published_modulus()
    assert modulus.kind == "bending" and modulus.pressure_range == (10e3, 110e3)
    assert modulus.value([20e3, 50e3]) == pytest.approx(
        np.polynomial.polynomial.polyval([20e3, 50e3], modulus.coefficients))
    assert modulus.shear(50e3) == pytest.approx(modulus.value(50e3) / 4)
    with pytest.raises(sinew.Error) as error:
        actuator(modulus=modulus).equilibrium(0.0)
    assert error.value.kind == "out-of-range"
    assert "110000" in str(error.value)
    held = actuator(modulus=pcc.published_modulus("hold"))
    assert held.equilibrium(0.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("changes", "kind", "word"), [
    ({"length": -0.1}, "out-of-range", "-0.1 m"),
    ({"chamber_radius": 0.0}, "out-of-range", "chamber_radius"),
    ({"outer_radius": 5e-3}, "out-of-range", "outer_radius"),
    ({"modulus": -1.0}, "out-of-range", "-1 Pa"),
    ({"modulus": "stiff"}, "wrong-type", "modulus"),
    ({"silicone_density": float("nan")}, "not-finite", "silicone_density"),
    ({"order": 1}, "out-of-range", "order"),
    ({"mass_line": "middle"}, "unknown-choice", "section"),
])
def test_bad_parameters(changes, kind, word):
    with pytest.raises(sinew.Error) as error:
        actuator(**changes)
    assert error.value.kind == kind
    assert word in str(error.value)


def test_bad_histories():
    model = actuator()
    for time, pressure, kind in [
        ([0.0, 0.0], [0.0, 1.0], "non-monotonic-time"),
        ([0.0, 1.0], [0.0], "wrong-length"),
        ([0.0], [0.0], "too-few-points"),
        ([0.0, 1.0], [0.0, np.nan], "not-finite"),
        ([[0.0, 1.0]], [0.0, 1.0], "wrong-shape"),
    ]:
        with pytest.raises(sinew.Error) as error:
            model.simulate(time, pressure)
        assert error.value.kind == kind
    with pytest.raises(sinew.RunError) as error:
        model.simulate([0.0, 1.0], [0.0, 1e9])
    assert error.value.kind == "not-converged"
    with pytest.raises(sinew.Error) as error:
        model.simulate([0.0, 1.0], [0.0, 1.0], integrator="euler")
    assert error.value.kind == "unknown-choice"
    with pytest.raises(sinew.Error) as error:
        pcc.BendingModulus([1e5, 1.0])
    assert error.value.kind == "missing-key"


def test_calibration_from_a_file(tmp_path):
    truth = actuator(stiffness_damping=4e-3)
    time, pressure = wave(70e3)
    run = truth.simulate(time, pressure)
    file = tmp_path / "tip.csv"
    np.savetxt(file, np.c_[time, 1e3 * run["tip"], 1e-3 * pressure], delimiter=",",
               header="time_s,x_mm,y_mm,pressure_kPa", comments="")
    record = pcc.read_tip_record(file)
    assert record.name == "tip"
    assert record.pressure == pytest.approx(pressure)
    start = actuator(stiffness_damping=4e-3, modulus=0.5e6)
    fit = pcc.fit_modulus(start, record, kind="shear")
    assert fit.converged and not fit.at_bound
    assert fit.actuator.parameters["modulus"].value(0.0) == pytest.approx(0.2e6, rel=1e-4)
    before = pcc.tip_errors(start.simulate(time, pressure)["tip"], record.tip, 0.1)
    assert before.mean_of_length > 0.05 > 1e-4 > fit.errors[0].mean_of_length
    assert fit.tips[0].shape == (len(time), 2)


def test_calibration_without_pressures(tmp_path):
    file = tmp_path / "tip.csv"
    file.write_text("time_s,x_m,y_m\n0,0,-0.1\n1,0,-0.1\n2,0,-0.1\n")
    record = pcc.read_tip_record(file)
    assert record.pressure is None
    with pytest.raises(sinew.Error) as error:
        pcc.fit_modulus(actuator(), record)
    assert error.value.kind == "missing-key"
    with pytest.raises(sinew.Error) as error:
        file.write_text("time_s,x_m\n0,0\n1,0\n2,0\n")
        pcc.read_tip_record(file)
    assert error.value.kind == "wrong-columns" and "tip.csv" in str(error.value)


def test_tip_errors_by_hand():
    errors = pcc.tip_errors([[3e-3, 4e-3], [0, 0]], [[0, 0], [0, 1e-3]], 0.1)
    assert errors.mean == pytest.approx(3e-3)
    assert errors.largest_of_length == pytest.approx(0.05)
    assert errors.mean_absolute == pytest.approx([1.5e-3, 2.5e-3])
    assert errors.root_mean_square == pytest.approx(np.sqrt([4.5e-6, 8.5e-6]))


def test_the_page(tmp_path):
    text = (Path(__file__).resolve().parents[2] / "docs" / "bending_actuator.md").read_text(encoding="utf-8")
    names = {}
    for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        exec(compile(block, "docs/bending_actuator.md", "exec"), names)
    assert names["run"]["angle"].max() == pytest.approx(2.1, abs=0.1)
    assert abs(names["motion"].angle - names["run"]["angle"][-1]) < 1e-3


def test_what_the_errata_say():
    modulus = pcc.published_modulus()
    roots = np.roots(modulus.coefficients[::-1])
    real = roots[np.abs(roots.imag) < 1e-6].real
    assert real == pytest.approx([-20.68e3], abs=10)
    assert modulus.value(27e3) == pytest.approx(818e3, abs=1e3)
    assert modulus.value(110e3) == pytest.approx(617e3, abs=1e3)
    level = {"modulus": modulus, "gravity": 0.0}
    assert actuator(**level).linear_angle(90e3) == pytest.approx(1.50, abs=0.005)
    assert actuator(**level, order=None).equilibrium(90e3) == pytest.approx(2.03, abs=0.005)
    # Pressures at which models of odd order have no equilibrium and exact energies have one.
    for order, pressure in ((3, 90e3), (5, 100e3)):
        with pytest.raises(sinew.RunError):
            actuator(**level, order=order).equilibrium(pressure)
        assert actuator(**level, order=order).equilibrium(0.8 * pressure) < 2.2
        assert actuator(**level, order=None).equilibrium(pressure) < 2.6


def test_angles_of_no_actuator():
    for theta in (7.0, -6.5):
        with pytest.raises(sinew.Error) as error:
            actuator().acceleration([0.0, theta], 0.0, 0.0)
        assert error.value.kind == "out-of-range"
