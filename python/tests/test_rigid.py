"""Rigid bodies and joints, compared with independently integrated equations of motion."""

import numpy as np
import pytest
import sinew
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

BOX = np.array([0.06, 0.04, 0.02])
MASS = 0.3
INERTIA = MASS / 12 * np.array([BOX[1]**2 + BOX[2]**2, BOX[0]**2 + BOX[2]**2, BOX[0]**2 + BOX[1]**2])


def box(**more):
    return {"type": "rigid", "shape": {"box": "60 40 20 mm"}, "mass": "300 g", **more}


def make(bodies, joints=None, step="1 ms", integrator="bdf2", gravity="0 0 -9.81 m/s^2", **more):
    scene = {"sinew": 1, "time_step": step, "integrator": integrator, "gravity": gravity, "bodies": bodies, **more}
    if joints:
        scene["joints"] = joints
    return sinew.load(scene)


def turned(body):
    w, x, y, z = body.rotation
    return Rotation.from_quat([x, y, z, w])


def tumbling(step, integrator, duration=0.5):
    """Spins a box about its unstable middle axis (Dzhanibekov effect). Returns final rotation, angular momentum and energy."""
    spin = [0.1, 20.0, 0.1]
    sim = make({"box": box(velocity={"angular": f"{spin[0]} {spin[1]} {spin[2]} rad/s"})}, step=f"{step} s",
               integrator=integrator, gravity="0 0 0 m/s^2")
    sim.run(duration=duration)
    body = sim.body("box")
    turn = turned(body).as_matrix()
    momentum = turn @ np.diag(INERTIA) @ turn.T @ body.velocity[3:]
    return turned(body), momentum, 0.5 * body.velocity[3:] @ momentum


def reference_tumbling(duration=0.5):
    def rate(_, state):
        quaternion, omega = state[:4], state[4:]  # omega in body axes
        turn = Rotation.from_quat(quaternion)
        spin = turn.apply(omega)
        x, y, z, w = quaternion
        change = 0.5 * np.array([
            spin[0] * w + spin[1] * z - spin[2] * y, spin[1] * w + spin[2] * x - spin[0] * z,
            spin[2] * w + spin[0] * y - spin[1] * x, -spin @ quaternion[:3]
        ])
        return np.concatenate([change, (np.cross(INERTIA * omega, omega)) / INERTIA])

    start = np.array([0, 0, 0, 1, 0.1, 20.0, 0.1])
    end = solve_ivp(rate, (0, duration), start, rtol=1e-12, atol=1e-12).y[:, -1]
    return Rotation.from_quat(end[:4] / np.linalg.norm(end[:4]))


@pytest.mark.parametrize("integrator,order", [("backward-euler", 1), ("bdf2", 2), ("generalized-alpha", 2)])
def test_free_rotation_converges_at_the_order_of_the_integrator(integrator, order):
    end = reference_tumbling()
    momentum = INERTIA * [0.1, 20.0, 0.1]
    errors, drifts = [], []
    for step in (4e-4, 2e-4, 1e-4):
        turn, carried, _ = tumbling(step, integrator)
        errors.append((turn * end.inv()).magnitude())
        drifts.append(np.linalg.norm(carried - momentum) / np.linalg.norm(momentum))
    found = np.log2(np.array(errors[:-1]) / errors[1:])
    print(integrator, errors, found, drifts)
    assert found[-1] > order - 0.25
    assert np.log2(drifts[-2] / drifts[-1]) > order - 0.25
    if order == 2:
        assert errors[-1] < 2e-2


def test_a_thrown_box_falls_as_a_point():
    sim = make({"box": box(pose={"position": "0 0 1 m"}, velocity={"linear": "1 0 2 m/s", "angular": "3 1 2 rad/s"})},
               integrator="generalized-alpha")
    sim.run(duration=0.2)
    np.testing.assert_allclose(sim.body("box").centre_of_mass, [0.2, 0, 1 + 0.4 - 0.5 * 9.81 * 0.04],
                               atol=9.81 * 1e-3**2)  # error of the first step, which starts without acceleration


def pendulum(theta, length, duration):
    """Reference for a box on a hinge along y, at `length` from its centre: final angle and rate."""
    inertia = INERTIA[1] + MASS * length**2

    def rate(_, state):
        return [state[1], -MASS * 9.81 * length * np.sin(state[0]) / inertia]

    return solve_ivp(rate, (0, duration), [theta, 0.0], rtol=1e-12, atol=1e-12).y[:, -1]


def swinging(step, integrator, duration=0.5):
    # The box hangs along -z and starts rotated by 60 degrees about y.
    length, start = 0.1, np.radians(60)
    centre = length * np.array([-np.sin(start), 0, -np.cos(start)])
    sim = make({"box": box(pose={"position": f"{centre[0]} {centre[1]} {centre[2]} m",
                                 "rotation": {"axis": "y", "angle": f"{start} rad"}})},
               {"pin": {"type": "hinge", "bodies": ["world", "box"], "point": "0 0 0 m", "axis": "0 1 0"}},
               step=f"{step} s", integrator=integrator)
    sim.run(duration=duration)
    return start + sim.joint("pin").angle, sim


@pytest.mark.parametrize("integrator,order", [("backward-euler", 1), ("bdf2", 2), ("generalized-alpha", 2)])
def test_pendulum_on_a_hinge(integrator, order):
    angle, speed = pendulum(np.radians(60), 0.1, 0.5)
    errors = []
    for step in (2e-3, 1e-3, 5e-4):
        found, sim = swinging(step, integrator)
        errors.append(abs(found - angle))
        assert sim.joint("pin").gap < 1e-9 * 0.1
    print(integrator, errors)
    assert np.log2(errors[-2] / errors[-1]) > order - 0.25
    if order == 2:
        # The hinge force carries the weight and accelerates the centre of mass.
        turn = np.array([-np.sin(angle), 0, -np.cos(angle)])
        along = np.array([-np.cos(angle), 0, np.sin(angle)])
        inertia = INERTIA[1] + MASS * 0.01
        acceleration = -MASS * 9.81 * 0.1 * np.sin(angle) / inertia * 0.1 * along - speed**2 * 0.1 * turn
        force = MASS * acceleration + [0, 0, MASS * 9.81]
        np.testing.assert_allclose(sim.joint("pin").force, force, atol=2e-3 * np.linalg.norm(force))


def test_double_pendulum():
    # Two bars of length 0.2 m, hinged at their ends along y.
    length, mass = 0.2, 0.1
    inertia = mass * (length**2 + 0.01**2) / 12

    def rate(_, state):
        a, b, da, db = state
        m11 = inertia + mass * length**2 / 4 + mass * length**2
        m12 = mass * length**2 / 2 * np.cos(a - b)
        m22 = inertia + mass * length**2 / 4
        f1 = -mass * length**2 / 2 * np.sin(a - b) * db**2 - 1.5 * mass * 9.81 * length * np.sin(a)
        f2 = mass * length**2 / 2 * np.sin(a - b) * da**2 - 0.5 * mass * 9.81 * length * np.sin(b)
        return np.concatenate([[da, db], np.linalg.solve([[m11, m12], [m12, m22]], [f1, f2])])

    expected = solve_ivp(rate, (0, 0.6), [np.pi / 2, np.pi / 2, 0, 0], rtol=1e-12, atol=1e-12).y[:, -1]
    bar = {"type": "rigid", "shape": {"box": "200 10 10 mm"}, "mass": "100 g"}
    errors = []
    for step in (1e-3, 5e-4):
        sim = make({"upper": {**bar, "pose": {"position": "100 0 0 mm"}},
                    "lower": {**bar, "pose": {"position": "300 0 0 mm"}}},
                   {"top": {"type": "hinge", "bodies": ["world", "upper"], "point": "0 0 0 mm", "axis": "0 -1 0"},
                    "middle": {"type": "hinge", "bodies": ["upper", "lower"], "point": "200 0 0 mm",
                               "axis": "0 -1 0"}}, step=f"{step} s", integrator="bdf2")
        sim.run(duration=0.6)
        first = np.pi / 2 + sim.joint("top").angle
        errors.append(np.abs([first - expected[0], first + sim.joint("middle").angle - expected[1]]).max())
    assert errors[1] < 5e-3 and np.log2(errors[0] / errors[1]) > 1.7, errors


def test_heavy_top_precesses():
    # A fast-spinning disc on a rod with a ball joint: the precession m g l / (I3 spin) of a steady top
    # (Goldstein, Classical Mechanics, sec. 5.7) is exact for a tilt of 90 degrees.
    radius, height, mass, arm, spin = 0.05, 0.02, 0.2, 0.1, 200.0
    i3 = 0.5 * mass * radius**2
    precession = mass * 9.81 * arm / (i3 * spin)
    sim = make({"disc": {"type": "rigid", "shape": {"cylinder": {"radius": f"{radius} m", "height": f"{height} m"}},
                         "mass": f"{mass} kg",
                         "pose": {"position": f"{arm} 0 0 m", "rotation": {"axis": "0 1 0", "angle": "90 deg"}},
                         "velocity": {"linear": f"0 {precession * arm} 0 m/s",
                                      "angular": f"{spin} 0 {precession} rad/s"}}},
               {"foot": {"type": "ball", "bodies": ["world", "disc"], "point": "0 0 0 m"}},
               step="0.2 ms", integrator="generalized-alpha")
    sim.run(duration=0.5)
    at = sim.body("disc").centre_of_mass
    angle = np.unwrap([0, np.arctan2(at[1], at[0])])[1]
    assert angle % (2 * np.pi) == pytest.approx(precession * 0.5 % (2 * np.pi), abs=0.01)
    assert abs(at[2]) < 1e-3 * arm


def test_slider_crank_runs_as_its_geometry_says():
    # A crank of 50 mm turned by a motor, a rod of 150 mm, a slider along x.
    bar = {"type": "rigid", "density": "1000 kg/m^3"}
    sim = make({"crank": {**bar, "shape": {"box": "50 5 5 mm"}, "pose": {"position": "25 0 0 mm"}},
                "rod": {**bar, "shape": {"box": "150 5 5 mm"}, "pose": {"position": "125 0 0 mm"}},
                "piston": {**bar, "shape": {"box": "20 20 20 mm"}, "pose": {"position": "200 0 0 mm"}}},
               {"shaft": {"type": "hinge", "bodies": ["world", "crank"], "point": "0 0 0 mm", "axis": "z"},
                "knee": {"type": "hinge", "bodies": ["crank", "rod"], "point": "50 0 0 mm", "axis": "z"},
                "pin": {"type": "ball", "bodies": ["rod", "piston"], "point": "200 0 0 mm"},
                "guide": {"type": "slider", "bodies": ["world", "piston"], "point": "200 0 0 mm", "axis": "1 0 0"}},
               actuators={"motor": {"type": "motor", "joint": "shaft", "command": {"velocity": "10 rad/s"}}})
    for _ in range(700):
        sim.step()
        angle = sim.joint("shaft").angle
        expected = 0.05 * np.cos(angle) + np.sqrt(0.15**2 - (0.05 * np.sin(angle))**2)
        assert 0.2 + sim.joint("guide").displacement == pytest.approx(expected, abs=1e-9)
    assert sim.joint("shaft").angle == pytest.approx(7.0, abs=1e-9)  # more than one turn
    motor = sim.actuator("motor")
    assert motor.velocity == 10.0
    motor.velocity = -20.0
    assert motor.velocity == -20.0
    sim.run(duration=0.1)
    assert sim.joint("shaft").angle == pytest.approx(5.0, abs=1e-9)
    motor.torque = 0.0
    assert motor.velocity == 0.0  # another quantity is commanded


@pytest.mark.parametrize("most", [3, 50])
def test_a_commanded_velocity_is_that_of_the_whole_step(most):
    """Holds for steps that are split, too, as here with too few iterations for a jump of 50 rad/s."""
    bar = {"type": "rigid", "density": "1000 kg/m^3"}
    sim = make({"upper": {**bar, "shape": {"box": "100 10 5 mm"}, "pose": {"position": "50 0 0 mm"}},
                "lower": {**bar, "shape": {"box": "60 10 5 mm"}, "pose": {"position": "130 0 0 mm"}}},
               {"shoulder": {"type": "hinge", "bodies": ["world", "upper"], "point": "0 0 0 mm", "axis": "y"},
                "elbow": {"type": "hinge", "bodies": ["upper", "lower"], "point": "100 0 0 mm", "axis": "y"}},
               step="2 ms", integrator="backward-euler", solver={"method": "newton", "max_iterations": most},
               actuators={"motor": {"type": "motor", "joint": "shoulder", "command": {"velocity": "0 rad/s"}}})
    sim.step(3)
    sim.actuator("motor").velocity = 50.0
    for k in range(1, 6):
        sim.step()
        assert sim.report.substeps == 1 or most == 3
        assert sim.report.substeps > 1 or most == 50 or k > 1
        assert sim.joint("shoulder").angle == pytest.approx(0.1 * k, abs=1e-9)


def test_a_hinge_with_friction_comes_to_rest_when_it_must():
    # A moment M stops the spin w of a body with inertia I within I w / M.
    spin, moment = 10.0, 1e-3
    sim = make({"box": box(velocity={"angular": f"0 0 {spin} rad/s"})},
               {"pin": {"type": "hinge", "bodies": ["world", "box"], "point": "0 0 0 m", "axis": "z",
                        "friction": f"{moment} N m"}}, integrator="backward-euler")
    stop = INERTIA[2] * spin / moment
    sim.run(duration=round(0.9 * stop, 3))
    assert sim.body("box").velocity[5] == pytest.approx(0.1 * spin, rel=0.02)
    sim.run(duration=round(0.2 * stop, 3))
    assert abs(sim.body("box").velocity[5]) < 1e-9
    assert sim.joint("pin").angle == pytest.approx(0.5 * spin * stop, rel=5e-3)


def test_a_hinge_stops_at_its_limits():
    sim = make({"box": box(pose={"position": "100 0 0 mm"})},
               {"pin": {"type": "hinge", "bodies": ["world", "box"], "point": "0 0 0 m", "axis": "0 1 0",
                        "limits": {"angle": {"min": "0 deg", "max": "30 deg"}}}}, integrator="backward-euler")
    sim.run(duration=1.0)
    assert sim.joint("pin").angle == pytest.approx(np.radians(30), abs=1e-7)


def test_a_motor_holds_what_it_is_told_within_its_torque():
    bodies = {"box": box(pose={"position": "100 0 0 mm"})}
    joints = {"pin": {"type": "hinge", "bodies": ["world", "box"], "point": "0 0 0 m", "axis": "0 -1 0"}}
    weight = MASS * 9.81 * 0.1
    for most, holds in ((1.01, True), (0.99, False)):
        sim = make(bodies, joints, actuators={
            "motor": {"type": "motor", "joint": "pin", "command": {"angle": "0 deg"},
                      "limits": {"torque": {"min": f"{-most * weight} N m", "max": f"{most * weight} N m"}}}})
        sim.run(duration=0.2)
        angle = sim.joint("pin").angle
        assert (abs(angle) < 1e-9) == holds
        if holds:
            assert sim.actuator("motor").torque == pytest.approx(weight, rel=1e-9)


def test_what_nothing_holds_is_refused_in_statics():
    with pytest.raises(sinew.Error, match="nothing holds this body"):
        make({"box": box()}, integrator="quasi-static")
    pin = {"pin": {"type": "hinge", "bodies": ["world", "box"], "point": "0 0 0 m", "axis": "z"}}
    with pytest.raises(sinew.Error, match="leave it free") as caught:
        make({"box": box()}, pin, integrator="quasi-static", gravity="0 0 0 m/s^2")
    assert caught.value.kind == "nothing-fixed"
    # Weight may hold a mechanism, so a step decides. About its own centre the box rests at any angle: it stays where it is.
    sim = make({"box": box()}, pin, integrator="quasi-static")
    for solve in (sim.step, sim.solve_static):
        solve()
        assert sim.report.status == "solved"
        np.testing.assert_allclose(sim.body("box").rotation, [1, 0, 0, 0], atol=1e-6)
        np.testing.assert_allclose(sim.joint("pin").force, [0, 0, MASS * 9.81], atol=1e-6 * MASS * 9.81)


@pytest.mark.parametrize("limits", [{}, {"limits": {"torque": {"min": "-1 N m", "max": "1 N m"}}}])
def test_motors_hold_an_arm_in_statics(limits):
    # Two links driven by motors, quasi-static and static: the torques balance the weights.
    sim = make({"upper": box(pose={"position": "50 0 0 mm"}), "lower": box(pose={"position": "150 0 0 mm"})},
               {"shoulder": {"type": "hinge", "bodies": ["world", "upper"], "point": "0 0 0 mm", "axis": "0 -1 0"},
                "elbow": {"type": "hinge", "bodies": ["upper", "lower"], "point": "100 0 0 mm", "axis": "0 -1 0"}},
               integrator="quasi-static", step="10 ms",
               actuators={"first": {"type": "motor", "joint": "shoulder", "command": {"angle": "30 deg"}, **limits},
                          "second": {"type": "motor", "joint": "elbow", "command": {"angle": "-50 deg"}, **limits}})
    for solve in (sim.solve_static, sim.step):
        solve()
        a, b = np.radians([30, -20])
        lower = MASS * 9.81 * 0.05 * np.cos(b)
        upper = MASS * 9.81 * (0.05 * np.cos(a) + 0.1 * np.cos(a)) + lower
        assert sim.actuator("first").torque == pytest.approx(upper, rel=1e-9)
        assert sim.actuator("second").torque == pytest.approx(lower, rel=1e-9)


def test_a_motor_that_is_too_weak_gives_way_in_statics():
    sim = make({"arm": box(pose={"position": "50 0 0 mm"})},
               {"pin": {"type": "hinge", "bodies": ["world", "arm"], "point": "0 0 0 mm", "axis": "0 -1 0"}},
               integrator="quasi-static", step="10 ms",
               actuators={"motor": {"type": "motor", "joint": "pin", "command": {"angle": "0 deg"},
                                    "limits": {"torque": {"min": "-0.1 N m", "max": "0.1 N m"}}}})
    sim.step(2)
    weight = MASS * 9.81 * 0.05
    assert weight > 0.1
    # The arm hangs where the moment of its weight equals the limit of the motor.
    assert sim.actuator("motor").torque == pytest.approx(0.1)
    assert weight * np.cos(sim.joint("pin").angle) == pytest.approx(0.1, rel=1e-6)


def beam(**more):
    return {"type": "fem", "mesh": {"shape": "block", "length": "100 mm", "width": "10 mm", "height": "10 mm",
                                    "element_size": "5 mm"}, "element": "hex8",
            "material": {"model": "neo-hookean", "young_modulus": "1 MPa", "poisson_ratio": 0.45},
            "density": "1000 kg/m^3", "fixed": [{"box": "-1 -1 -1 1 11 11 mm"}], **more}


def test_a_rigid_weight_welded_to_a_beam_bends_it_as_a_force_and_moment_do():
    # The centre of the weight is 15 mm beyond the face.
    held = make({"beam": beam(), "weight": {"type": "rigid", "shape": {"box": "30 10 10 mm"}, "mass": "2 g",
                                            "pose": {"position": "115 5 5 mm"}}},
                {"bond": {"type": "weld", "bodies": ["beam", "weight"]}}, integrator="quasi-static")
    held.solve_static()
    joint = held.joint("bond")
    np.testing.assert_allclose(joint.force, [0, 0, 2e-3 * 9.81], atol=1e-9)
    np.testing.assert_allclose(joint.moment + np.cross(joint.centre - held.body("weight").centre_of_mass, joint.force),
                               0, atol=1e-10)
    # The welded face is rigid: its nodes keep their distances.
    end = held.body("beam").rest_positions[:, 0] > 0.0999
    now, rest = held.body("beam").positions[end], held.body("beam").rest_positions[end]
    spread = np.linalg.norm(now[:, None] - now[None], axis=-1) - np.linalg.norm(rest[:, None] - rest[None], axis=-1)
    assert np.abs(spread).max() < 1e-10
    assert held.body("weight").position[2] < 0.004


def test_save_and_load_goes_on_bit_for_bit(tmp_path):
    _, sim = swinging(1e-3, "bdf2", 0.1)
    _, other = swinging(1e-3, "bdf2", 0.02)
    sim.save_state(tmp_path / "state")
    sim.run(duration=0.1)
    other.load_state(tmp_path / "state")
    other.run(duration=0.1)
    assert np.array_equal(sim.body("box").positions, other.body("box").positions)
    assert sim.joint("pin").angle == other.joint("pin").angle


@pytest.mark.parametrize("change,message", [
    ({"mass": "0 g"}, "mass"),
    ({"shape": {"box": "60 -40 20 mm"}}, "edge of the box is not positive"),
    ({"inertia": "1e-5 1e-5 5e-5 kg m^2"}, "belong to no body"),
])
def test_bad_bodies_are_named(change, message):
    with pytest.raises(sinew.Error, match=message):
        make({"box": {**box(), **change}})


def test_bad_joints_are_named():
    pin = {"type": "hinge", "bodies": ["world", "box"], "point": "0 0 0 m", "axis": "z"}
    for change, message in (({"bodies": ["box", "box"]}, "two bodies"), ({"bodies": ["world", "bx"]}, "'box'"),
                            ({"axis": "0 0 0"}, "axis"), ({"friction": "-1 N m"}, "friction"),
                            ({"limits": {"angle": {"min": "10 deg"}}}, "0 where the scene puts the bodies")):
        with pytest.raises(sinew.Error, match=message):
            make({"box": box()}, {"pin": {**pin, **change}})
    with pytest.raises(sinew.Error, match="deforms"):
        make({"beam": beam()}, {"pin": {**pin, "bodies": ["world", "beam"]}})
