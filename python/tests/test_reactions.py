"""Reactions balance the loads of a body, whatever acts on its fixed nodes."""

import numpy as np
import pytest

import sinew

GRAVITY = np.array([0.0, 0.0, -9.81])
SILICONE = {"model": "neo-hookean", "shear_modulus": "60 kPa", "poisson_ratio": 0.45}


def block(**more):
    mesh = {"shape": "block", "length": "60 mm", "width": "20 mm", "height": "20 mm", "element_size": "10 mm"}
    return {"type": "fem", "mesh": mesh, "material": SILICONE, "density": "1000 kg/m^3", **more}


def unbalanced(sim, names):
    """Sum of the reactions and weights of some bodies, relative to the weights."""
    weight = len(names) * 1000.0 * 0.06 * 0.02 * 0.02 * GRAVITY
    reactions = sum(sim.body(name).reactions.sum(axis=0) for name in names)
    return np.linalg.norm(reactions + weight) / np.linalg.norm(weight)


@pytest.mark.parametrize("side", ["z_max", "y_min"])
def test_with_a_membrane_that_reaches_the_fixed_nodes(side):
    sim = sinew.load({
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2",
        "bodies": {"beam": block(fixed={"set": "x_min"})},
        "membranes": {"skin": {"body": "beam", "surface": {"set": side}, "thickness": "0.1 mm",
                               "young_modulus": "10 MPa"}},
    })
    sim.step()
    assert sim.report.status == "solved"
    assert unbalanced(sim, ["beam"]) < 1e-4


# The lower block is fixed below and at one end, so that the upper one, which hangs from the other
# end, presses on fixed nodes, too.
def test_with_contact_on_the_fixed_nodes():
    sim = sinew.load({
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2",
        "bodies": {
            "lower": block(fixed=[{"set": "z_min"}, {"set": "x_min"}]),
            "upper": block(fixed={"set": "x_max"}, pose={"position": "0 0 20.01 mm"}),
        },
        "contacts": {"touch": {"between": ["upper", "lower"]}},
    })
    for _ in range(3):
        sim.step()
    assert sim.report.status == "solved"
    contact = sim.contact("touch")
    pressed = np.asarray(contact.normal_forces) > 0.0
    assert np.any(np.asarray(contact.positions)[pressed, 0] < 1e-3), "no fixed node is pressed"
    assert unbalanced(sim, ["lower", "upper"]) < 1e-4
