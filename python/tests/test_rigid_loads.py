"""Loads on rigid bodies: forces, tractions, accelerations, pressure and water, in statics and in motion."""

import numpy as np
import pytest
import sinew
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

MASS, EDGES = 0.3, np.array([0.04, 0.06, 0.1])
INERTIA = MASS / 12 * (np.sum(EDGES**2) - EDGES**2)
BOX = {"type": "rigid", "shape": {"box": list(EDGES)}, "mass": MASS}
G = 9.81


def scene(loads, body=BOX, gravity=0.0, **more):
    return sinew.load({"sinew": 1, "gravity": [0, 0, -gravity], "bodies": {"b": dict(body)}, "loads": loads, **more})


def run(sim, time):
    statuses = set()
    while sim.time < time * (1 - 1e-9):
        sim.step()
        statuses.add(sim.report.status)
    assert statuses == {"solved"}
    return sim.body("b")


def turn_of(body):
    w, *xyz = body.rotation
    return Rotation.from_quat([*xyz, w])


def thrown(force, point, time):
    """Position of the centre and rotation of the box under gravity and a force of fixed direction at a point of it."""

    def rate(_, y):
        turn, spin = Rotation.from_quat(y[6:10]), y[10:13]
        inertia = turn.as_matrix() @ np.diag(INERTIA) @ turn.as_matrix().T
        pushed = np.cross(turn.apply(point), force) - np.cross(spin, inertia @ spin)
        (x, y_, z), s, (a, b, c) = y[6:9], y[9], spin
        change = 0.5 * np.array([s * a + b * z - c * y_, s * b + c * x - a * z, s * c + a * y_ - b * x,
                                 -a * x - b * y_ - c * z])
        return np.concatenate([y[3:6], force / MASS - [0, 0, G], change, np.linalg.solve(inertia, pushed)])

    start = np.concatenate([np.zeros(6), [0, 0, 0, 1], np.zeros(3)])
    end = solve_ivp(rate, [0, time], start, rtol=1e-10, atol=1e-12).y[:, -1]
    return end[:3], Rotation.from_quat(end[6:10])


@pytest.mark.parametrize("integrator, order", [("backward-euler", 1), ("bdf2", 2), ("generalized-alpha", 2),
                                               ("event-driven", 2)])
def test_a_force_off_the_centre_turns_a_free_body(integrator, order):
    force, point, time = np.array([0.5, -0.3, 0.4]), np.array([0.02, 0.03, -0.05]), 0.4
    centre, turn = thrown(force, point, time)
    errors = []
    for step in (2e-3, 1e-3):
        load = {"type": "force", "body": "b", "point": list(point), "force": list(force)}
        body = run(scene({"f": load}, gravity=G, integrator=integrator, time_step=step), time)
        errors.append((turn_of(body) * turn.inv()).magnitude())
        np.testing.assert_allclose(body.centre_of_mass, centre, atol=6e-3 if order == 1 else 4e-5)
        np.testing.assert_allclose(body.load_force, force, rtol=1e-14)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


def test_lines_and_tractions_act_at_the_middle_of_what_they_cover():
    """A force of one direction on a rigid body is its resultant."""
    spread = {"line": {"type": "line", "body": "b", "points": [[-0.02, 0.01, 0.05], [0.02, 0.01, 0.05]],
                       "force_per_length": "0 0.5 0 N/m"},
              "side": {"type": "traction", "body": "b", "traction": "10 0 5 Pa",
                       "surface": {"plane": {"point": [0, 0.03, 0], "normal": [0, 1, 0]}}}}
    single = {"line": {"type": "force", "body": "b", "point": [0, 0.01, 0.05], "force": [0, 0.02, 0]},
              "side": {"type": "force", "body": "b", "point": [0, 0.03, 0], "force": [0.04, 0, 0.02]}}
    ends = [run(scene(loads, integrator="bdf2", time_step=5e-3), 0.5) for loads in (spread, single)]
    np.testing.assert_allclose(ends[0].centre_of_mass, ends[1].centre_of_mass, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(ends[0].rotation, ends[1].rotation, rtol=1e-10, atol=1e-12)


def test_an_acceleration_moves_the_centre_of_mass():
    body = {**BOX, "centre_of_mass": [0.01, 0.0, 0.02], "inertia": list(INERTIA)}
    shaker = {"type": "acceleration", "body": "b", "acceleration": [2, 0, 1], "factor": 1.5}
    sim = scene({"shaker": shaker}, body, integrator="bdf2", time_step=1e-3)
    end = run(sim, 0.2)
    np.testing.assert_allclose(np.array(end.centre_of_mass) - [0.01, 0, 0.02],
                               0.5 * 1.5 * np.array([2, 0, 1]) * 0.04, rtol=1e-4, atol=1e-15)
    assert turn_of(end).magnitude() < 1e-12
    assert sim.ledger["outside_work"] == pytest.approx(sim.ledger["kinetic_energy"], rel=1e-4)


def test_pressure_on_one_side_follows_the_body():
    """A thrust p A on the side of a hinged box has a constant moment about the hinge, whatever the angle."""
    push = {"type": "pressure", "body": "b", "pressure": "100 Pa",
            "surface": {"plane": {"point": [0.02, 0, 0], "normal": [1, 0, 0]}}}
    hinge = {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0.05], "axis": "y"}
    sim = scene({"push": push}, integrator="bdf2", time_step=1e-3, joints={"h": hinge})
    body = run(sim, 0.4)
    moment, inertia = 100.0 * 0.06 * 0.1 * 0.05, INERTIA[1] + MASS * 0.05**2
    assert turn_of(body).magnitude() == pytest.approx(0.5 * moment / inertia * 0.16, rel=4e-3)
    assert sim.ledger["outside_work"] == pytest.approx(sim.ledger["kinetic_energy"], rel=1e-3)
    assert abs(sim.ledger["numerical_loss"]) < 1e-3 * sim.ledger["kinetic_energy"]


@pytest.mark.parametrize("shape", [{"box": list(EDGES)}, {"sphere": {"radius": 0.03}}, {"cylinder": {"radius": 0.02, "height": 0.05}},
                                   {"capsule": {"radius": 0.02, "length": 0.05}}])
def test_pressure_all_around_moves_nothing(shape):
    sim = scene({"around": {"type": "pressure", "body": "b", "surface": {"patch": {"point": [0.01, 0.012, 0.03], "angle": "180 deg"}},
                            "pressure": "100 kPa"}},
                {"type": "rigid", "shape": shape, "mass": MASS}, integrator="bdf2", time_step=1e-3)
    body = run(sim, 0.05)
    assert np.linalg.norm(body.load_force) < 1e-10
    assert np.linalg.norm(body.velocity) < 1e-10


@pytest.mark.parametrize("force", [0.5, 5.0, 50.0])
def test_a_pendulum_hangs_towards_a_force(force):
    load = {"type": "force", "body": "b", "point": [0, 0, -0.05], "force": [force, 0, 0]}
    hinge = {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0.05], "axis": "y"}
    sim = scene({"f": load}, gravity=G, joints={"h": hinge})
    sim.solve_static()
    # m g l/2 sin = F l cos about the hinge
    assert turn_of(sim.body("b")).magnitude() == pytest.approx(np.arctan2(force * 0.1, MASS * G * 0.05), rel=1e-7)


def test_equilibria_under_a_pressure_that_turns_with_the_body_are_refused():
    """Such a force has no potential. A traction of fixed direction has: the box hangs where m g l/2 sin = F l/2 cos."""
    side = {"body": "b", "surface": {"plane": {"point": [0.02, 0, 0], "normal": [1, 0, 0]}}}
    hinge = {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0.05], "axis": "y"}
    sim = scene({"push": {"type": "pressure", "pressure": "200 Pa", **side}}, gravity=G, joints={"h": hinge})
    for solve in (sim.step, sim.solve_static):
        with pytest.raises(sinew.Error, match="turns with it and has no potential") as caught:
            solve()
        assert caught.value.kind == "surface-not-closed"
    sim.load("push").pressure = 0.0
    sim.step()
    sim = scene({"push": {"type": "traction", "traction": "-200 0 0 Pa", **side}}, gravity=G, joints={"h": hinge})
    sim.solve_static()
    turn = np.array(turn_of(sim.body("b")).as_rotvec())
    force, weight = 200 * 0.06 * 0.1, MASS * G
    arm = Rotation.from_rotvec(turn).apply([0.02, 0, -0.05])
    centre = Rotation.from_rotvec(turn).apply([0, 0, -0.05])
    assert arm[2] * -force + centre[0] * weight == pytest.approx(0.0, abs=1e-8 * weight * 0.05)


VOLUMES = [({"box": list(EDGES)}, EDGES.prod()), ({"sphere": {"radius": 0.03}}, 4 / 3 * np.pi * 0.03**3),
           ({"cylinder": {"radius": 0.02, "height": 0.05}}, np.pi * 0.02**2 * 0.05),
           ({"capsule": {"radius": 0.02, "length": 0.05}}, np.pi * 0.02**2 * 0.05 + 4 / 3 * np.pi * 0.02**3)]


@pytest.mark.parametrize("shape, volume", VOLUMES)
def test_water_carries_the_weight_that_it_gives_way_to(shape, volume):
    turned = {"pose": {"rotation": {"axis": [1, 2, 0.5], "angle": 0.7}}}
    sim = scene({"sea": {"type": "water", "body": "b"}}, {"type": "rigid", "shape": shape, "density": 700.0, **turned},
                gravity=G, integrator="bdf2", time_step=1e-4)
    sim.step()
    upwards = 1000 * G * volume
    # In the first step, drag and added mass act, too: the body accelerates by (rho_w - rho) V g over m and added mass.
    assert 0 < sim.body("b").velocity[2] < 1e-4 * (1000 - 700) / 700 * G
    sim = scene({"sea": {"type": "water", "body": "b", "added_mass": 0.0, "normal_drag": 0.0, "tangential_drag": 0.0}},
                {"type": "rigid", "shape": shape, "density": 700.0, **turned}, gravity=G, integrator="bdf2", time_step=1e-4)
    sim.step()
    np.testing.assert_allclose(sim.body("b").load_force, [0, 0, upwards], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(sim.body("b").load_moment, 0, atol=1e-9)


@pytest.mark.parametrize("density", [200.0, 500.0, 800.0])
def test_a_ball_floats_at_its_depth(density):
    radius = 0.03
    rail = {"type": "slider", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": "z"}
    sim = scene({"sea": {"type": "water", "body": "b", "level": 0.01}},
                {"type": "rigid", "shape": {"sphere": {"radius": radius}}, "density": density}, gravity=G, joints={"rail": rail})
    sim.solve_static()
    height = sim.body("b").centre_of_mass[2] - 0.01
    depth = brentq(lambda d: d * d * (3 * radius - d) / (4 * radius**3) - density / 1000, 0, 2 * radius)
    assert height == pytest.approx(radius - depth, abs=0.01 * radius)


@pytest.mark.parametrize("rest", [0.3, 1.2, 2.5])
def test_a_box_cut_by_the_surface_is_carried_by_its_wet_part(rest):
    """Twelve triangles of any size: the surface of the water cuts them, in a pose of its own."""
    turn = Rotation.from_rotvec(np.array([0.4, -0.7, 0.2]) * rest)
    water = {"type": "water", "body": "b", "level": 0.013, "added_mass": 0.0, "normal_drag": 0.0, "tangential_drag": 0.0}
    pose = {"rotation": {"axis": [0.4, -0.7, 0.2], "angle": float(np.linalg.norm([0.4, -0.7, 0.2]) * rest)}}
    sim = scene({"sea": water}, {**BOX, "pose": pose}, gravity=G, integrator="bdf2", time_step=1e-5)
    sim.step()
    # Volume and centre of the part of the box below the surface, in thin layers across its first edge.
    u, v, w = [np.linspace(-0.5, 0.5, 162)[:-1] + 0.5 / 161 for _ in range(3)]
    points = np.stack(np.meshgrid(u, v, w, indexing="ij"), -1).reshape(-1, 3) * EDGES
    wet = turn.apply(points)
    wet = wet[wet[:, 2] < 0.013]
    volume = EDGES.prod() * len(wet) / len(points)
    body = sim.body("b")
    np.testing.assert_allclose(body.load_force, [0, 0, 1000 * G * volume], rtol=3e-3, atol=1e-6)
    np.testing.assert_allclose(body.load_moment, np.cross(wet.mean(axis=0), [0, 0, 1000 * G * volume]),
                               atol=3e-3 * G * volume * 1000 * 0.05)


@pytest.mark.parametrize("density, angle", [(100.0, 0.0), (500.0, 45.0), (900.0, 0.0)])
def test_a_square_log_floats_flat_or_on_an_edge(density, angle):
    """A log of square section floats flat if it is lighter than 0.211 or heavier than 0.789 of the water (E. N. Gilbert, Am. Math. Monthly 98, 1991), at half of its density on an edge."""
    log = {"type": "rigid", "shape": {"box": [0.2, 0.04, 0.04]}, "density": density,
           "pose": {"rotation": {"axis": "x", "angle": "12 deg"}}}
    sim = scene({"sea": {"type": "water", "body": "b", "level": 0.0, "normal_drag": 3.0}}, log, gravity=G,
                integrator="bdf2", time_step=5e-3)
    body = run(sim, 8.0)
    assert np.degrees(turn_of(body).magnitude()) == pytest.approx(angle, abs=1.5)


def test_a_ball_sinks_at_the_speed_of_its_drag():
    radius, density, drag = 0.02, 1500.0, 0.9
    sim = scene({"sea": {"type": "water", "body": "b", "tangential_drag": 0.0, "normal_drag": drag, "added_mass": 0.5}},
                {"type": "rigid", "shape": {"sphere": {"radius": radius}}, "density": density}, gravity=G,
                integrator="bdf2", time_step=2e-3)
    volume = 4 / 3 * np.pi * radius**3
    terminal = np.sqrt(2 * (density - 1000) * volume * G / (1000 * drag * np.pi * radius**2))
    sim.step()
    start = (density - 1000) * G / (density + 500)
    assert sim.body("b").velocity[2] == pytest.approx(-start * 2e-3, rel=0.02)
    assert -run(sim, 1.5).velocity[2] == pytest.approx(terminal, rel=0.01)
    ledger = sim.ledger
    # The first step, from rest to an acceleration, is of backward Euler.
    assert abs(ledger["numerical_loss"]) < 0.02 * ledger["dissipation"]


def test_a_load_is_an_input_of_a_rigid_body(tmp_path):
    load = {"type": "force", "body": "b", "point": [0, 0, 0.05], "force": [1, 0, 0]}
    sim = scene({"f": load}, integrator="bdf2", time_step=1e-3)
    sim.step()
    sim.load("f").force = [2, 0, 0]
    sim.step()
    np.testing.assert_allclose(sim.body("b").load_force, [2, 0, 0], rtol=1e-14)
    twin = sim.clone()
    sim.save_state(tmp_path / "state.h5")
    other = scene({"f": load}, integrator="bdf2", time_step=1e-3)
    other.load_state(tmp_path / "state.h5")
    other.load("f").force = [2, 0, 0]
    for each in (sim, twin, other):
        each.step()
    np.testing.assert_array_equal(sim.body("b").velocity, twin.body("b").velocity)
    np.testing.assert_array_equal(sim.body("b").velocity, other.body("b").velocity)


def test_points_outside_are_told():
    load = {"type": "force", "body": "b", "point": [0, 0, 0.2], "force": [1, 0, 0]}
    with pytest.raises(sinew.Error, match="point of load 'f'") as caught:
        scene({"f": load})
    assert caught.value.kind == "point-outside-mesh"
    run(scene({"f": {**load, "outside": "nearest"}}, integrator="bdf2", time_step=1e-3), 2e-3)
