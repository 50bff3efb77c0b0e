"""Estimators in scenes: forces from sensors, in combination with all other features."""
from pathlib import Path

import numpy as np
import pytest
import yaml

import sinew

PUSH = Path(__file__).resolve().parents[2] / "examples" / "finger" / "push.yaml"


def scene(**changes):
    return yaml.safe_load(PUSH.read_text()) | changes


def errors_over_run(sim, steps, true):
    """Errors and standard deviations of the estimate, (steps, 3) N."""
    push = sim.estimator("push")
    errors, deviations = [], []
    for _ in range(steps):
        sim.step()
        errors.append(push.forces["hand"] - true(sim.time))
        deviations.append(push.std.copy())
    return np.array(errors), np.array(deviations)


def hand(time):
    return np.array([0.3, 0.1, 0.0]) * (1.0 <= time < 2.0)


def test_a_push_is_found():
    sim = sinew.load(PUSH)
    assert sim.estimator("push").status == "not-started"
    errors, deviations = errors_over_run(sim, 300, hand)
    assert sim.estimator("push").status == "estimating"
    assert np.abs(errors[150:199].mean(axis=0)[:2]).max() < 0.01  # N, during the push
    late = np.linalg.norm(errors[99:103], axis=1)  # from 1 s on: load cells respond at once, the markers 20 ms later
    assert late[0] > 0.1 and late[3] < 0.1
    assert (np.abs(errors[20:99]) < 4.0 * deviations[20:99]).all()


def test_ellipsoids_hold_what_they_say():
    """For forces drawn from the prior, the error weighted by the inverse covariance is chi squared, three degrees of freedom."""
    rng = np.random.default_rng(7)
    squares = []
    for draw in range(60):
        tree = scene()
        force = 0.2 * rng.standard_normal(3)
        tree["loads"]["hand"] = {"type": "force", "body": "finger", "point": "-10 0 50 mm", "force": force.tolist(), "outside": "nearest"}
        tree["estimators"]["push"]["unknowns"]["hand"]["prior"] = "0.2 N"
        for k, one in enumerate(tree["sensors"].values()):
            one.pop("rate", None), one.pop("delay", None)
            one["seed"] = 100 * draw + k
        sim = sinew.load(tree)
        sim.solve_static()
        push = sim.estimator("push")
        error = push.mean - force
        squares.append(error @ np.linalg.solve(push.covariance, error))
    assert np.mean(squares) == pytest.approx(3.0, rel=0.35)  # theory: 3 +- 0.32
    assert 0.8 <= np.mean(np.array(squares) < 6.251) <= 0.97  # the 90 % ellipsoid


def test_an_estimator_acts_on_nothing():
    with_one, without = sinew.load(PUSH), sinew.load(scene(estimators={}))
    with_one.step(40)
    without.step(40)
    np.testing.assert_array_equal(with_one.body("finger").positions, without.body("finger").positions)


def test_states_and_clones_go_on_bit_for_bit(tmp_path):
    sim = sinew.load(PUSH)
    sim.step(105)
    sim.save_state(tmp_path / "state")
    clone, again = sim.clone(), sinew.load(PUSH)
    again.load_state(tmp_path / "state")
    for one in (sim, clone, again):
        one.step(30)
    for one in (clone, again):
        np.testing.assert_array_equal(one.estimator("push").mean, sim.estimator("push").mean)
        np.testing.assert_array_equal(one.estimator("push").covariance, sim.estimator("push").covariance)
        assert one.state_hash == sim.state_hash
    sim.reset()
    assert sim.estimator("push").status == "not-started"
    sim.step(5)
    fresh = sinew.load(PUSH)
    fresh.step(5)
    np.testing.assert_array_equal(sim.estimator("push").mean, fresh.estimator("push").mean)


def test_threads_give_the_same_bits():
    means = []
    for threads in (1, 2):
        sim = sinew.load(PUSH, threads=threads)
        sim.step(30)
        means.append(sim.estimator("push").mean)
    np.testing.assert_array_equal(*means)


def test_what_no_sensor_sees_is_named():
    """One load cell on a cable observes one direction."""
    tree = scene()
    tree["estimators"]["push"]["sensors"] = ["pull_east"]
    sim = sinew.load(tree)
    sim.step(3)
    push = sim.estimator("push")
    assert push.status == "unobservable"
    assert len(push.unobservable) >= 2 and "hand.y" in " ".join(push.unobservable)
    assert "the prior decides" in push.message
    assert push.singular_values[1] < 1e-9


def test_a_lost_sensor_is_told():
    tree = scene()
    tree["sensors"]["tip"]["dropout"] = "100 %"
    sim = sinew.load(tree)
    sim.step(40)
    push = sim.estimator("push")
    assert push.status == "sensors-lost" and push.lost == ["tip"] and "tip" in push.message


def test_a_static_solution_settles_the_estimate():
    tree = scene()
    tree["loads"]["hand"].pop("factor")
    tree["sensors"] = {name: {**one, "noise": "1 um" if one["type"] == "marker" else "0.1 mN"} for name, one in tree["sensors"].items()}
    for one in tree["sensors"].values():
        one.pop("rate", None), one.pop("delay", None)
    sim = sinew.load(tree)
    sim.solve_static()
    np.testing.assert_allclose(sim.estimator("push").forces["hand"], [0.3, 0.1, 0.0], atol=2e-3)


def test_estimates_are_recorded():
    rows = sinew.load(PUSH).run(0.2)
    assert rows["push.hand"].shape == rows["push.hand.std"].shape == (len(rows["time"]), 3)
    assert set(rows["push.status"]) <= {"not-started", "estimating", "unobservable"}


def chambered(**unknown):
    """A finger with an inflated, leaking chamber and two markers."""
    return {
        "sinew": 1, "time_step": "10 ms", "integrator": "quasi-static", "gravity": [0, 0, 0],
        "bodies": {"finger": {"type": "fem", "mesh": {"shape": "chambered-cylinder", "radius": "12 mm", "height": "60 mm",
                                                      "chamber_radius": "5 mm", "chamber_offset": "4 mm", "chamber_bottom": "10 mm",
                                                      "chamber_top": "50 mm", "element_size": "30 mm"}, "element": "tet4",
                              "material": {"model": "corotational", "young_modulus": "200 kPa", "poisson_ratio": 0.3},
                              "mass": "30 g", "fixed": {"set": "bottom"}}},
        "actuators": {"air": {"type": "chamber", "body": "finger", "surface": {"inside": "4 0 30 mm"},
                              "command": {"pressure": {"ramp": {"to": "10 kPa", "duration": "0.2 s"}}}}},
        "loads": {"leak": {"type": "pressure", "body": "finger", "surface": {"inside": "4 0 30 mm"}, "pressure": "-2 kPa"}},
        "sensors": {name: {"type": "marker", "body": "finger", "point": point, "outside": "nearest", "noise": "5 um", "seed": seed}
                    for name, point, seed in (("tip", "0 0 60 mm", 1), ("side", "12 0 40 mm", 2))},
        "estimators": {"watch": {"type": "filter", "sensors": ["tip", "side"],
                                 "unknowns": {"leak": {"pressure": {"actuator": "air"} | unknown, "prior": "5 kPa", "walk": "2 kPa"}}}},
    }


def test_a_leak_is_found():
    """With a commanded pressure, the estimate is the loss; with an unknown command, the whole pressure."""
    for unknown, true in (({}, -2e3), ({"command": "unknown"}, 8e3)):
        sim = sinew.load(chambered(**unknown))
        rows = sim.run(0.4)
        watch = sim.estimator("watch")
        assert watch.components == ["leak"] and watch.forces == {}
        assert watch.status == "estimating"
        assert abs(watch.efforts["leak"] - true) < 4.0 * watch.std[0] < 500.0
        assert rows["watch.leak"].shape == rows["watch.leak.std"].shape == rows["time"].shape


def test_a_pressure_behind_a_commanded_volume_is_found():
    """The estimator does not rely on the commanded volume and estimates the resulting pressure."""
    tree = chambered()
    tree["loads"] = {}
    tree["actuators"]["air"]["command"] = {"volume_growth": {"ramp": {"to": "0.2 ml", "duration": "0.2 s"}}}
    tree["sensors"]["gauge"] = {"type": "volume", "actuator": "air", "noise": "0.01 ml"}
    tree["estimators"]["watch"]["sensors"].append("gauge")
    sim = sinew.load(tree)
    sim.step(40)
    watch, pressure = sim.estimator("watch"), sim.actuator("air").pressure
    assert pressure > 500.0
    assert abs(watch.efforts["leak"] - pressure) < 4.0 * watch.std[0] < 0.5 * pressure


def test_a_tension_is_found_beside_a_force():
    """The tension of the cable is unknown; a load cell would show it at once, markers do so gradually."""
    tree = scene()
    tree["actuators"]["east"]["command"] = {"tension": {"steps": [["0 s", 0], ["0.3 s", "1 N"]]}}
    tree["estimators"]["push"]["sensors"] = ["tip", "middle", "low", "pull_north"]
    tree["estimators"]["push"]["unknowns"]["winch"] = {"tension": {"actuator": "east", "command": "unknown"}, "prior": "1 N"}
    sim = sinew.load(tree)
    push = sim.estimator("push")
    assert push.components == ["hand.x", "hand.y", "hand.z", "winch"]
    slack = []
    for _ in range(25):
        sim.step()
        slack.append(push.efforts["winch"])
    assert np.abs(slack[10:]).max() < 4.0 * push.std[3]
    sim.step(60)
    assert abs(push.efforts["winch"] - 1.0) < 4.0 * push.std[3] < 2.0
    tree["estimators"]["push"]["sensors"].append("pull_east")
    sim = sinew.load(tree)
    sim.step(85)
    push = sim.estimator("push")
    assert abs(push.efforts["winch"] - 1.0) < 0.06 and push.std[3] < 0.02


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda t: t["sensors"]["tip"].update(noise=0), "noise"),
        (lambda t: t["estimators"]["push"].update(sensors=["tip", "middel"]), "did you mean"),
        (lambda t: t["estimators"]["push"]["unknowns"]["hand"]["force"].update(point="0 0 0 mm", outside="error"), "nothing moves"),
        (lambda t: t["estimators"]["push"]["unknowns"]["hand"]["force"].update(point="0 0 300 mm", outside="error"), "outside"),
        (lambda t: t["estimators"]["push"]["unknowns"].update(air={"pressure": {"actuator": "east"}, "prior": "1 kPa"}), "type chamber"),
        (lambda t: t["estimators"]["push"]["unknowns"].update(pull={"tension": {"actuator": "west"}, "prior": "1 N"}), "not under"),
        (lambda t: t["estimators"]["push"]["unknowns"].update(pull={"tension": {"actuator": "east"}, "prior": "1 kPa"}), "Pa"),
        (lambda t: t["estimators"]["push"]["unknowns"].update({k: {"tension": {"actuator": "east"}, "prior": "1 N"} for k in "ab"}), "twice"),
        (lambda t: t["estimators"]["push"]["unknowns"].update(pull={"prior": "1 N"}), "tension"),
    ],
)
def test_what_cannot_be_estimated_is_an_error(change, words):
    tree = scene()
    change(tree)
    with pytest.raises(sinew.Error, match=words):
        sinew.load(tree)
