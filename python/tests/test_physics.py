"""Forces, equilibrium and compliance, compared with independent NumPy formulas and with differences."""

import numpy as np
import pytest
import sinew

YOUNG, POISSON = 4e5, 0.4
LAMBDA = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
MU = YOUNG / (2 * (1 + POISSON))


def corotational_forces(rest, tetrahedra, positions):
    """f_i = V R P grad N_i with F = R S from a singular value decomposition, one tetrahedron
    after another (Mueller and Gross 2004; the stress is that of small strain S - I)."""
    forces = np.zeros_like(positions)
    for nodes in tetrahedra:
        edges = (rest[nodes[1:]] - rest[nodes[0]]).T
        gradients = np.linalg.inv(edges)
        gradients = np.vstack([-gradients.sum(axis=0), gradients])
        volume = np.linalg.det(edges) / 6
        deformation = positions[nodes].T @ gradients
        left, _, right = np.linalg.svd(deformation)
        rotation = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
        strain = rotation.T @ deformation
        strain = 0.5 * (strain + strain.T) - np.eye(3)
        stress = 2 * MU * strain + LAMBDA * np.trace(strain) * np.eye(3)
        forces[nodes] += volume * gradients @ stress @ rotation.T
    return forces


@pytest.fixture
def loaded(scene):
    """The finger in equilibrium, bent by gravity, a cable and dead loads."""
    sim = sinew.load(scene, set=["gravity=0 2 -9.81 m/s^2"])
    sim.actuator("east").tension = 3.0
    sim.actuator("north").displacement = 0.003
    body = sim.body("finger")
    body.external_forces[body.node_sets["top"]] = [0.0, 0.01, 0.02]
    sim.solve_static()
    return sim


def test_internal_forces_are_those_of_numpy(sim):
    body = sim.body("finger")
    bent = body.rest_positions @ np.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, 1]])
    bent = bent + np.random.default_rng(1).normal(scale=5e-4, size=bent.shape)
    expected = corotational_forces(body.rest_positions, body.tetrahedra, bent)
    free = ~body.fixed
    assert body.internal_forces(bent)[free] == pytest.approx(expected[free], abs=1e-9)
    assert not body.internal_forces(bent)[~free].any()
    # The query does not change the simulation.
    assert np.array_equal(body.positions, body.rest_positions)


def test_static_equilibrium_balances_forces_of_numpy(loaded):
    body = loaded.body("finger")
    effort = loaded.linearise().effort
    internal = corotational_forces(body.rest_positions, body.tetrahedra, np.array(body.positions))
    outside = (
        body.external_forces
        + body.node_masses[:, None] * np.array([0, 2, -9.81])
        + np.einsum("k,knc->nc", effort, body.jacobian())
    )
    imbalance = (outside - internal)[~body.fixed]
    assert np.abs(outside[~body.fixed]).max() > 1.0
    assert np.abs(imbalance).max() < 1e-9
    assert loaded.actuator("north").displacement == pytest.approx(0.003, abs=1e-11)
    assert body.mass == pytest.approx(0.03) and body.node_masses.sum() == pytest.approx(0.03)


def test_energy_is_the_potential_of_the_forces(loaded):
    body = loaded.body("finger")
    before, forces = body.strain_energy, body.internal_forces()
    start = np.array(body.positions)
    loaded.actuator("east").tension = 3.0001
    loaded.solve_static()
    motion = np.array(body.positions) - start
    middle = 0.5 * (forces + body.internal_forces())
    assert body.strain_energy - before == pytest.approx(np.sum(middle * motion), rel=1e-5)


@pytest.mark.parametrize("tangent", ["exact", "corotated"])
def test_stiffness_against_differences(loaded, tangent):
    scipy_sparse = pytest.importorskip("scipy.sparse")
    body = loaded.body("finger")
    matrix = body.stiffness(tangent=tangent)
    free = ~body.fixed
    assert scipy_sparse.issparse(matrix) and matrix.shape == (3 * free.sum(), 3 * free.sum())
    assert abs(matrix - matrix.T).max() < 1e-9 * abs(matrix).max()
    direction = np.zeros(body.positions.shape)
    direction[free] = np.random.default_rng(2).normal(size=(free.sum(), 3))
    step = 1e-7
    start = np.array(body.positions)
    difference = body.internal_forces(start + step * direction)
    difference = (difference - body.internal_forces(start - step * direction))[free] / (2 * step)
    product = (matrix @ direction[free].ravel()).reshape(-1, 3)
    error = np.linalg.norm(product - difference) / np.linalg.norm(difference)
    assert error < 1e-6 if tangent == "exact" else 1e-6 < error < 0.5


def test_the_projected_stiffness_is_never_below_the_exact_one(loaded):
    pytest.importorskip("scipy.sparse")
    exact, projected = (loaded.body("finger").stiffness(tangent=word).toarray() for word in ("exact", "projected"))
    assert np.linalg.eigvalsh(projected - exact).min() > -1e-9 * np.abs(exact).max()


def test_compliance_against_differences_of_statics(loaded):
    # With all rows commanded in effort, W is d(delta)/d(effort).
    loaded.actuator("north").tension = loaded.actuator("north").tension
    loaded.solve_static()
    linear = loaded.linearise()
    assert linear.negative_pivots == 0 and linear.residual < 1e-8
    assert np.allclose(linear.W, linear.W.T, rtol=1e-9, atol=1e-12)
    assert linear.rows == loaded.rows
    assert loaded.rows[:5] == ["east", "north", "west", "south", "push"]
    assert loaded.rows[5:] == ["tip.x", "tip.y", "tip.z"]
    step = 1e-4
    for row, change in ((0, ("east", "tension")), (4, ("push", "force"))):
        actuator, middle = loaded.actuator(change[0]), getattr(loaded.actuator(change[0]), change[1])
        deltas = []
        for sign in (1, -1):
            setattr(actuator, change[1], middle + sign * step)
            loaded.solve_static()
            deltas.append(loaded.linearise().delta)
        setattr(actuator, change[1], middle)
        loaded.solve_static()
        column = (deltas[0] - deltas[1]) / (2 * step)
        assert linear.W[:, row] == pytest.approx(column, rel=1e-4, abs=1e-9)
    # With rotations held fixed, the compliance is similar but not equal.
    corotated = loaded.compliance(tangent="corotated", geometric_stiffness=False)
    off = np.abs(corotated - linear.W).max() / np.abs(linear.W).max()
    assert 1e-3 < off < 0.5


def test_linearise_of_dynamics_is_stiffer(scene):
    sim = sinew.load(scene, set=["integrator=backward-euler"])
    sim.step(2)
    before = sim.state_hash
    statics, dynamics = sim.compliance(), sim.compliance(statics=False)
    assert sim.state_hash == before
    assert (np.diag(dynamics) < np.diag(statics)).all()


def test_jacobian_against_differences(loaded):
    body = loaded.body("finger")
    first, jacobian = loaded.linearise().delta, body.jacobian()
    start = np.array(body.positions)
    loaded.actuator("push").force = 1e-3
    loaded.solve_static()
    motion = np.array(body.positions) - start
    middle = 0.5 * (jacobian + body.jacobian())
    change = loaded.linearise().delta - first
    assert np.einsum("knc,nc->k", middle, motion) == pytest.approx(change, rel=1e-4, abs=1e-12)


def test_dynamics_of_a_free_fall_of_the_tip(scene):
    sim = sinew.load(scene, set=["integrator=backward-euler", "gravity=1 0 0", "time_step=1ms"])
    body = sim.body("finger")
    sim.step()
    # One step of backward Euler from rest: velocity = displacement / step.
    assert np.allclose(body.velocities, (body.positions - body.rest_positions) / 1e-3, atol=1e-12)
    assert sim.effector("tip").velocity[0] == pytest.approx(1e-3, rel=0.05)
    momentum = 0.5 * np.sum(body.node_masses[:, None] * body.velocities**2)
    assert body.kinetic_energy == pytest.approx(momentum, rel=1e-12)
    assert body.gravity_energy < 0 < body.strain_energy


def column(load, **body):
    side, height, young = 0.01, 0.1, 1e6
    euler = np.pi**2 * young * side**4 / 12 / (4 * height**2)
    return sinew.load({
        "sinew": 1,
        "bodies": {"column": {
            "type": "fem", "element": "hex8",
            "mesh": {"shape": "block", "length": side, "width": side, "height": height, "element_size": 0.005},
            "material": {"model": "neo-hookean", "young_modulus": young, "poisson_ratio": 0.4},
            "fixed": {"set": "z_min"}, **body}},
        "loads": {"weight": {"type": "traction", "body": "column", "surface": {"set": "z_max"},
                             "traction": [0, 0, -load * euler / side**2]}},
        "effectors": {"top": {"body": "column", "point": [side / 2, side / 2, height]}}})


@pytest.mark.parametrize("mass_matrix", ["lumped", "consistent"])
def test_a_column_buckles_without_a_mass_as_with_one(mass_matrix):
    tops = []
    for body in ({}, {"density": 1000.0}):
        sim = column(1.5, mass_matrix=mass_matrix, **body)
        report = sim.solve_static()
        assert report.stable and report.relaxation_steps > 0
        tops.append(sim.effector("top").position)
    # The direction of buckling is arbitrary.
    aside = [np.linalg.norm(top[:2] - 0.005) for top in tops]
    assert aside[0] > 0.05 and aside[0] == pytest.approx(aside[1], rel=1e-6)
