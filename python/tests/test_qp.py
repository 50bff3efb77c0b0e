"""Contact problems in Python."""

import numpy as np
import pytest
import sinew


def natural_map(W, q, friction, r):
    """|r - P_K(r - v)|/|q|, with the projection P_K as the nearest point of the cone."""
    u = W @ r + q
    missed = 0.0
    for k, mu in enumerate(friction):
        own, motion = r[3 * k : 3 * k + 3], u[3 * k : 3 * k + 3]
        z = own - motion
        z[0] -= mu * np.hypot(*motion[1:])
        across = np.hypot(*z[1:])
        if across > mu * z[0]:
            ray = np.array([1.0, *(mu * z[1:] / max(across, 1e-300))])
            z = max(0.0, z @ ray) / (ray @ ray) * ray
        missed += np.sum((own - z) ** 2)
    return np.sqrt(missed) / np.linalg.norm(q)


def contacts(count, coordinates, seed):
    random = np.random.default_rng(seed)
    J = random.normal(size=(3 * count, coordinates))
    return J @ J.T, J @ random.normal(size=coordinates), np.full(count, 0.5)


def test_one_contact_slides():
    solution = sinew.qp.solve_cones(np.diag([2.0, 1.0, 1.0]), [-1.0, 1.0, 0.0], [0.5])
    assert solution.status == "solved"
    assert solution.states == ["slip"]
    assert solution.x == pytest.approx([0.5, -0.25, 0.0], abs=1e-12)


@pytest.mark.parametrize("coordinates", [70, 30])
def test_dense_and_sparse(coordinates):
    sparse = pytest.importorskip("scipy.sparse")
    W, q, friction = contacts(20, coordinates, 4)
    dense = sinew.qp.solve_cones(W, q, friction)
    other = sinew.qp.solve_cones(sparse.csr_matrix(W), q, friction, 1e-8)
    for solution in dense, other:
        assert solution.status == "solved"
        assert solution.residual <= 1e-8
        assert natural_map(W, q, friction, solution.x) == pytest.approx(solution.residual, abs=1e-12)
    assert np.abs(W @ (dense.x - other.x)).max() < 1e-6 * np.abs(q).max()
    again = sinew.qp.solve_cones(W, q, friction, start=dense.x)
    assert again.iterations <= dense.iterations


def test_the_symmetric_part_is_used():
    W, q, friction = contacts(5, 20, 5)
    skew = np.zeros_like(W)
    skew[0, 1] = 1e-3 * np.abs(W).max()
    solution = sinew.qp.solve_cones(W + skew, q, friction)
    assert solution.asymmetry == pytest.approx(1e-3, rel=0.1)
    assert natural_map(W + 0.5 * (skew + skew.T), q, friction, solution.x) <= 1e-8


def test_what_is_wrong():
    W, q, friction = contacts(2, 9, 6)
    with pytest.raises(sinew.Error) as raised:
        sinew.qp.solve_cones(W, q[:5], friction)
    assert raised.value.kind == "wrong-shape"
    with pytest.raises(sinew.Error) as raised:
        sinew.qp.solve_cones(W, q, [0.5, -0.1])
    assert raised.value.kind == "out-of-range"
    assert sinew.qp.solve_cones(-W, q, friction).status == "not-convex"
