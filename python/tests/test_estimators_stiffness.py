"""Estimators of scenes that find the stiffness of a body, alone and together with forces."""
import re

import numpy as np
import pytest
import scipy.stats

import sinew

PRIOR = 0.3  # standard deviation of the logarithm of the factor


def beam(integrator="quasi-static", **changes):
    """A soft beam that bends under its own weight, measured by two markers."""
    return {
        "sinew": 1, "time_step": "10 ms", "integrator": integrator, "gravity": "0 0 -9.81 m/s^2",
        "bodies": {"beam": {"type": "fem", "mesh": {"shape": "block", "length": "60 mm", "width": "10 mm", "height": "10 mm",
                                                    "element_size": "10 mm"}, "element": "tet4",
                            "material": {"model": "corotational", "young_modulus": "100 kPa", "poisson_ratio": 0.3},
                            "density": "1000 kg/m^3", "damping": {"stiffness": "2 ms"}, "fixed": {"set": "x_min"}}},
        "sensors": {"tip": {"type": "marker", "body": "beam", "point": "60 10 10 mm", "noise": "0.1 mm", "seed": 3},
                    "middle": {"type": "marker", "body": "beam", "point": "30 0 10 mm", "noise": "0.1 mm", "seed": 4}},
        "estimators": {"watch": {"type": "filter", "sensors": ["tip", "middle"], "rank": 6, "unknowns": {
            "soft": {"stiffness": {"body": "beam"}, "prior": PRIOR}}}},
    } | changes


def twin(tree, logarithm, seed):
    """A simulation whose beam has its moduli multiplied by exp(logarithm), which the estimator does not know."""
    for k, sensor in enumerate(tree["sensors"].values()):
        sensor["seed"] = 100 * seed + k
    sim = sinew.load(tree)
    sim.body("beam").stiffness_factor = np.exp(logarithm)
    return sim


def check_ellipsoids(squares, size):
    """Squared errors relative to the covariance follow chi squared: their mean lies within 3.3 of its standard deviations, and the number
    of errors in the 90 % ellipsoids is likely."""
    count = len(squares)
    assert abs(np.mean(squares) - size) < 3.3 * np.sqrt(2.0 * size / count)
    inside = scipy.stats.binom(count, 0.9)
    assert inside.ppf(1e-3) <= np.sum(np.array(squares) < scipy.stats.chi2.ppf(0.9, size)) <= inside.ppf(1.0 - 1e-3)


@pytest.mark.parametrize("element", ["tet10", "hex8", "tet4-patch"])
def test_a_factor_is_another_modulus(element):
    """A stiffness factor has the effect of a larger modulus on motion, forces, stiffness and energy, also with viscosity and softening."""
    material = {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.45,
                "viscosity": [{"relative_modulus": 0.3, "relaxation_time": "30 ms"}]}
    pair = []
    for modulus, peak, factor in (("100 kPa", "10 Pa", 1.7), ("170 kPa", "17 Pa", 1.0)):
        tree = beam("bdf2", estimators={}, probes={})
        tree["bodies"]["beam"] |= {"element": element, "material": {**material, "young_modulus": modulus,
                                                             "softening": {"r": 2, "m": peak, "beta": 0.1}}}
        sim = sinew.load(tree)
        sim.body("beam").stiffness_factor = factor
        sim.step(10)
        pair.append(sim)
    one, other = (sim.body("beam") for sim in pair)
    np.testing.assert_allclose(one.positions, other.positions, atol=1e-9)
    np.testing.assert_allclose(one.velocities, other.velocities, atol=1e-6)
    np.testing.assert_allclose(one.internal_forces(), other.internal_forces(), rtol=1e-4, atol=1e-8)
    assert abs(one.stiffness() - other.stiffness()).max() < 1e-6 * abs(other.stiffness()).max()
    assert one.strain_energy == pytest.approx(other.strain_energy, rel=1e-5)
    clone = pair[0].clone()
    assert clone.body("beam").stiffness_factor == 1.7
    pair[0].reset()
    assert one.stiffness_factor == 1.0
    for wrong in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(sinew.Error, match="out-of-range"):
            one.stiffness_factor = wrong


def test_a_change_of_stiffness_is_outside_work():
    """In a bent beam, the strain energy jumps with the factor. The ledger counts this as outside work, not as a gain of the integrator."""
    sim = sinew.load(beam("backward-euler", estimators={}))
    sim.solve_static()
    sim.step(2)
    before = sim.ledger
    sim.body("beam").stiffness_factor = 3.0
    after = sim.ledger
    strain = before["strain_energy"]
    assert after["strain_energy"] == pytest.approx(3.0 * strain, rel=1e-9)
    assert after["outside_work"] - before["outside_work"] == pytest.approx(2.0 * strain, rel=1e-9)
    assert after["numerical_loss"] == pytest.approx(before["numerical_loss"], abs=1e-9 * strain)
    for _ in range(5):
        sim.step()
        assert sim.report.status == "solved"


@pytest.mark.parametrize("method", ["newton", "one-linearisation"])
def test_a_factor_that_is_taken_back_has_no_effect(method):
    """Energies that were read at another factor do not enter the next step."""
    # With time steps of 10 ms, one linearisation leaves a third of the forces of this undamped fall out of balance.
    tree = beam("backward-euler", estimators={}, solver={"method": method}, time_step="2 ms")
    del tree["bodies"]["beam"]["damping"]
    sim = sinew.load(tree)
    sim.step(25)
    clone = sim.clone()
    sim.body("beam").stiffness_factor = 2.0
    assert sim.ledger["strain_energy"] == pytest.approx(2.0 * clone.ledger["strain_energy"], rel=1e-9)
    sim.body("beam").stiffness_factor = 1.0
    for one in (sim, clone):
        one.step()
    np.testing.assert_array_equal(sim.body("beam").positions, clone.body("beam").positions)


def test_a_rigid_body_has_no_stiffness_factor():
    sim = sinew.load({"sinew": 1, "integrator": "backward-euler",
                      "bodies": {"ball": {"type": "rigid", "shape": {"sphere": {"radius": "5 mm"}}, "mass": "1 g"}}})
    with pytest.raises(sinew.Error, match="wrong-type"):
        sim.body("ball").stiffness_factor = 2.0


def test_ellipsoids_of_stiffness_at_rest():
    rng = np.random.default_rng(11)
    squares = []
    for draw in range(50):
        logarithm = PRIOR * rng.standard_normal()
        sim = twin(beam(), logarithm, draw)
        sim.solve_static()
        watch = sim.estimator("watch")
        assert watch.status == "estimating"
        assert watch.std[0] < 0.05
        squares.append(((watch.mean[0] - logarithm) / watch.std[0]) ** 2)
        assert watch.stiffness["soft"] == pytest.approx(np.exp(watch.mean[0]))
    check_ellipsoids(squares, 1)


def test_ellipsoids_of_stiffness_in_steps():
    """The error of the first linearisation, about the modulus of the scene, exceeds the standard deviation, so the filter has to repeat
    steps."""
    rng = np.random.default_rng(12)
    squares = []
    for draw in range(50):
        logarithm = PRIOR * rng.standard_normal()
        sim = twin(beam(), logarithm, draw)
        sim.step(5)
        watch = sim.estimator("watch")
        assert watch.std[0] < 0.02
        squares.append(((watch.mean[0] - logarithm) / watch.std[0]) ** 2)
    check_ellipsoids(squares, 1)


def test_ellipsoids_of_stiffness_beside_a_force():
    """A force that lifts the beam looks like a stiffer beam; the covariance contains how well two markers and the weight separate them."""
    rng = np.random.default_rng(13)
    squares = []
    for draw in range(50):
        logarithm = PRIOR * rng.standard_normal()
        force = 2e-3 * rng.standard_normal(3)
        tree = beam(loads={"hand": {"type": "force", "body": "beam", "point": "40 5 0 mm", "force": force.tolist()}})
        tree["estimators"]["watch"]["unknowns"]["hand"] = {"force": {"body": "beam", "point": "40 5 0 mm"}, "prior": "2 mN"}
        sim = twin(tree, logarithm, draw)
        sim.solve_static()
        watch = sim.estimator("watch")
        error = watch.mean - np.array([logarithm, *force])
        squares.append(error @ np.linalg.solve(watch.covariance, error))
    check_ellipsoids(squares, 4)


def test_ellipsoids_of_stiffness_in_motion():
    """The beam is released without strain, falls, and swings about its equilibrium."""
    rng = np.random.default_rng(14)
    squares = []
    for draw in range(50):
        logarithm = PRIOR * rng.standard_normal()
        sim = twin(beam("backward-euler"), logarithm, draw)
        sim.step(25)
        watch = sim.estimator("watch")
        assert watch.status == "estimating"
        assert watch.std[0] < 0.02
        squares.append(((watch.mean[0] - logarithm) / watch.std[0]) ** 2)
    check_ellipsoids(squares, 1)


def test_a_stiffness_is_recorded_as_a_factor():
    sim = twin(beam(), 0.2, 1)
    rows = sim.run(0.1)
    watch = sim.estimator("watch")
    assert rows["watch.soft"][-1] == pytest.approx(np.exp(watch.mean[0]))
    assert rows["watch.soft.std"][-1] == pytest.approx(np.exp(watch.mean[0]) * watch.std[0])
    assert rows["watch.soft"][-1] == pytest.approx(np.exp(0.2), abs=4.0 * rows["watch.soft.std"][-1])


def test_states_and_clones_go_on_bit_for_bit():
    for integrator in ("quasi-static", "backward-euler"):
        sim = twin(beam(integrator), 0.2, 1)
        sim.step(4)
        clone, again = sim.clone(), twin(beam(integrator), 0.2, 1)
        again.restore(sim.state())
        for one in (sim, clone, again):
            one.step(3)
        for one in (clone, again):
            np.testing.assert_array_equal(one.estimator("watch").mean, sim.estimator("watch").mean)
            np.testing.assert_array_equal(one.estimator("watch").covariance, sim.estimator("watch").covariance)


def test_what_only_the_ratio_of_force_and_stiffness_tells_is_named():
    """With an unknown force on a beam without weight, markers determine only the ratio of force and stiffness."""
    tree = beam(gravity="0 0 0 m/s^2")
    tree["loads"] = {"hand": {"type": "force", "body": "beam", "point": "60 0 0 mm", "force": "0 0 -3 mN"},
                     "weight": {"type": "force", "body": "beam", "point": "60 0 0 mm", "force": "0 0 -1e-9 N"}}
    tree["estimators"]["watch"]["unknowns"]["hand"] = {"force": {"body": "beam", "point": "60 0 0 mm"}, "prior": "3 mN"}
    sim = sinew.load(tree)
    sim.solve_static()
    watch = sim.estimator("watch")
    assert watch.status == "unobservable"
    assert "soft" in watch.message


def test_a_cable_that_ties_two_bodies_tells_a_stiffness():
    """A cable of given length bends both beams. Without weight, the shape of the beam with the known stiffness tells the tension."""
    tree = beam(gravity="0 0 0 m/s^2")
    tree["bodies"]["other"] = {**tree["bodies"]["beam"], "pose": {"position": "0 50 0 mm"}}
    tree["actuators"] = {"tie": {"type": "cable", "body": "beam", "pull": "body", "command": {"displacement": "2 mm"},
                                 "points": ["55 8 5 mm", {"body": "other", "point": "55 52 5 mm"}]}}
    tree["sensors"]["far"] = {"type": "marker", "body": "other", "point": "60 60 10 mm", "noise": "0.1 mm"}
    tree["estimators"]["watch"]["sensors"] = ["far"]
    assert sinew.load(tree).estimator("watch").status == "not-started"


def without_weight(tree):
    tree["gravity"] = [0, 0, 0]


def two(tree):
    tree["estimators"]["watch"]["unknowns"]["hard"] = {"stiffness": {"body": "beam"}, "prior": 0.1}


def rigid(tree):
    tree["bodies"]["ball"] = {"type": "rigid", "shape": {"sphere": {"radius": "5 mm"}}, "mass": "1 g"}
    tree["integrator"] = "backward-euler"
    tree["estimators"]["watch"]["unknowns"]["soft"]["stiffness"]["body"] = "ball"


def elsewhere(tree):
    tree["bodies"]["other"] = {**tree["bodies"]["beam"], "pose": {"position": "0 50 0 mm"}}
    tree["sensors"]["far"] = {"type": "marker", "body": "other", "point": "60 60 10 mm", "noise": "0.1 mm"}
    tree["estimators"]["watch"]["sensors"].append("far")


@pytest.mark.parametrize("change, words", [
    (without_weight, "at any stiffness.*let a known load act"),
    (two, "'beam' is unknown twice"),
    (rigid, "'ball' is of type rigid.*type fem"),
    (elsewhere, "'far' answers to nothing"),
    (lambda t: t["estimators"]["watch"]["unknowns"]["soft"].update(prior=0), "prior"),
    (lambda t: t["estimators"]["watch"]["unknowns"]["soft"].update(walk=-0.1), "walk"),
    (lambda t: t["estimators"]["watch"]["unknowns"]["soft"]["stiffness"].update(body="baem"), "did you mean"),
])
def test_a_stiffness_that_cannot_be_estimated_is_an_error(change, words):
    tree = beam()
    change(tree)
    with pytest.raises(sinew.Error) as caught:
        sinew.load(tree)
    assert re.search(words, str(caught.value), re.DOTALL)
