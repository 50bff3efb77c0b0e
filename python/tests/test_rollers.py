"""Bodies with nodes that are fixed along some axes only, and rubber under homogeneous strain."""

import numpy as np
import pytest
import scipy.optimize
import sinew

SIDE = 0.02  # m
SHEAR, BULK = 2e4, 2e5  # Pa


def cube(element, material, **scene):
    """A cube on three rollers: the faces through the origin stay in their planes."""
    return {
        "sinew": 1, "gravity": [0, 0, 0], **scene,
        "bodies": {"cube": {
            "type": "fem", "element": element, "material": material, "density": 1000.0,
            "mesh": {"shape": "block", "length": SIDE, "width": SIDE, "height": SIDE,
                     "element_size": SIDE / 2},
            "fixed": [{"set": "x_min", "axes": "x"}, {"set": "y_min", "axes": ["y"]},
                      {"set": "z_min", "axes": "z"}]}},
    }


def pull(sim, force):
    """Applies a uniform stress to the face x = SIDE, with consistent nodal forces of bilinear shape functions."""
    body = sim.body("cube")
    rest = np.array(body.rest_positions)
    end = np.flatnonzero(rest[:, 0] > SIDE - 1e-9)
    inside = np.isclose(rest[end, 1:], SIDE / 2)
    shares = np.prod(1.0 + inside, axis=1)
    body.external_forces[end, 0] = force * shares / shares.sum()
    return body, rest


def neo_hookean_stretches(stress):
    """(l1, l2) of a compressible neo-Hookean bar at a nominal stress, from its energy's derivatives."""
    def gaps(l):
        l1, l2 = l
        j = l1 * l2**2
        i1 = l1**2 + 2 * l2**2
        kirchhoff = [SHEAR * j ** (-2 / 3) * (x**2 - i1 / 3) + BULK * (j - 1) * j for x in (l1, l2)]
        return [kirchhoff[0] / l1 - stress, kirchhoff[1]]
    return scipy.optimize.fsolve(gaps, (1.2, 0.9), xtol=1e-13)


def test_a_rubber_cube_is_stretched_as_in_closed_form():
    law = {"model": "neo-hookean", "shear_modulus": SHEAR, "bulk_modulus": BULK}
    sim = sinew.load(cube("hex8", law))
    body, rest = pull(sim, 8.0)
    sim.solve_static(tolerance=1e-12)
    l1, l2 = neo_hookean_stretches(8.0 / SIDE**2)
    assert l1 > 1.2
    np.testing.assert_allclose(body.positions, rest * [l1, l2, l2], atol=1e-10)


@pytest.mark.parametrize("element", ["tet4", "hex8"])
def test_what_is_held_does_not_move_in_dynamics(element):
    law = {"model": "saint-venant-kirchhoff", "young_modulus": 1e5, "poisson_ratio": 0.3}
    sim = sinew.load(cube(element, law, integrator="backward-euler", time_step=1e-3))
    body, rest = pull(sim, 2.0)
    sim.step(30)
    moved = np.array(body.positions) - rest
    for axis in range(3):
        assert np.all(moved[rest[:, axis] == 0.0, axis] == 0.0)
        assert np.abs(moved[rest[:, axis] > 0.0, axis]).min() > 1e-6


def test_cables_see_what_is_held():
    scene = cube("tet4", {"young_modulus": 1e5, "poisson_ratio": 0.3})
    scene["actuators"] = {"pull": {"type": "force", "body": "cube", "direction": [1, 0, 0],
                                   "point": [0.0, SIDE / 2, SIDE / 2]}}
    sim = sinew.load(scene)
    sim.actuator("pull").force = 5.0  # on a face that cannot move in this direction
    sim.solve_static()
    body = sim.body("cube")
    assert np.abs(np.array(body.positions) - body.rest_positions).max() < 1e-12
    assert np.abs(sim.compliance()).max() < 1e-12


def test_what_leaves_a_body_free_to_move_holds_it_not():
    scene = cube("hex8", {"model": "neo-hookean", "young_modulus": 2e5, "poisson_ratio": 0.3})
    scene["bodies"]["cube"]["fixed"].pop()
    with pytest.raises(sinew.Error, match="what is fixed leaves it free to move") as caught:
        sinew.load(scene)
    assert caught.value.kind == "nothing-fixed" and caught.value.place.item.startswith("bodies.cube")
    sinew.load({**scene, "integrator": "backward-euler"}).step()  # with inertia, no support is needed
