"""Probes: their values, and that they do not affect the robot."""

import numpy as np
import pytest
import sinew

SIDE = 0.01


def beam(**probes):
    return sinew.load({
        "sinew": 1,
        "bodies": {"beam": {
            "type": "fem", "material": {"young_modulus": 2e5, "poisson_ratio": 0.3}, "density": 1000.0,
            "mesh": {"shape": "block", "length": 6 * SIDE, "width": SIDE, "height": SIDE, "element_size": SIDE / 2},
            "fixed": [{"set": "x_min"}]}},
        "actuators": {"push": {"type": "force", "body": "beam", "point": [6 * SIDE, SIDE / 2, SIDE / 2],
                               "direction": [0, 0, 1], "command": {"force": 0.02}}},
        "effectors": {"tip": {"body": "beam", "point": [6 * SIDE, SIDE / 2, SIDE / 2]}},
        "probes": probes})


PROBES = {
    "end": {"body": "beam", "set": "x_max"},
    "axis": {"body": "beam", "line": [[0, SIDE / 2, SIDE / 2], [6 * SIDE, SIDE / 2, SIDE / 2]], "samples": 7},
    "bend": {"body": "beam", "bend": [{"set": "x_min"}, {"set": "x_max"}], "about": "y"},
    "rise": {"body": "beam", "extent": {"along": "z"}},
    "reach": {"body": "beam", "distance": [[0, 0, 0], [6 * SIDE, 0, 0]]},
}


def test_probes_measure_the_present_shape():
    sim = beam(**PROBES)
    assert list(sim.probes) == list(PROBES)
    assert sim.probes["axis"].value == pytest.approx(6 * SIDE, rel=1e-12)
    assert sim.probe("bend").value == pytest.approx(0, abs=1e-9)
    sim.solve_static()
    x = np.array(sim.body("beam").positions)
    ends = [np.array(sim.body("beam").node_sets[name]) for name in ("x_min", "x_max")]
    assert sim.probe("end").value == pytest.approx(x[ends[1]].mean(axis=0), abs=1e-15)
    assert sim.probe("rise").value == pytest.approx(np.ptp(x[:, 2]), abs=1e-15)
    axis = sim.probe("axis").positions
    assert axis.shape == (7, 3)
    assert axis[-1] == pytest.approx(sim.effector("tip").position, abs=1e-15)
    assert sim.probe("axis").value == pytest.approx(np.linalg.norm(np.diff(axis, axis=0), axis=1).sum(), abs=1e-15)
    # Best-fit plane of the end by NumPy: the same normal, except for the warping of the end.
    spread = x[ends[1]] - x[ends[1]].mean(axis=0)
    normal = np.linalg.svd(spread)[2][2]
    bend = sim.probe("bend").value
    assert abs(bend) > 0.05 and bend < 0  # bending upwards is negative about y by the right-hand rule
    assert abs(bend) == pytest.approx(np.arccos(abs(normal[0])), rel=0.02)
    assert (sim.probe("bend").kind, sim.probe("bend").unit, sim.probe("reach").unit) == ("bend", "rad", "m")


def test_a_run_returns_them_and_is_the_same_without():
    sim, bare = beam(**PROBES), beam()
    out, plain = sim.run(0.03), bare.run(0.03)
    assert out["tip.position"].tobytes() == plain["tip.position"].tobytes()
    assert out["bend.value"].shape == (4,)
    assert out["end.value"].shape == (4, 3)
    assert out["axis.positions"].shape == (4, 7, 3)
    assert out["axis.value"][-1] == sim.probe("axis").value
    assert "bend.value" not in plain


def test_an_unknown_probe_is_suggested():
    with pytest.raises(sinew.Error, match="did you mean 'bend'"):
        beam(**PROBES).probe("bent")
