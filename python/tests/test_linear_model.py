"""Linear equations of motion: M, D, K, B, C and J of a robot at a state."""

import numpy as np
import pytest

import sinew

scipy_linalg = pytest.importorskip("scipy.linalg")
sparse_linalg = pytest.importorskip("scipy.sparse.linalg")

BEAM = """sinew: 1
time_step: {step}
integrator: bdf2
{gravity}
bodies:
  beam:
    type: fem
    mesh: {{shape: block, length: 200 mm, width: 10 mm, height: 10 mm, element_size: 5 mm}}
    element: tet10
    material: {{model: saint-venant-kirchhoff, young_modulus: 1 MPa, poisson_ratio: 0}}
    density: 1000 kg/m^3
    fixed: {{set: x_min}}
    {more}
actuators:
  push: {{type: force, body: beam, point: 200 5 5 mm, direction: 0 0 1}}
effectors:
  tip: {{body: beam, point: 200 5 5 mm}}
"""
YOUNG, DENSITY, LENGTH, SIDE = 1e6, 1000.0, 0.2, 0.01


def beam(step="1 ms", gravity="", more=""):
    return sinew.loads(BEAM.format(step=step, gravity=gravity, more=more))


def frequencies(linear, count):
    return np.sqrt(np.sort(sparse_linalg.eigsh(linear.K, count, linear.M, sigma=0.0, return_eigenvectors=False)))


def test_frequencies_of_a_cantilever():
    # Bernoulli: w = k^2 sqrt(E I/(rho A L^4)), k = 1.875104 and 4.694091; each twice, for bending about both axes.
    # Shear and rotatory inertia lower them by about (k h/L)^2/2: 0.4 % and 2.7 %.
    linear = beam().linear_model()
    found = frequencies(linear, 4)
    base = np.sqrt(YOUNG * SIDE**2 / 12 / (DENSITY * LENGTH**4))
    assert found[:2] == pytest.approx(1.875104**2 * base, rel=0.01)
    assert found[2:4] == pytest.approx(4.694091**2 * base, rel=0.04)
    assert (found[2:4] < 4.694091**2 * base).all()


def test_a_small_motion_has_the_frequency_of_the_mode():
    sim = beam(step="2 ms")
    linear = sim.linear_model()
    period = 2 * np.pi / frequencies(linear, 1)[0]
    force = 1e-4
    sim.actuator("push").force = force
    sim.solve_static()
    bent = sim.effector("tip").position[2]
    sim.actuator("push").force = 0.0
    run = sim.run(1.5 * period, record=["tip.position"])
    height = run["tip.position"][:, 2] - 0.005
    times = np.arange(len(height)) * sim.time_step
    cross = np.flatnonzero(np.diff(np.sign(height)))
    zero = [times[k] - height[k] * sim.time_step / (height[k + 1] - height[k]) for k in cross]
    assert zero[2] - zero[0] == pytest.approx(period, rel=0.01)
    # The static deflection is C K^-1 B force.
    assert bent - 0.005 == pytest.approx(force * (linear.C[2] @ sparse_linalg.spsolve(linear.K, linear.B[:, 0])), rel=1e-3)


def test_coordinates_and_names():
    sim = beam()
    before = sim.state()
    linear = sim.linear_model()
    assert sim.state() == before
    body = sim.body("beam")
    free = len(body.positions) - (body.rest_positions[:, 0] < 1e-9).sum()
    assert linear.M.shape == linear.K.shape == linear.D.shape == (3 * free, 3 * free)
    assert linear.first == [0, 3 * free] and linear.outputs == ["tip.x", "tip.y", "tip.z"]
    assert linear.B.shape == (3 * free, 1) and linear.C.shape == (3, 3 * free) and linear.J.shape == (0, 3 * free)
    assert linear.D.nnz == 0
    ones = np.tile([0.0, 0.0, 1.0], free)
    assert ones @ linear.M @ ones < DENSITY * LENGTH * SIDE**2
    assert linear.C[2] @ linear.B[:, 0] == pytest.approx(1.0)  # the force acts at the tip
    assert "LinearModel of" in repr(linear)


ARM = """sinew: 1
time_step: 1 ms
integrator: bdf2
gravity: 0 0 -9.81 m/s^2
bodies:
  arm:
    type: pcc
    direction: 1 0 0
    segments:
      - {length: 100 mm, mass: 100 g, stiffness: 0.2 N m, damping: 1e-3 N m s}
      - {length: 100 mm, mass: 80 g, stiffness: 0.1 N m, damping: 2e-3 N m s}
actuators:
  one: {type: torque, body: arm, segment: 0, command: {torque: 0.05 N m}}
  two: {type: torque, body: arm, segment: 1}
"""


def test_of_an_arm_against_its_forward_dynamics():
    # theta'' = M^-1 (B u + f - D theta' - K theta) at an equilibrium.
    sim = sinew.loads(ARM)
    sim.solve_static()
    linear, body = sim.linear_model(), sim.body("arm")
    mass, damping, stiffness = (one.toarray() for one in (linear.M, linear.D, linear.K))
    assert np.linalg.norm(linear.f) < 1e-7
    assert mass == pytest.approx(body.arm.mass_matrix(body.coordinates), rel=1e-8)
    torque = [0.05, 0.0]
    acceleration, by_angle, by_rate, by_torque = body.arm.linearise(body.coordinates, np.zeros(2), torque)
    assert np.abs(acceleration).max() < 1e-3
    assert -np.linalg.solve(mass, stiffness) == pytest.approx(by_angle, rel=1e-5)
    assert -np.linalg.solve(mass, damping) == pytest.approx(by_rate, rel=1e-6)
    assert np.linalg.solve(mass, linear.B) == pytest.approx(by_torque, rel=1e-8)


TWO = """sinew: 1
time_step: 1 ms
integrator: bdf2
bodies:
  a: {type: rigid, shape: {box: 20 20 20 mm}, mass: 100 g, pose: {position: 0 0 0 mm}}
  b: {type: rigid, shape: {box: 20 20 20 mm}, mass: 300 g, pose: {position: 30 0 0 mm}}
joints:
  pin: {type: weld, bodies: [a, b]}
"""


def test_welds_are_rows_of_j():
    linear = sinew.loads(TWO).linear_model()
    assert linear.J.shape == (6, 12) and np.linalg.matrix_rank(linear.J) == 6
    free = scipy_linalg.null_space(linear.J)
    assert free.shape == (12, 6)
    # The welded pair moves with the mass of both.
    together = np.zeros(12)
    together[[2, 8]] = 1.0
    assert np.linalg.norm(linear.J @ together) < 1e-9
    assert together @ linear.M @ together == pytest.approx(0.4, rel=1e-6)
