"""Identification from Python."""

import time

import numpy as np
import pytest
import sinew
from sinew import identify, pcc

LENGTHS = [0.14] * 4
MASSES = np.array([0.190, 0.146, 0.090, 0.090])
TIME = np.linspace(0.0, 3.0, 151)
POSES = {"a": [0.9, 0.4, 0.6, 0.5], "b": [-0.9, 0.7, -0.6, 0.8]}


def arm(masses=MASSES, stiffness=0.108, damping=4.2e-3, **more):
    return pcc.Arm(LENGTHS, masses, stiffness, damping, **more)


def record(robot, name, seed=1, noise=3e-4):
    seen = identify.predict_motion(robot, TIME, POSES[name])
    seen += noise * np.random.default_rng(seed).standard_normal(seen.shape)
    seen[20:30, 2] = np.nan
    return identify.MotionRecord(TIME, seen, name=name)


def test_a_passive_arm_is_found(tmp_path):
    records = [record(arm(), name) for name in POSES]
    guess = arm(MASSES * [0.9, 1, 0.85, 1.15], 0.0972, 3.4e-3)
    found = identify.fit_arm(guess, records, fixed=["mass_1"], mass_spread=0.9, stiffness_spread=0.5,
                             damping=(1e-4, 2e-2))
    fit = found.fit
    assert fit.converged and found.undetermined == 0 and not fit.at_bounds
    for name, truth in {"mass_0": 0.19, "mass_3": 0.09, "stiffness": 0.108, "damping": 4.2e-3}.items():
        low, high = fit.intervals[name]
        assert low - (high - low) < truth < high + (high - low)
        assert fit.standard_errors[name] < 0.15 * truth
    assert fit.standard_errors["mass_1"] == 0.0
    assert "mass_1" in str(found) and "known" in str(found)
    assert found.records[0].predicted.shape == (151, 4, 3)
    assert abs(found.arm.stiffness[0] - fit.values["stiffness"]) < 1e-15
    path = tmp_path / "motion.csv"
    path.write_text(records[0].csv())
    again = identify.read_motion(path, 4)
    np.testing.assert_array_equal(again.positions, records[0].positions)
    assert identify.validate_arm(found, [again])[0].nrmse < 0.05


def test_scale_is_reported():
    found = identify.fit_arm(arm(), [record(arm(), "a")])
    assert found.undetermined == 1
    weights = found.fit.directions[-1]["weights"]
    own = np.array([weights[name] for name in ("mass_0", "stiffness", "damping")])
    np.testing.assert_allclose(own, own[0], rtol=1e-4)
    assert "not determined" in str(found)


def test_youngs_modulus_of_finite_elements():
    # The tip of a sagging finite-element cantilever is measured under three accelerations.
    def scene(modulus, gravity):
        return sinew.load({
            "sinew": 1, "integrator": "quasi-static", "gravity": [0, 0, -gravity],
            "bodies": {"beam": {"type": "fem", "density": 1000,
                                "mesh": {"shape": "block", "length": 0.1, "width": 0.01, "height": 0.01,
                                         "element_size": 0.005},
                                "material": {"young_modulus": modulus, "poisson_ratio": 0.4},
                                "fixed": [{"box": [-1e-6, -1, -1, 1e-6, 1, 1]}]}},
            "effectors": {"tip": {"body": "beam", "point": [0.1, 0.0, 0.0], "outside": "nearest"}}})

    def predict(parameters):
        tips = []
        for gravity in (1.0, 2.0, 3.0):
            sim = scene(parameters["young_modulus"], gravity)
            sim.solve_static()
            tips.append(np.array(sim.effector("tip").position))
        return np.array(tips)

    truth = 500e3
    measured = predict({"young_modulus": truth}) + 1e-5 * np.random.default_rng(3).standard_normal((3, 3))
    fit = identify.fit(predict, measured, {"young_modulus": (300e3, 100e3, 2e6)}, step=1e-3)
    low, high = fit.intervals["young_modulus"]
    assert low < truth < high
    assert fit.standard_errors["young_modulus"] < 0.05 * truth


def test_errors_of_the_callback_come_through():
    def predict(parameters):
        raise ValueError("mine")

    with pytest.raises(ValueError, match="mine"):
        identify.fit(predict, [1.0, 2.0], {"a": 1.0})
    with pytest.raises(sinew.Error) as raised:
        identify.fit(lambda p: [p["a"]], [1.0, 2.0], {"a": 1.0})
    assert raised.value.kind == "wrong-length"
    with pytest.raises(sinew.Error) as raised:
        identify.fit(lambda p: [p["a"]] * 2, [1.0, 2.0], {"a": (1.0, 3.0, 2.0)})
    assert raised.value.kind == "contradictory-limits"


def test_missing_measurements_are_refused_unless_they_are_meant():
    def predict(p):
        return [p["a"], 2 * p["a"], 3 * p["a"]]

    with pytest.raises(sinew.Error) as raised:
        identify.fit(predict, [1.0, np.nan, 3.0], {"a": 2.0})
    assert raised.value.kind == "not-finite" and "1 of 3" in str(raised.value) and "number 1" in str(raised.value)
    fit = identify.fit(predict, [1.0, np.nan, 3.0], {"a": 2.0}, allow_missing=True)
    assert fit.values["a"] == pytest.approx(1.0) and np.isnan(fit.residual[1]) and not fit.stopped


def test_a_time_limit_keeps_the_best_parameters():
    seen = []

    def predict(p):
        seen.append(p["a"])
        time.sleep(0.02)
        return np.exp(p["a"] * np.linspace(0.0, 2.0, 20))

    measured, told = np.exp(np.linspace(0.0, 2.0, 20)), []
    fit = identify.fit(predict, measured, {"a": (2.5, 0.0, 5.0)}, time_limit=0.25, progress=lambda *now: told.append(now))
    assert fit.stopped and not fit.converged
    assert len(seen) < 25  # about 12 in the time, and two for the intervals
    assert fit.cost < fit.start_cost
    assert fit.cost <= min(cost for _, cost, _ in told) * (1 + 1e-12) and fit.values["a"] == told[-1][2]["a"]
    assert [n for n, _, _ in told] == list(range(1, len(told) + 1))
    costs = [cost for _, cost, _ in told]
    assert costs == sorted(costs, reverse=True)
    with pytest.raises(sinew.Error) as raised:
        identify.fit(predict, measured, {"a": 1.0}, time_limit=0.0)
    assert raised.value.kind == "out-of-range"


def test_a_fit_prints_its_progress(capfd):
    def predict(p):
        time.sleep(0.3)
        return [p["a"], p["a"] ** 2]

    identify.fit(predict, [2.0, 4.0], {"a": 1.0}, progress=True, time_limit=2.0)
    assert "lowest cost" in capfd.readouterr().err
    identify.fit(predict, [2.0, 4.0], {"a": 1.0}, progress=False, time_limit=1.2)
    assert capfd.readouterr().err == ""


def test_cylinder_and_actuator():
    truth = pcc.second_order_cylinder(0.9, 15.0, 0.6, 0.01)
    time = 0.01 * np.arange(1000)
    generator = np.random.default_rng(1)

    def trial(seed):
        command = pcc.Excitation(3e-5, seed=seed).at(time)
        return command, truth.simulate(command) + 1e-7 * generator.standard_normal(len(time)), 0.01

    cylinder, fit, trials = identify.fit_cylinder([trial(1), trial(2)])
    assert abs(cylinder.gain - 0.9) < 0.01
    assert fit.cost <= fit.start_cost
    assert len(trials) == 2
    assert identify.validate_cylinder(cylinder, [trial(9)])[0]["nrmse"] < 0.05

    true = pcc.FluidicActuator(4e12, delay=0.085)
    volume = pcc.Excitation(2.5e-5, seed=4)
    found, fit = identify.fit_actuator(time, volume.at(time), true.torque(volume.at(time - 0.085)))
    assert abs(found.delay - 0.085) < 2e-3
    np.testing.assert_allclose(found.volume(found.torque([-1e-5, 2e-5])), [-1e-5, 2e-5], rtol=1e-12)


def test_bad_input_is_named():
    for kind, make in {
        "non-monotonic-time": lambda: identify.MotionRecord([0, 1, 1], np.zeros((3, 4, 3))),
        "too-few-points": lambda: identify.fit_arm(
            arm(), [identify.MotionRecord([0, 1, 2], np.random.default_rng(1).random((3, 4, 3)))]),
        "wrong-length": lambda: identify.MotionRecord([0, 1, 2], np.zeros((4, 4, 3))),
        "out-of-range": lambda: arm(masses=[0.1, 0.1, 0.1, -0.1]),
        "unknown-choice": lambda: identify.fit_arm(arm(), [record(arm(), "a")], start="flying"),
    }.items():
        with pytest.raises(sinew.Error) as raised:
            make()
        assert raised.value.kind == kind
