"""Parts of closed loops: programs, responses, Jacobians, gains, estimators."""

import numpy as np
import pytest
import sinew
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from sinew import control
from sinew.control import rotations
from sinew.control.robot import condensed

CABLES = ["east", "north", "west", "south"]


def taut(scene, **options):
    """The finger with all cables under 3 N, at rest."""
    sim = sinew.load(scene, **options)
    for name in CABLES:
        sim.actuator(name).tension = 3.0
    sim.step(60)
    sim.solve_static(tolerance=1e-12)
    return sim


# Quadratic programs.


def test_quadratic_programs_are_those_of_scipy():
    rng = np.random.default_rng(3)
    for _ in range(5):
        half, rows = rng.normal(size=(6, 6)), rng.normal(size=(3, 6))
        matrix, gradient = half @ half.T + np.eye(6), 5.0 * rng.normal(size=6)
        found = sinew.qp.solve_quadratic(matrix, gradient, np.full(6, -0.4), np.full(6, 0.6), rows, np.full(3, -0.5),
                                         [0.5, np.inf, 0.2])
        assert found.status == "optimal"
        reference = minimize(lambda x: 0.5 * x @ matrix @ x + gradient @ x, np.zeros(6), jac=lambda x: matrix @ x + gradient,
                             bounds=[(-0.4, 0.6)] * 6, method="SLSQP", options={"ftol": 1e-14, "maxiter": 500},
                             constraints=[{"type": "ineq", "fun": lambda x: rows @ x + 0.5},
                                          {"type": "ineq", "fun": lambda x: (np.array([0.5, 1e3, 0.2]) - rows @ x)}])
        assert found.x == pytest.approx(reference.x, abs=1e-6)
        # Stationary: G x + g = y + C^T z.
        assert matrix @ found.x + gradient == pytest.approx(found.bound_multiplier + rows.T @ found.row_multiplier, abs=1e-9)


def test_quadratic_programs_say_what_is_wrong():
    assert sinew.qp.solve_quadratic([[1.0]], [0.0], C=[[1.0], [1.0]], row_lower=[1.0, -9.0],
                                    row_upper=[2.0, -1.0]).status == "infeasible"
    assert sinew.qp.solve_quadratic([[0.0]], [1.0]).status == "unbounded"
    for arguments, kind in (
        (([[1.0]], [0.0, 1.0]), "wrong-shape"),
        (([[np.nan]], [0.0]), "not-finite"),
        (([[1.0]], [0.0], [2.0], [1.0]), "contradictory-limits"),
        (([[1.0]], [0.0], [np.nan], [1.0]), "wrong-shape"),
    ):
        with pytest.raises(sinew.Error) as caught:
            sinew.qp.solve_quadratic(*arguments)
        assert caught.value.kind == kind


# Responses and Jacobians.


def test_the_response_of_free_efforts_is_the_compliance(scene):
    sim = taut(scene)
    before = sim.state_hash
    linear, response = sim.linearise(), sim.response()
    assert sim.state_hash == before
    rows = [linear.rows.index(f"tip.{axis}") for axis in "xyz"]
    own = [linear.rows.index(name) for name in response.actuators]
    assert response.W_ea["tip"] == pytest.approx(linear.W[np.ix_(rows, own)], rel=1e-12)
    assert response.W_aa == pytest.approx(linear.W[np.ix_(own, own)], rel=1e-12)
    swapped = sim.response(["push", "east"])
    assert swapped.actuators == ["push", "east"]
    assert swapped.W_aa[0, 1] == pytest.approx(linear.W[linear.rows.index("push"), linear.rows.index("east")], rel=1e-12)


def differences(sim, effectors, commands, quantities, step):
    """Jacobian by central differences of equilibria."""
    columns = []
    for name, value in commands.items():
        ends = []
        for sign in (1.0, -1.0):
            probe = sim.clone()
            for other, kept in commands.items():
                setattr(probe.actuator(other), quantities[other], kept)
            setattr(probe.actuator(name), quantities[name], value + sign * step)
            probe.solve_static(tolerance=1e-12)
            ends.append(np.concatenate([probe.effector(effector).value for effector in effectors]))
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    return np.array(columns).T


@pytest.mark.parametrize("command", ["motion", "effort", {"east": "motion", "north": "effort", "west": "motion", "south": "effort"}])
def test_the_jacobian_is_that_of_equilibria(scene, command):
    sim = taut(scene)
    sim.actuator("east").tension = 5.0
    sim.solve_static(tolerance=1e-12)
    found = control.jacobian(sim, ["tip"], CABLES, command=command)
    kinds = {name: command if isinstance(command, str) else command[name] for name in CABLES}
    quantities = {name: {"motion": "displacement", "effort": "tension"}[kind] for name, kind in kinds.items()}
    commands = {name: getattr(sim.actuator(name), quantity) for name, quantity in quantities.items()}
    # The error of central differences is quadratic in the steps of 1e-6 m and 1e-4 N.
    for k, (name, quantity) in enumerate(quantities.items()):
        step = 1e-6 if quantity == "displacement" else 1e-4
        reference = differences(sim, ["tip"], commands, quantities, step)[:, k]
        assert found[:, k] == pytest.approx(reference, abs=2e-5 * np.abs(found).max())


def test_slack_cables_move_nothing(scene):
    sim = sinew.load(scene)
    sim.actuator("east").displacement = 0.004
    for name in CABLES[1:]:
        sim.actuator(name).displacement = -0.01
    sim.step(40)
    sim.solve_static(tolerance=1e-12)
    found = control.jacobian(sim, ["tip"], CABLES)
    assert (found[:, 1:] == 0.0).all()
    commands = {"east": 0.004, **{name: -0.01 for name in CABLES[1:]}}
    reference = differences(sim, ["tip"], commands, {name: "displacement" for name in CABLES}, 1e-6)
    assert found == pytest.approx(reference, abs=1e-5)


def test_two_cables_on_one_line_have_one_motion():
    # W_MM is singular: two equal columns get half each.
    w_aa = np.array([[2.0, 2.0], [2.0, 2.0]])
    w_ea = np.array([[1.0, 1.0]])
    both = condensed(w_ea, w_aa, np.array([True, True]), np.array([False, False]))
    assert both == pytest.approx(np.array([[0.25, 0.25]]))


@pytest.mark.parametrize("friction", [0.0, 20.0])
def test_the_response_keeps_contacts(friction):
    """A beam rests on a floor, and its contact points slide without friction or stick; compared with differences of equilibria.

    At the friction limit, the response would differ for the two directions of motion.
    """
    beam = {
        "sinew": 1, "time_step": "10 ms", "integrator": "quasi-static", "gravity": "0 0 -9.81 m/s^2",
        "solver": {"tolerance": 1e-10},
        "bodies": {"beam": {"type": "fem", "mesh": {"shape": "block", "length": "100 mm", "width": "20 mm",
                                                               "height": "20 mm", "element_size": "10 mm"},
                            "material": {"model": "corotational", "young_modulus": "100 kPa", "poisson_ratio": 0.4},
                            "density": "1070 kg/m^3", "fixed": {"set": "x_min"}}},
        "actuators": {"lift": {"type": "force", "body": "beam", "point": "50 10 20 mm", "direction": [0, 0, 1],
                               "command": {"force": "0 N"}},
                      "shift": {"type": "force", "body": "beam", "point": "50 10 20 mm", "direction": [1, 0, 0],
                                "command": {"force": "0 N"}}},
        "effectors": {"tip": {"body": "beam", "point": "75 10 20 mm"}},
        "contacts": {"floor": {"body": "beam", "surface": {"plane": {"point": "0 0 -4 mm", "normal": [0, 0, 1]}},
                               "nodes": {"set": "z_min"}, "friction": friction}},
    }
    sim = sinew.load(beam)
    sim.step(30)
    touching = sum(state != "open" for state in sim.contact("floor").states)
    assert touching > 0 and sim.contact("floor").states.count("stick") == (touching if friction else 0)
    watched = sim.clone()
    before = watched.state()
    found = watched.response()
    assert watched.state() == before
    for each in (sim, watched):  # the query does not change the continuation
        each.actuator("lift").force = 0.01
        each.step(5)
    assert watched.state() == sim.state()
    sim.restore(before)
    sim.actuator("lift").force = 0.0
    columns = []
    for name, value in (("lift", 0.0), ("shift", 0.0)):
        ends = []
        for sign in (1.0, -1.0):
            probe = sim.clone()
            probe.actuator(name).force = value + sign * 1e-6
            probe.step(3)
            assert sum(state != "open" for state in probe.contact("floor").states) == touching
            ends.append(np.array(probe.effector("tip").position))
        columns.append((ends[0] - ends[1]) / 2e-6)
    reference = np.array(columns).T
    assert found.W_ea["tip"] == pytest.approx(reference, abs=1e-4 * np.abs(reference).max())
    # Without the floor, the response differs.
    del beam["contacts"]
    free = sinew.load(beam)
    free.step(30)
    assert np.abs(free.response().W_ea["tip"] - reference).max() > 0.1 * np.abs(reference).max()


def test_responses_say_what_is_wrong(sim):
    for actuators, kind in ((["nord"], "unknown-name"), (["east", "east"], "bad-argument")):
        with pytest.raises(sinew.Error) as caught:
            sim.response(actuators)
        assert caught.value.kind == kind
    for arguments, kind in (
        ((sim, []), "no-effectors"), ((sim, ["top"]), "unknown-name"), ((sim, ["tip"], ["nord"]), "unknown-name"),
        ((sim, ["tip"], []), "no-actuators"), ((sim, ["tip"], "east"), "wrong-type"),
    ):
        with pytest.raises(sinew.Error) as caught:
            control.jacobian(*arguments)
        assert caught.value.kind == kind
    with pytest.raises(sinew.Error) as caught:
        control.jacobian(sim, ["tip"], command="pull")
    assert caught.value.kind == "unknown-choice"


# Gains, rotations, estimators.


@pytest.mark.parametrize("delay", [0, 1, 2, 5, 20])
def test_the_limit_of_a_delay_is_where_a_root_leaves_the_circle(delay):
    def largest(gain):
        polynomial = np.zeros(delay + 2)
        polynomial[0], polynomial[1] = 1.0, -1.0
        polynomial[-1] += gain
        return np.abs(np.roots(polynomial)).max()

    limit = control.delay_limit(delay)
    assert largest(0.999 * limit) < 1.0 < largest(1.001 * limit)


def test_long_delays_have_the_limit_of_continuous_time():
    # rate < pi/(2 tau) with tau = (d + 1/2) T: the hold of a command adds half a sample of delay on average.
    assert 200.5 * control.delay_limit(200) == pytest.approx(np.pi / 2.0, rel=1e-5)
    with pytest.raises(sinew.Error):
        control.delay_limit(-1)


def test_gains_by_table():
    table = control.Schedule(lambda loop: loop, [0.0, 1.0, 3.0], [(2.0, 0.0), (4.0, 1.0), (8.0, 1.0)])
    assert table.at(-1.0) == control.Gains(2.0, 0.0)
    assert table.at(0.5) == pytest.approx((3.0, 0.5))
    assert table.at(2.0) == pytest.approx((6.0, 1.0))
    assert table.at(9.0) == control.Gains(8.0, 1.0)
    for arguments, kind in (
        ((3, [0.0], [(1.0, 0.0)]), "wrong-type"), ((len, [0.0, 1.0], [(1.0, 0.0)]), "wrong-length"),
        ((len, [1.0, 0.0], [(1.0, 0.0)] * 2), "non-monotonic-time"), ((len, [0.0], [(-1.0, 0.0)]), "out-of-range"),
    ):
        with pytest.raises(sinew.Error) as caught:
            control.Schedule(*arguments)
        assert caught.value.kind == kind
    with pytest.raises(sinew.Error) as caught:
        table.at(np.nan)
    assert caught.value.kind == "not-finite"


def test_rotations_are_those_of_scipy():
    rng = np.random.default_rng(5)
    for _ in range(50):
        a, b = rng.normal(size=3), rng.normal(size=3)
        both = Rotation.from_rotvec(a) * Rotation.from_rotvec(b)
        assert rotations.product(a, b) == pytest.approx(both.as_rotvec(), abs=1e-12)
        turn = rotations.difference(a, b)
        assert (Rotation.from_rotvec(turn) * Rotation.from_rotvec(b)).as_matrix() == pytest.approx(
            Rotation.from_rotvec(a).as_matrix(), abs=1e-12)
        assert np.linalg.norm(turn) <= np.pi + 1e-12
    assert (rotations.difference(a, a) == 0.0).all() or np.abs(rotations.difference(a, a)).max() < 1e-15


def test_the_estimator_finds_the_error_of_a_jacobian():
    """The error is consistent with the reported deviation for 200 random robots: the squared ratio for left^T E right has mean 1."""
    rng = np.random.default_rng(11)
    noise, squares = np.array([1e-4, 3e-4]), []
    for _ in range(200):
        error = 0.3 * rng.normal(size=(2, 2))
        estimator = control.JacobianEstimator(noise, spread=0.3, forgetting=1.0)
        for _ in range(10):
            modelled = 1e-3 * rng.normal(size=2)
            varied = 0.3 * np.linalg.norm(modelled) * rng.normal(size=2)
            estimator.update(modelled, modelled + error @ modelled + varied + np.sqrt(2.0) * noise * rng.normal(size=2))
        left, right = rng.normal(size=(2, 2))
        squares.append((left @ (estimator.error() - error) @ right / estimator.std(left, right)) ** 2)
    # Chi squared of one degree of freedom has variance 2, so the mean of 200 has a standard deviation of 0.1.
    assert np.mean(squares) == pytest.approx(1.0, abs=0.4)


def test_the_estimator_forgets_towards_its_prior():
    estimator = control.JacobianEstimator([1e-6], spread=0.3, forgetting=0.9)
    for _ in range(100):
        estimator.update(np.array([1e-3]), np.array([1.2e-3]))
    # Ten motions in memory, each with the weight of the prior: 10/11 of the true error, and 1/sqrt(11) of the spread.
    assert estimator.error() == pytest.approx(0.2 * 10.0 / 11.0, rel=1e-4)
    assert estimator.std(np.ones(1), np.ones(1)) == pytest.approx(0.3 / np.sqrt(11.0), rel=1e-4)
    for _ in range(500):
        estimator.update(np.zeros(1), np.zeros(1))
    assert abs(estimator.error()[0, 0]) < 1e-3
    assert estimator.std(np.ones(1), np.ones(1)) == pytest.approx(0.3, rel=1e-3)
    for noise, wrong in (([1.0], {"spread": 0.0}), ([-1.0], {}), ([1.0], {"forgetting": 1.1}), ([np.inf], {})):
        with pytest.raises(sinew.Error) as caught:
            control.JacobianEstimator(noise, **wrong)
        assert caught.value.kind == "out-of-range"
