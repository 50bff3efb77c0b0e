"""Universal and cylindrical joints: Cardan's relation, the transmitted torque, and the freedom of a sleeve on a shaft."""

import numpy as np
import pytest
import sinew
from scipy.spatial.transform import Rotation

MASS = 0.2


def make(bodies, joints, step=1e-3, integrator="bdf2", gravity=(0.0, 0.0, 0.0), **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": list(gravity), "bodies": bodies, "joints": joints, **more})


def shaft(centre, turn, **more):
    """A cylinder along x, rotated about z by `turn`."""
    lies = Rotation.from_euler("yz", [90.0, turn], degrees=True).as_rotvec()
    return {"type": "rigid", "shape": {"cylinder": {"radius": 0.005, "height": 0.08}}, "mass": MASS,
            "pose": {"position": list(centre), "rotation": lies.tolist()}, **more}


def cardan(bend, integrator="bdf2", **actuators):
    """A shaft along x drives one at an angle of `bend` (deg); the arm of the first is vertical at the start."""
    out = np.array([np.cos(np.radians(bend)), np.sin(np.radians(bend)), 0.0])
    arm = [-out[1], out[0], 0.0]
    return make(
        {"first": shaft([-0.05, 0.0, 0.0], 0.0), "second": shaft(0.05 * out, bend)},
        {"in": {"type": "hinge", "bodies": ["world", "first"], "point": [-0.05, 0, 0], "axis": [1, 0, 0]},
         "out": {"type": "hinge", "bodies": ["world", "second"], "point": (0.05 * out).tolist(), "axis": out.tolist()},
         "cross": {"type": "universal", "bodies": ["first", "second"], "point": [0, 0, 0], "axes": [[0, 0, 1], arm]}},
        integrator=integrator, solver={"method": "newton"}, actuators=actuators)  # fmt: skip


@pytest.mark.parametrize("bend", [20.0, 45.0, 60.0])
def test_angles_of_a_cardan_joint(bend):
    # The arms z cos(a) - y sin(a) and m cos(b) + z sin(b) are perpendicular: tan(b) = cos(bend) tan(a).
    sim = cardan(bend, motor={"type": "motor", "joint": "in", "command": {"velocity": 10.0}})
    share = np.cos(np.radians(bend))
    slowest, fastest = np.inf, 0.0
    for _ in range(700):
        sim.step()
        a, b = sim.joint("in").angle, sim.joint("out").angle
        wanted = np.arctan2(share * np.sin(a), np.cos(a))
        wanted += 2.0 * np.pi * np.round((a - wanted) / (2.0 * np.pi))
        assert b == pytest.approx(wanted, abs=1e-9)
        if sim.time > 0.05:  # the start from rest has decayed
            rate = np.linalg.norm(sim.body("second").velocity[3:]) / 10.0
            slowest, fastest = min(slowest, rate), max(fastest, rate)
    # db/da = cos(bend)/(cos(a)^2 + cos(bend)^2 sin(a)^2) lies between cos(bend) and its inverse; rates are of second order.
    assert slowest == pytest.approx(share, rel=2e-3) and fastest == pytest.approx(1.0 / share, rel=2e-3)
    assert sim.joint("cross").gap < 1e-9 * 0.08


@pytest.mark.parametrize("angle", [0.2, 0.6, 1.3])
def test_torque_through_a_cardan_joint(angle):
    # Virtual work: a torque T on the second shaft requires -T db/da of the motor that holds the first one.
    bend, load = 40.0, 0.05
    sim = cardan(bend, "backward-euler", hold={"type": "motor", "joint": "in", "command": {"angle": {"ramp": {"to": angle, "duration": 0.1}}}},
                 load={"type": "motor", "joint": "out", "command": {"torque": {"ramp": {"to": load, "duration": 0.1}}}})  # fmt: skip
    sim.step(400)
    share, a = np.cos(np.radians(bend)), sim.joint("in").angle
    assert a == pytest.approx(angle, abs=1e-9)
    ratio = share / (np.cos(a)**2 + share**2 * np.sin(a)**2)
    assert sim.actuator("hold").torque == pytest.approx(-load * ratio, rel=1e-6)


def sleeve(velocity, **more):
    axis = np.array([2.0, 1.0, 2.0]) / 3.0
    across = np.cross([0.0, 0.0, 1.0], axis)
    lies = np.arccos(axis[2]) * across / np.linalg.norm(across)
    body = {"type": "rigid", "shape": {"cylinder": {"radius": 0.02, "height": 0.05}}, "mass": MASS,
            "pose": {"position": [0, 0, 0], "rotation": lies.tolist()}, "velocity": velocity}
    return axis, make({"sleeve": body}, {"rail": {"type": "cylindrical", "bodies": ["world", "sleeve"], "point": [0, 0, 0], "axis": axis.tolist()}},
                      **more)  # fmt: skip


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
def test_a_sleeve_slides_and_spins_freely(integrator):
    axis = np.array([2.0, 1.0, 2.0]) / 3.0
    axis, sim = sleeve({"linear": (0.3 * axis).tolist(), "angular": (7.0 * axis).tolist()}, integrator=integrator)
    sim.step(500)
    body = sim.body("sleeve")
    np.testing.assert_allclose(body.position, 0.15 * axis, atol=1e-11)
    np.testing.assert_allclose(body.velocity, [*(0.3 * axis), *(7.0 * axis)], rtol=0, atol=1e-9)
    assert np.linalg.norm(sim.joint("rail").force) < 1e-9 and np.linalg.norm(sim.joint("rail").moment) < 1e-9


@pytest.mark.parametrize("integrator", ["bdf2", "generalized-alpha"])
def test_a_sleeve_falls_along_its_rail(integrator):
    # Only the component of the weight along the rail accelerates the sleeve; the rail carries the rest.
    axis, sim = sleeve({}, integrator=integrator, gravity=(0.0, 0.0, -9.81))
    sim.step(200)
    body, weight = sim.body("sleeve"), np.array([0.0, 0.0, -9.81])
    np.testing.assert_allclose(body.velocity[:3], 0.2 * (weight @ axis) * axis, atol=1e-9)
    np.testing.assert_allclose(body.velocity[3:], 0.0, atol=1e-9)
    # The first step is backward Euler, whose displacement is too large by g h^2/2.
    assert body.position @ axis == pytest.approx(0.5 * 0.2**2 * (weight @ axis), abs=9.81 * 1e-6)
    np.testing.assert_allclose(body.position - body.position @ axis * axis, 0.0, atol=1e-11)
    np.testing.assert_allclose(np.asarray(sim.joint("rail").force), -MASS * (weight - weight @ axis * axis), atol=1e-9)


def thrown(step, duration=0.2):
    """Final linear and angular momentum of two sleeves on one axis that rotate, slide and tumble together."""
    inertia = MASS * np.array([(3 * 0.02**2 + 0.05**2) / 12, (3 * 0.02**2 + 0.05**2) / 12, 0.02**2 / 2])
    tumble, speed = np.array([0.0, 4.0, 0.0]), np.array([0.1, 0.2, -0.1])
    bodies = {}
    for name, z, slide, spin in (("one", -0.03, -0.05, 30.0), ("two", 0.03, 0.1, -10.0)):
        at = np.array([0.0, 0.0, z])
        bodies[name] = {"type": "rigid", "shape": {"cylinder": {"radius": 0.02, "height": 0.05}}, "mass": MASS, "pose": {"position": at.tolist()},
                        "velocity": {"linear": (speed + np.cross(tumble, at) + [0, 0, slide]).tolist(), "angular": (tumble + [0, 0, spin]).tolist()}}
    sim = make(bodies, {"axle": {"type": "cylindrical", "bodies": ["one", "two"], "point": [0, 0, 0], "axis": "z"}}, step=step)

    def momenta():
        linear, angular = np.zeros(3), np.zeros(3)
        for name in bodies:
            body = sim.body(name)
            w, x, y, z = body.rotation
            turn = Rotation.from_quat([x, y, z, w]).as_matrix()
            linear += MASS * body.velocity[:3]
            angular += MASS * np.cross(body.position, body.velocity[:3]) + turn @ (inertia * (turn.T @ body.velocity[3:]))
        return linear, angular

    before = momenta()
    sim.run(duration=duration)
    after = momenta()
    one, two = (sim.body(name) for name in ("one", "two"))
    w, x, y, z = one.rotation
    axis = Rotation.from_quat([x, y, z, w]).apply([0.0, 0.0, 1.0])
    return before, after, np.cross(two.position - one.position, axis), (two.velocity[3:] - one.velocity[3:]) @ axis


def test_bodies_on_one_axle_keep_their_momentum():
    errors = []
    for step in (2e-3, 1e-3, 5e-4):
        before, after, apart, spin = thrown(step)
        np.testing.assert_allclose(after[0], before[0], rtol=0, atol=1e-12)
        np.testing.assert_allclose(apart, 0.0, atol=1e-10)
        assert spin == pytest.approx(-40.0, rel=1e-3)  # no moment acts about the axle
        errors.append(np.linalg.norm(after[1] - before[1]) / np.linalg.norm(before[1]))
    # The integrator is of second order.
    assert errors[-1] < 1e-4
    assert np.log2(errors[0] / errors[2]) / 2 == pytest.approx(2.0, abs=0.3)
