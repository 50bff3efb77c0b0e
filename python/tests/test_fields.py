"""Stresses, strains and reactions."""

import numpy as np
import pytest
import sinew
from sinew import fields

SIDE = 0.02


def cube(element, material, **more):
    return sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.81], **more,
        "bodies": {"cube": {
            "type": "fem", "element": element, "material": material, "density": 1000.0,
            "mesh": {"shape": "block", "length": SIDE, "width": SIDE, "height": SIDE, "element_size": SIDE / 2},
            "fixed": [{"set": "x_min", "axes": "x"}, {"set": "y_min", "axes": "y"}, {"set": "z_min", "axes": "z"}]}},
        "effectors": {"corner": {"body": "cube", "point": [SIDE, SIDE, SIDE]}}})


RUBBER = {"model": "neo-hookean", "shear_modulus": 3e4, "bulk_modulus": 3e5}
STIFF = {"young_modulus": 1e5, "poisson_ratio": 0.3}


@pytest.mark.parametrize("element,material", [
    ("tet4", STIFF), ("tet4", RUBBER), ("tet10", RUBBER), ("hex8", RUBBER)])
def test_uniaxial_tension(element, material):
    sim = cube(element, material, gravity=[0, 0, 0])
    body = sim.body("cube")
    rest = np.array(body.rest_positions)
    top = np.flatnonzero(rest[:, 2] > SIDE - 1e-9)
    # Uniform traction on the top face, with consistent nodal forces; the body has no mass.
    pull = np.zeros_like(rest)
    for face, weights in faces(body, element):
        pull[face, 2] += weights
    pull *= 0.4 / pull[:, 2].sum()
    assert set(np.flatnonzero(pull[:, 2])) <= set(top)
    body.external_forces[:] = pull
    sim.solve_static()
    stretch = fields.principal_stretches(body.deformation_gradients)
    assert stretch == pytest.approx(np.broadcast_to(stretch[0], stretch.shape), rel=1e-7)
    piola, cauchy = np.array(body.piola_stresses), np.array(body.cauchy_stresses)
    assert piola[:, 2, 2] == pytest.approx(0.4 / SIDE**2, rel=1e-7)
    assert np.abs(piola[:, 0]).max() < 1e-4 * piola[0, 2, 2]
    area = stretch[0, 1] * stretch[0, 2]
    assert fields.von_mises(cauchy) == pytest.approx(0.4 / SIDE**2 / area, rel=1e-6)
    assert fields.principal_values(cauchy)[:, 0] == pytest.approx(cauchy[:, 2, 2], rel=1e-6)
    assert fields.log_strain(body.deformation_gradients)[:, 2, 2] == pytest.approx(np.log(stretch[:, 0]), rel=1e-6)
    assert fields.green_strain(body.deformation_gradients)[:, 2, 2] == pytest.approx(
        (stretch[:, 0] ** 2 - 1) / 2, rel=1e-6)
    nodes = fields.to_nodes(body, cauchy)
    assert nodes.shape == (len(rest), 3, 3)
    assert nodes[:, 2, 2] == pytest.approx(cauchy[0, 2, 2], rel=1e-6)
    reactions = np.array(body.reactions)
    assert reactions.sum(axis=0) == pytest.approx([0, 0, -0.4], abs=1e-6)
    assert np.all(reactions[rest[:, 2] > 1e-9, 2] == 0)


def faces(body, element):
    """Nodes of each face on top, with their fractions of a uniform traction."""
    rest = np.array(body.rest_positions)
    up = rest[:, 2] > SIDE - 1e-9
    if element == "hex8":
        for h in body.hexahedra:
            nodes = h[up[h]]
            if len(nodes) == 4:
                yield nodes, 0.25
        return
    tets = body.quadratic_tetrahedra if element == "tet10" else body.tetrahedra
    for t in tets:
        corners, middles = t[:4][up[t[:4]]], t[4:][up[t[4:]]]
        if len(corners) == 3:
            a, b, c = rest[corners]
            area = 0.5 * np.linalg.norm(np.cross(b - a, c - a))
            yield (middles if element == "tet10" else corners), area / 3


@pytest.mark.parametrize("element", ["tet4", "tet10", "hex8"])
def test_supports_bear_the_weight_and_the_actuators(element):
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.81],
        "bodies": {"beam": {"type": "fem", "element": element, "material": RUBBER, "density": 1000.0,
                            "mesh": {"shape": "block", "length": 0.04, "width": 0.01, "height": 0.01},
                            "fixed": [{"set": "x_min"}]}},
        "actuators": {"push": {"type": "force", "body": "beam", "point": [0.04, 0.005, 0.005],
                               "direction": [0, 1, 0], "command": {"force": 0.02}}},
        "effectors": {"tip": {"body": "beam", "point": [0.04, 0.005, 0.005]}}})
    sim.solve_static()
    body = sim.body("beam")
    reactions = np.array(body.reactions)
    weight = 1000.0 * 0.04 * 0.01**2 * 9.81
    assert reactions.sum(axis=0) == pytest.approx([0, -0.02, weight], abs=1e-7)
    assert np.abs(reactions[~np.array(body.fixed)]).max() == 0


@pytest.mark.parametrize("element,material", [
    ("tet4", STIFF), ("tet4", RUBBER), ("tet10", RUBBER), ("hex8", RUBBER)])
def test_scalar_fields_are_those_of_the_tensors(element, material):
    sim = cube(element, material)
    sim.body("cube").external_forces[:, 2] = -0.002
    sim.solve_static()
    body = sim.body("cube")
    assert set(fields.FIELDS) >= {"von_mises_stress", "max_stretch", "pressure", "energy_density"}
    volumes = np.array(body.element_volumes)
    assert (body.element_field("energy_density") * volumes).sum() == pytest.approx(body.strain_energy, rel=1e-10)
    # The pressure is linear in the stress, so its mean is the pressure of the mean stress.
    pressure = -np.trace(body.cauchy_stresses, axis1=1, axis2=2) / 3
    assert body.element_field("pressure") == pytest.approx(pressure, rel=1e-9)
    if element == "tet4":  # one integration point per element
        assert body.element_field("von_mises_stress") == pytest.approx(fields.von_mises(body.cauchy_stresses), rel=1e-9)
        stretches = fields.principal_stretches(body.deformation_gradients)
        assert body.element_field("max_stretch") == pytest.approx(stretches[:, 0], rel=1e-12)
        assert body.element_field("log_strain") == pytest.approx(np.log(stretches[:, 0]), rel=1e-6)
    nodal = body.nodal_field("von_mises_stress")
    assert nodal == pytest.approx(fields.to_nodes(body, body.element_field("von_mises_stress")), rel=1e-14)
    assert np.ptp(nodal) > 0


def test_unknown_fields_and_wrong_shapes_are_refused():
    body = cube("tet4", STIFF).body("cube")
    with pytest.raises(sinew.Error, match="von_mises_stress"):
        body.nodal_field("von_mises")
    with pytest.raises(sinew.Error, match="elements"):
        fields.to_nodes(body, np.zeros(3))
