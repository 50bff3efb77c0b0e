"""Estimators in scenes with inertia: compared with a Kalman filter of the full state, and on swinging and flying bodies."""
import copy

import numpy as np
import pytest

import sinew

STEP = 0.005  # s


def beam(**changes):
    """A beam of few elements, 60 x 10 x 10 mm, whose motion is small enough to be linear."""
    return {
        "sinew": 1, "time_step": f"{STEP} s", "integrator": "backward-euler", "gravity": [0, 0, 0], "solver": {"tolerance": 1e-10},
        "bodies": {"beam": {"type": "fem", "mesh": {"shape": "block", "length": "60 mm", "width": "10 mm", "height": "10 mm",
                                                    "element_size": "10 mm"}, "element": "tet4",
                            "material": {"model": "corotational", "young_modulus": "100 kPa", "poisson_ratio": 0.3},
                            "density": "1000 kg/m^3", "damping": {"mass": "1 1/s", "stiffness": "2 ms"}, "fixed": {"set": "x_min"}}},
        "loads": {"hand": {"type": "force", "body": "beam", "point": "60 0 0 mm", "force": "0 1e-5 2e-5 N",
                           "factor": {"steps": [["0 s", 0], ["0.05 s", 1], ["0.15 s", -1]]}}},
        "sensors": {"tip": {"type": "marker", "body": "beam", "point": "60 10 10 mm", "noise": "0.1 um", "seed": 3},
                    "middle": {"type": "marker", "body": "beam", "point": "30 0 10 mm", "noise": "0.2 um", "delay": "10 ms", "seed": 4}},
        "estimators": {"push": {"type": "filter", "sensors": ["tip", "middle"], "unknowns": {
            "hand": {"force": {"body": "beam", "point": "60 0 0 mm"}, "prior": "1e-5 N", "walk": "1e-4 N"}}}},
    } | changes


class FullKalman:
    """Kalman filter (Simon 2006, sec. 5.1) of the force and the positions and velocities of all free nodes, with backward Euler:
    (M/h^2 + C/h + K) q' = M (q/h^2 + v/h) + C q/h + f,  v' = (q' - q)/h."""

    def __init__(self, sim, prior, walk):
        body = sim.body("beam")
        free = np.flatnonzero(~body.fixed)
        mass = np.repeat(body.node_masses[free], 3)
        stiffness = body.stiffness().toarray()
        damping = np.diag(1.0 * mass) + 0.002 * stiffness
        inverse = np.linalg.inv(np.diag(mass) / STEP**2 + damping / STEP + stiffness)
        self.rest, self.free, n = body.rest_positions, list(free), 3 * len(free)
        place = inverse @ (np.diag(mass) / STEP**2 + damping / STEP)
        speed = inverse @ np.diag(mass) / STEP
        pull = inverse @ self.rows((0.06, 0.0, 0.0), n).T
        self.step = np.block([[np.eye(3), np.zeros((3, 2 * n))], [pull, place, speed],
                              [pull / STEP, (place - np.eye(n)) / STEP, speed / STEP]])
        self.mean = np.zeros(3 + 2 * n)
        self.covariance = np.zeros((3 + 2 * n,) * 2)
        self.covariance[:3, :3] = prior**2 * np.eye(3)
        self.noise = walk**2 * STEP

    def rows(self, point, count):
        """Rows (3, count) that select the displacement of one node."""
        node = self.free.index(np.linalg.norm(self.rest - point, axis=1).argmin())
        return np.eye(count)[3 * node:3 * node + 3]

    def advance(self):
        self.covariance[:3, :3] += self.noise * np.eye(3)
        self.mean = self.step @ self.mean
        self.covariance = self.step @ self.covariance @ self.step.T

    def correct(self, point, said, deviation):
        count = (len(self.mean) - 3) // 2
        seen = np.hstack([np.zeros((3, 3)), self.rows(point, count), np.zeros((3, count))])
        gain = self.covariance @ seen.T @ np.linalg.inv(seen @ self.covariance @ seen.T + deviation**2 * np.eye(3))
        self.mean = self.mean + gain @ (said - np.array(point) - seen @ self.mean)
        self.covariance = self.covariance - gain @ seen @ self.covariance


def test_a_beam_is_as_kalmans_filter_of_its_full_state():
    """327 states; the estimator's covariance factor has 12 columns. No delays, because the reference takes samples as they arrive. All
    magnitudes are a tenth of the scene's: the difference by the nonlinearity of the beam, relative to the deviation, is proportional to
    them (0.025 with the scene's)."""
    tree = beam()
    tree["sensors"]["middle"].pop("delay")
    tree["loads"]["hand"]["force"] = "0 1e-6 2e-6 N"
    for sensor, noise in (("tip", "0.01 um"), ("middle", "0.02 um")):
        tree["sensors"][sensor]["noise"] = noise
    tree["estimators"]["push"]["unknowns"]["hand"] |= {"prior": "1e-6 N", "walk": "1e-5 N"}
    sim = sinew.load(tree)
    full = FullKalman(sim, 1e-6, 1e-5)
    push = sim.estimator("push")
    for _ in range(40):
        sim.step()
        full.advance()
        full.correct((0.06, 0.01, 0.01), sim.sensor("tip").value, 1e-8)
        full.correct((0.03, 0.0, 0.01), sim.sensor("middle").value, 2e-8)
        deviation = np.sqrt(np.diag(full.covariance)[:3])
        assert (np.abs(push.mean - full.mean[:3]) < 0.01 * deviation).all()
    np.testing.assert_allclose(push.std, deviation, rtol=1e-3)
    assert np.abs(push.mean - [0.0, -1e-6, -2e-6]).max() < 4.0 * deviation.max()


def test_late_samples_count_for_their_time():
    """Delays change the final estimate only by the samples that have not arrived yet."""
    late, prompt = beam(), beam()
    prompt["sensors"]["middle"].pop("delay")
    runs = [sinew.load(tree) for tree in (late, prompt)]
    for sim in runs:
        sim.step(40)
    one, other = (sim.estimator("push") for sim in runs)
    assert (np.abs(one.mean - other.mean) < 2.0 * other.std).all()
    assert (one.std >= other.std * (1.0 - 1e-6)).all()


def test_slack_cables_count_on_the_side_on_which_they_pull():
    """Two parallel cables have tensions near zero. After some samples, a column of the covariance raises one tension and lowers the
    other. Since the beam is linear, the covariance equals that of cables under tension."""
    runs = []
    for tension in ("0 N", "10 mN"):
        tree = beam(loads={}, actuators={
            name: {"type": "cable", "body": "beam", "points": [f"{x} {y} 9 mm" for x in (0, 30, 58)], "command": {"tension": tension}}
            for name, y in (("left", 3), ("right", 7))})
        tree["estimators"]["push"]["unknowns"] = {
            name: {"tension": {"actuator": name}, "prior": "1e-4 N", "walk": "1e-5 N"} for name in ("left", "right")}
        runs.append(sinew.load(tree))
    for _ in range(20):
        for sim in runs:
            sim.step()
        slack, tight = (sim.estimator("push") for sim in runs)
        np.testing.assert_allclose(slack.covariance, tight.covariance, atol=0.02 * tight.std.prod())


def pendulum(force):
    """A hanging soft finger that is released from the side and pushed while it swings."""
    tree = beam(gravity="0 0 -9.81 m/s^2", solver={})
    tree["bodies"]["beam"] |= {"velocity": {"linear": "0 0.3 0 m/s"}}
    tree["loads"]["hand"] |= {"force": force, "factor": {"steps": [["0 s", 0], ["0.1 s", 1]]}}
    for name, noise in (("tip", "0.1 mm"), ("middle", "0.1 mm")):
        tree["sensors"][name]["noise"] = noise
    tree["estimators"]["push"] |= {"rank": 12}
    tree["estimators"]["push"]["unknowns"]["hand"] |= {"prior": "0.02 N", "walk": "0.05 N"}
    return tree


def test_a_push_on_a_swinging_finger_is_found():
    sim = sinew.load(pendulum([0.0, 0.02, -0.01]))
    push = sim.estimator("push")
    errors, squares = [], []
    for k in range(60):
        sim.step()
        true = np.array([0.0, 0.02, -0.01]) * (sim.time >= 0.1)
        error = push.forces["hand"] - true
        errors.append(error)
        squares.append(error @ np.linalg.solve(push.covariance, error))
    assert push.status in ("estimating", "unobservable")  # along the finger, the markers observe little
    assert np.abs(np.array(errors[45:])[:, 1:]).max() < 0.01
    assert np.median(squares[:19] + squares[35:]) < 7.8  # chi squared of three, 95 %
    quasi = pendulum([0.0, 0.02, -0.01])
    quasi["estimators"]["push"]["inertia"] = False
    sim = sinew.load(quasi)
    sim.step(15)  # before the push
    assert np.abs(sim.estimator("push").forces["hand"]).max() > 3.0 * np.abs(errors[14]).max()


def flight(force, seed):
    """A soft cube that flies, rotates, and is pushed off its centre, with a marker and a gyroscope."""
    return {
        "sinew": 1, "time_step": "10 ms", "integrator": "backward-euler", "gravity": "0 0 -9.81 m/s^2",
        "bodies": {"cube": {"type": "fem", "mesh": {"shape": "block", "length": "20 mm", "width": "20 mm", "height": "20 mm",
                                                    "element_size": "20 mm"}, "element": "tet4",
                            "material": {"model": "corotational", "young_modulus": "300 kPa", "poisson_ratio": 0.3}, "mass": "20 g",
                            "velocity": {"linear": "0.5 0 2 m/s", "angular": "2 1 3 rad/s"}}},
        "loads": {"wind": {"type": "force", "body": "cube", "point": "20 15 10 mm", "force": list(force)}},
        "sensors": {"mark": {"type": "marker", "body": "cube", "point": "20 0 0 mm", "noise": "0.5 mm", "seed": seed},
                    "turn": {"type": "gyroscope", "body": "cube", "at": ["10 10 10 mm", "20 10 10 mm", "10 20 10 mm"],
                             "noise": "0.05 rad/s", "seed": seed + 1}},
        "estimators": {"air": {"type": "filter", "sensors": ["mark", "turn"], "unknowns": {
            "wind": {"force": {"body": "cube", "point": "20 15 10 mm"}, "prior": "20 mN", "walk": "0.1 mN"}}}},
    }


def test_ellipsoids_of_a_flying_body_hold_what_they_say():
    """For forces drawn from the prior, the weighted error is chi squared with three degrees of freedom."""
    rng = np.random.default_rng(5)
    squares = []
    for draw in range(40):
        force = 0.02 * rng.standard_normal(3)
        sim = sinew.load(flight(force, 10 * draw))
        sim.step(12)
        air = sim.estimator("air")
        assert air.status == "estimating" and (air.std < 0.008).all()
        error = air.mean - force
        squares.append(error @ np.linalg.solve(air.covariance, error))
    assert np.mean(squares) == pytest.approx(3.0, rel=0.4)  # theory: 3 +- 0.39
    assert np.mean(np.array(squares) < 6.251) >= 0.8  # the 90 % ellipsoid


def test_states_clones_and_threads_go_on_bit_for_bit():
    tree = beam()
    tree["estimators"]["push"]["rank"] = 5
    sim, other = sinew.load(tree), sinew.load(tree, threads=2)
    for one in (sim, other):
        one.step(5)
    clone = sim.clone()
    again = sinew.load(tree)
    again.restore(sim.state())
    for one in (sim, other, clone, again):
        one.step(3)
    for one in (other, clone, again):
        np.testing.assert_array_equal(one.estimator("push").mean, sim.estimator("push").mean)
        np.testing.assert_array_equal(one.estimator("push").covariance, sim.estimator("push").covariance)
    assert again.state_hash == sim.state_hash


def test_an_equilibrium_settles_the_estimate():
    tree = beam()
    tree["loads"]["hand"].pop("factor")
    tree["sensors"] = {name: {**one, "noise": "1 nm"} for name, one in tree["sensors"].items()}
    sim = sinew.load(tree)
    sim.solve_static()
    push = sim.estimator("push")
    for steps in (0, 5):
        sim.step(steps) if steps else None
        assert (np.abs(push.mean - [0.0, 1e-5, 2e-5]) < 4.0 * push.std + 1e-7).all()
        assert (push.std[1:] < 1e-6).all()


def test_a_switch_is_no_measurement():
    tree = copy.deepcopy(beam())
    tree["contacts"] = {"floor": {"body": "beam", "surface": {"plane": {"point": "0 0 -50 mm"}}}}
    tree["sensors"]["bump"] = {"type": "touch", "contact": "floor", "noise": 0.1}
    tree["estimators"]["push"]["sensors"] = ["tip", "bump"]
    with pytest.raises(sinew.Error):
        sinew.load(tree)
