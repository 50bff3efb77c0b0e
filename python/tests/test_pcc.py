"""Constant-curvature arms from Python."""

import numpy as np
import pytest
import sinew
from scipy.spatial.transform import Rotation

LENGTHS = [0.14] * 4
MASSES = [0.190, 0.146, 0.090, 0.090]


def arm(**more):
    return sinew.pcc.Arm(LENGTHS, MASSES, 0.108, 4.2e-3, **more)


def test_the_examples_of_the_guide():
    robot = sinew.pcc.Arm(lengths=LENGTHS, masses=MASSES, stiffness=[0.108] * 4, damping=[4.2e-3] * 4)
    theta, theta_dot, torque = np.full(4, 0.1), np.zeros(4), np.zeros(4)
    acceleration = robot.acceleration(theta, theta_dot, torque)
    assert acceleration.shape == (4,)
    np.testing.assert_allclose(robot.inverse_dynamics(theta, theta_dot, acceleration), torque, atol=1e-12)
    np.testing.assert_allclose(robot.endpoints(np.zeros(4))[-1], [0, 0, -0.56], atol=1e-15)
    assert robot.endpoints(theta)[-1, 0] > 0.05


def test_one_hanging_segment_by_hand():
    # Mass at the midpoint of the arc: x = L (1 - cos(theta/2))/theta, z = -L sin(theta/2)/theta.
    length, mass, stiffness, damping, gravity = 0.3, 0.2, 0.05, 0.01, 9.81
    robot = sinew.pcc.Arm([length], [mass], [stiffness], [damping])
    theta, rate = 0.7, 1.1

    def place(t):
        return np.array([length * (1 - np.cos(t / 2)) / t, -length * np.sin(t / 2) / t])

    h = 1e-4
    slope = (place(theta + h) - place(theta - h)) / (2 * h)
    bend = (place(theta + h) - 2 * place(theta) + place(theta - h)) / h**2
    expected = (-mass * (slope @ bend) * rate**2 - mass * gravity * slope[1] - stiffness * theta - damping * rate) / (
        mass * (slope @ slope))
    np.testing.assert_allclose(robot.acceleration([theta], [rate], [0.0]), [expected], rtol=1e-5)
    np.testing.assert_allclose(robot.mass_matrix([theta]), [[mass * slope @ slope]], rtol=1e-6)
    energies = robot.energies([theta], [rate])
    assert robot.energy([theta], [rate]) == pytest.approx(sum(energies.values()))
    assert energies["gravity"] == pytest.approx(mass * gravity * place(theta)[1])


def test_simulation_settles_at_the_equilibrium():
    robot = sinew.pcc.Arm(LENGTHS, MASSES, 0.108, 0.1, centre="distributed")
    torque = np.array([0.0, 0.05, -0.02, 0.04])
    theta, rate = robot.simulate(np.zeros(4), np.zeros(4), np.tile(torque, (6000, 1)), time_step=5e-3)
    assert theta.shape == rate.shape == (6001, 4)
    np.testing.assert_allclose(theta[-1], robot.equilibrium(torque), atol=1e-6)


def test_derivatives_and_points():
    robot = arm(bending="spatial", axial_stiffness=200.0, axial_damping=0.1, gamma=[0, 0.3, -0.2, 1.0])
    assert robot.coordinates == 12
    random = np.random.default_rng(1)
    theta, rate, torque = random.normal(size=(3, 12)) * np.array([[0.3], [1.0], [0.02]])
    theta[2::3] *= 0.02
    acceleration, by_theta, by_rate, by_torque = robot.linearise(theta, rate, torque)
    np.testing.assert_allclose(by_torque @ robot.mass_matrix(theta), np.eye(12), atol=1e-8)
    assert by_theta.shape == by_rate.shape == (12, 12)
    step = 1e-6 * random.normal(size=12)
    moved = robot.point(theta + step, 3, 0.4, offset=(0.01, 0.02)) - robot.point(theta - step, 3, 0.4, offset=(0.01, 0.02))
    np.testing.assert_allclose(robot.jacobian(theta, 3, 0.4, offset=(0.01, 0.02)) @ (2 * step), moved, atol=1e-13)
    c = robot.coriolis_matrix(theta, rate)
    h = 1e-6
    skew = (robot.mass_matrix(theta + h * rate) - robot.mass_matrix(theta - h * rate)) / (2 * h) - 2 * c
    np.testing.assert_allclose(skew, -skew.T, atol=1e-8)


def test_gravity_is_a_magnitude_or_a_vector():
    bent = np.full(4, 0.2)
    still = np.zeros(4)
    plain = arm().acceleration(bent, still, still)
    np.testing.assert_array_equal(plain, arm(gravity=[0, 0, -9.81]).acceleration(bent, still, still))
    assert not np.allclose(plain, arm(gravity=0.0).acceleration(bent, still, still))


def test_stiffness_by_length():
    np.testing.assert_allclose(sinew.pcc.channel_stiffness(0.108, [0.1, 0.2]), [0.108, 0.216])
    np.testing.assert_allclose(sinew.pcc.beam_stiffness(0.02, [0.1, 0.2]), [0.2, 0.1])


@pytest.mark.parametrize("change, kind, text", [
    ({"masses": [0.1, -0.2]}, "out-of-range", "segment 1 of arm: its mass is -0.2 kg"),
    ({"lengths": [0.1, 0.0]}, "out-of-range", "its length is 0 m"),
    ({"masses": [0.1]}, "wrong-shape", "masses"),
    ({"centre": "middle"}, "unknown-choice", "'distributed'"),
    ({"damping": float("nan")}, "not-finite", "damping"),
    ({"actuation": [[1.0, 0.0]]}, "wrong-length", "2 coordinates"),
])
def test_bad_input(change, kind, text):
    with pytest.raises(sinew.Error) as caught:
        sinew.pcc.Arm(**{"lengths": [0.1, 0.1], "masses": [0.1, 0.1], "stiffness": 0.1, "damping": 0.0, **change})
    assert caught.value.kind == kind
    assert text in str(caught.value)


def test_wrong_shapes_of_states():
    with pytest.raises(sinew.Error) as caught:
        arm().acceleration(np.zeros(3), np.zeros(4), np.zeros(4))
    assert caught.value.kind == "wrong-shape"
    with pytest.raises(sinew.Error):
        arm().point(np.zeros(4), 4)


SCENE = {
    "sinew": 1, "time_step": 0.005, "integrator": "backward-euler", "gravity": [0, 0, -9.81],
    "bodies": {"arm": {"type": "pcc", "centre": "distributed", "radius": 0.025, "segments": [
        {"length": 0.14, "mass": mass, "stiffness": 0.108, "damping": 0.05} for mass in MASSES]}},
    "actuators": {f"bend_{i}": {"type": "torque", "body": "arm", "segment": i,
                              "limits": {"torque": {"min": -0.3, "max": 0.3}}} for i in range(4)},
    "effectors": {"tip": {"body": "arm", "point": [0, 0, -0.56], "directions": [[1, 0, 0], [0, 0, 1]]}},
}


def test_an_arm_in_a_scene_is_the_arm_by_itself():
    sim = sinew.load(SCENE)
    body = sim.body("arm")
    torque = [0.02, 0.05, -0.03, 0.08]
    for i, value in enumerate(torque):
        sim.actuator(f"bend_{i}").torque = value
    sim.solve_static()
    alone = body.arm
    np.testing.assert_allclose(body.coordinates, alone.equilibrium(torque), atol=1e-9)
    np.testing.assert_allclose(sim.effector("tip").position, alone.endpoints(body.coordinates)[-1], atol=1e-12)
    assert sim.actuator("bend_3").angle == pytest.approx(body.coordinates[3])
    assert np.abs(body.positions - body.rest_positions).max() > 0.03
    sim.step(10)
    np.testing.assert_allclose(body.rates, 0.0, atol=1e-9)


def test_inverse_control_of_an_arm():
    sim = sinew.load(SCENE)
    goal = np.array([0.15, 0.0, -0.45])
    ik = sinew.InverseController(sim, targets={"tip": goal})
    for _ in range(400):
        ik.step()
    assert ik.error < 1e-5
    np.testing.assert_allclose(sim.effector("tip").position, goal, atol=1e-5)


def test_a_cable_bends_an_arm():
    scene = {**SCENE, "actuators": {"tendon": {
        "type": "cable", "body": "arm", "points": [[0.02, 0, -0.001], [0.02, 0, -0.559]], "guide_spacing": 0.07,
        "command": {"tension": 2.0}}}}
    sim = sinew.load(scene)
    sim.solve_static()
    assert sim.effector("tip").position[0] > 0.05
    assert (sim.body("arm").coordinates > 0).all()


@pytest.mark.parametrize("change, kind, text", [
    (("bodies", "arm", "segments", 1, "mass", -0.1), "out-of-range", "mass"),
    (("bodies", "arm", "segments", 0, "stiffness", "3 N"), "wrong-dimension", "stiffness"),
    (("bodies", "arm", "pose", {"direction": [1, 0, 0]}), None, ""),
    (("actuators", "bend_0", "segment", 7), "index-out-of-range", "no segment 7"),
    (("actuators", "bend_0", "towards", "across"), "unknown-choice", "planar"),
    (("effectors", "tip", "point", [0.1, 0, -0.3]), "point-outside-mesh", "outside arm"),
])
def test_bad_scenes(change, kind, text):
    import copy

    scene = copy.deepcopy(SCENE)
    *path, key, value = change
    at = scene
    for part in path:
        at = at[part]
    at[key] = value
    if kind is None:
        scene["bodies"]["arm"]["pose"] = {"direction": [1, 0, 0], "side": [2, 0, 0]}
        kind = "out-of-range"
        text = "side"
    with pytest.raises(sinew.Error) as caught:
        sinew.load(scene)
    assert caught.value.kind == kind
    assert text in str(caught.value)


ORIENTED = """
sinew: 1
time_step: 10 ms
integrator: backward-euler
bodies:
  arm:
    type: pcc
    radius: 10 mm
    segments:
      - {length: 60 mm, mass: 20 g, stiffness: 0.02 N m, damping: 1e-3 N m s, bending: spatial}
      - {length: 60 mm, mass: 20 g, stiffness: 0.02 N m, damping: 1e-3 N m s, bending: spatial}
actuators:
  pull_x: {type: cable, body: arm, points: [8 0 0 mm, 8 0 -60 mm, 8 0 -120 mm], limits: {tension: {max: 5 N}}, command: {tension: 0 N}}
  pull_y: {type: cable, body: arm, points: [0 8 0 mm, 0 8 -60 mm, 0 8 -120 mm], limits: {tension: {max: 5 N}}, command: {tension: 0 N}}
  short: {type: cable, body: arm, points: [-8 0 0 mm, -8 0 -60 mm], limits: {tension: {max: 5 N}}, command: {tension: 0 N}}
effectors:
  section: {body: arm, orientation: 0 0 -120 mm}
  triangle: {body: arm, orientation: [0 0 -120 mm, 5 0 -120 mm, 0 5 -120 mm]}
"""


def oriented(folder, controller=""):
    path = folder / "scene.yaml"
    path.write_text(ORIENTED + controller)
    return sinew.load(path)


def test_a_sections_orientation_is_that_of_any_triangle_in_it(tmp_path):
    sim = oriented(tmp_path)
    sim.actuators["pull_x"].tension, sim.actuators["pull_y"].tension = 1.5, 0.8
    for _ in range(20):
        sim.step()
    section, triangle = sim.effectors["section"], sim.effectors["triangle"]
    assert np.linalg.norm(section.rotation) > 0.3
    np.testing.assert_allclose(section.rotation, triangle.rotation, atol=1e-12)
    np.testing.assert_allclose(section.velocity, triangle.velocity, atol=1e-12)
    rows = {row: k for k, row in enumerate(sim.rows)}
    one, three = ([rows[f"{name}.{axis}"] for axis in "xyz"] for name in ("section", "triangle"))
    compliance = sim.linearise().W
    np.testing.assert_allclose(compliance[one], compliance[three], atol=1e-11 * np.abs(compliance).max())


def test_cables_turn_an_arms_tip_to_a_rotation(tmp_path):
    sim = oriented(tmp_path, """
controllers:
  turn:
    type: inverse
    effectors: {section: {rotation: 0.3 0.25 0 rad, weight: [1, 1, 0]}}
    actuators: [pull_x, pull_y, short]
""")
    for _ in range(400):
        sim.step()
    # The remaining rotation is about z, whose error has no weight.
    to_go = Rotation.from_rotvec([0.3, 0.25, 0]) * Rotation.from_rotvec(np.array(sim.effectors["section"].rotation)).inv()
    np.testing.assert_allclose(to_go.as_rotvec()[:2], 0, atol=1e-4)


def test_a_body_of_finite_elements_has_no_rigid_section():
    with pytest.raises(sinew.Error, match="deforms everywhere.*three points"):
        sinew.load({"sinew": 1, "bodies": {"beam": {
            "type": "fem", "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
            "material": {"young_modulus": 1e5, "poisson_ratio": 0.3}, "fixed": {"set": "x_min"}}},
            "effectors": {"tip": {"body": "beam", "orientation": [0.1, 0.01, 0.01]}}})
