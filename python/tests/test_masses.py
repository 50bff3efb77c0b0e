"""Point masses on bodies, and bodies with an initial velocity."""

import numpy as np
import pytest
import sinew

BEAM = {"type": "fem", "density": 1000.0, "material": {"young_modulus": 200e3, "poisson_ratio": 0.3},
        "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02}}


def hung(masses, fixed=True, body=None, **world):
    beam = {**BEAM, **(body or {})}
    if fixed:
        beam["fixed"] = [{"set": "x_min"}]
    return sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "bodies": {"beam": beam}, "masses": masses, **world})


def test_a_mass_sags_as_its_weight():
    weight = {"hung": {"body": "beam", "point": "95 10 10 mm", "mass": "20 g"}}
    sim = hung(weight)
    sim.solve_static()
    mass = sim.masses["hung"]
    assert (mass.name, mass.body, mass.mass) == ("hung", "beam", 0.02)
    force = {"f": {"type": "force", "body": "beam", "point": "95 10 10 mm", "force": [0, 0, -0.02 * 9.81]}}
    pulled = hung({}, loads=force)
    pulled.solve_static()
    assert np.allclose(sim.body("beam").positions, pulled.body("beam").positions, rtol=0, atol=1e-9)
    assert mass.position[2] < 0.01 - 1e-3
    assert np.array(sim.body("beam").reactions).sum(axis=0)[2] == pytest.approx((0.02 + 0.04) * 9.81, rel=1e-6)
    # An acceleration load acts on the mass, too.
    shaken = hung(weight, gravity=[0, 0, 0], loads={"a": {"type": "acceleration", "body": "beam", "acceleration": [0, 0, -9.81]}})
    shaken.solve_static()
    assert np.allclose(shaken.body("beam").positions, sim.body("beam").positions, rtol=0, atol=1e-9)


def test_a_throw():
    sim = hung({"nose": {"body": "beam", "point": "100 10 10 mm", "mass": "40 g"}}, fixed=False, time_step="1 ms",
               integrator="bdf2", body={"velocity": {"linear": "1 0 2 m/s", "angular": "0 3 0 rad/s"}})
    start = sim.state_hash
    nose = sim.mass("nose")
    # Centre of mass: 40 g of the beam at 50 mm and 40 g of the nose at 100 mm give 75 mm.
    assert nose.velocity == pytest.approx([1, 0, 2 - 3 * 0.025])
    clone = sim.clone()
    sim.step(50)
    clone.step(50)
    assert sim.state_hash == clone.state_hash
    t, v = sim.time, np.array(sim.body("beam").velocities)
    momentum = v.T @ sim.body("beam").node_masses + 0.04 * nose.velocity
    assert momentum == pytest.approx([0.08, 0, 0.08 * (2 - 9.81 * t)], rel=1e-6, abs=1e-9)
    sim.reset()
    assert sim.state_hash == start


def test_wrong_masses_are_refused():
    with pytest.raises(sinew.Error) as caught:
        hung({"far": {"body": "beam", "point": "1 0 0 m", "mass": "1 g"}})
    assert caught.value.kind == "point-outside-mesh"
    with pytest.raises(sinew.Error) as caught:
        hung({}).mass("far")
    assert caught.value.kind == "unknown-name"
