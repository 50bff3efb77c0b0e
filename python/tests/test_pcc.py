"""Constant-curvature arms from Python."""

import numpy as np
import pytest
import sinew

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
    # Mass at the arc's middle: x = L (1 - cos(theta/2))/theta, z = -L sin(theta/2)/theta.
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
