"""Moving bases."""

import numpy as np
import pytest
import sinew


def beam(base=None, element="hex8", **world):
    body = {"type": "fem", "element": element, "density": 1000.0, "fixed": [{"set": "x_min"}],
            "material": {"model": "neo-hookean", "shear_modulus": 3e4, "poisson_ratio": 0.4},
            "mesh": {"shape": "block", "length": 0.06, "width": 0.01, "height": 0.01, "element_size": 0.005},
            "damping": {"stiffness": 0.02}}
    if base is not None:
        body["motion"] = base
    return sinew.load({"sinew": 1, "solver": {"ordering": "amd", "method": "newton"}, "bodies": {"beam": body},
                       "effectors": {"tip": {"body": "beam", "point": [0.06, 0.005, 0.005]}}, **world})


def test_a_body_follows_its_base_without_strain():
    turn = np.pi / 2
    sim = beam({"x": {"ramp": {"to": "20 mm", "duration": "0.3 s"}}, "angle": {"ramp": {"to": turn, "duration": "0.3 s"}},
                "axis": "0 1 0", "centre": "0 5 5 mm"})
    sim.step(40)
    body = sim.body("beam")
    rest, centre = np.array(body.rest_positions), np.array([0, 0.005, 0.005])
    rotation = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    expected = (rest - centre) @ rotation.T + centre + [0.02, 0, 0]
    assert np.array(body.positions) == pytest.approx(expected, abs=1e-9)
    assert body.strain_energy < 1e-12


def test_an_accelerated_base_is_a_gravity():
    """A constant acceleration of the base bends the beam as gravity in the opposite direction does."""
    a, step = 4.0, 1e-3
    sim = beam(integrator="backward-euler", time_step=step)
    for k in range(1, 1501):
        sim.body("beam").move_base([0, 0, a * (k * step) ** 2 / 2])
        sim.step()
    base = np.array(sim.body("beam").positions)[np.array(sim.body("beam").fixed)][:, 2].mean() - 0.005
    lag = sim.effector("tip").position[2] - base - 0.005
    still = beam(gravity=[0, 0, -a])
    still.solve_static()
    # The beam still vibrates slightly, and backward Euler follows the parabola of the base to first order only.
    assert lag == pytest.approx(still.effector("tip").position[2] - 0.005, rel=0.02)


def test_statics_take_the_base_along():
    sim = beam()
    sim.body("beam").move_base([0.01, 0, 0], [0, 0, 0.1])
    sim.solve_static()
    assert sim.body("beam").strain_energy < 1e-12
    assert sim.effector("tip").position[0] > 0.065


def test_bad_bases_are_refused():
    with pytest.raises(sinew.Error) as caught:
        beam().body("beam").move_base([np.nan, 0, 0])
    assert caught.value.kind == "not-finite"
    with pytest.raises(sinew.Error) as caught:
        beam().body("beam").move_base([1, 2])
    assert caught.value.kind == "wrong-shape"
    with pytest.raises(sinew.Error) as caught:
        beam({"x": "10 s"})
    assert caught.value.kind == "wrong-dimension"
    with pytest.raises(sinew.Error) as caught:
        beam({"axis": "0 0 0"})
    assert caught.value.kind == "out-of-range"


def test_a_base_of_the_scene_is_not_moved_by_hand():
    sim = beam({"x": "1 mm"})
    with pytest.raises(sinew.Error) as caught:
        sim.body("beam").move_base([0.01, 0, 0])
    assert caught.value.kind == "bad-argument"
    assert "the scene moves this base" in str(caught.value)


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
def test_states_and_clones_go_on_bit_for_bit(integrator, tmp_path):
    def move(sim, k):
        sim.body("beam").move_base([1e-4 * k, 0, 0], [0, 0.01 * k, 0])

    sim, fresh = beam(integrator=integrator), beam(integrator=integrator)
    start = sim.state_hash
    for k in range(1, 6):
        move(sim, k)
        sim.step()
    move(sim, 7)  # requested, not yet applied
    sim.save_state(tmp_path / "beam.state")
    fresh.load_state(tmp_path / "beam.state")
    move(fresh, 7)
    twin = sim.clone()
    for k in range(8, 12):
        for each in (sim, fresh, twin):
            each.step()
            move(each, k)
        assert fresh.state_hash == sim.state_hash
        assert twin.state_hash == sim.state_hash
    sim.reset()
    assert sim.state_hash == start
    sim.step()
    assert np.allclose(sim.body("beam").positions, sim.body("beam").rest_positions, rtol=0, atol=1e-12)


def test_a_restored_query_leaves_the_base_where_it_is():
    """After restore(), the motion that a base was last asked for belongs to a later time."""
    sim = beam({"z": {"sine": {"amplitude": "5 mm", "period": "0.2 s"}}, "angle": {"ramp": {"to": "20 deg", "duration": "0.1 s"}}, "axis": "0 1 0"},
               integrator="bdf2", time_step="5 ms", gravity=[0, 0, -9.81])  # fmt: skip
    sim.step(4)
    state = sim.state()
    before, tip = sim.linearise(), sim.effector("tip").position.copy()
    sim.step(3)
    sim.restore(state)
    after = sim.linearise()
    assert (after.W == before.W).all() and (after.delta == before.delta).all()
    assert (sim.effector("tip").position == tip).all() and sim.state() == state
