"""States and inputs as values, from which a run continues."""

import copy
import pickle

import numpy as np
import pytest

import sinew

SCENE = {
    "sinew": 1,
    "integrator": "bdf2",
    "bodies": {
        "beam": {
            "type": "fem",
            "mesh": {
                "shape": "block",
                "length": "60 mm",
                "width": "20 mm",
                "height": "10 mm",
                "element_size": "10 mm",
            },
            "material": {"young_modulus": "150 kPa", "poisson_ratio": 0.3},
            "density": "1000 kg/m^3",
            "fixed": {"set": "x_min"},
        }
    },
    "actuators": {
        "up": {"type": "cable", "body": "beam", "points": [[0.004, 0.01, 0.008], [0.056, 0.01, 0.008]]},
        "down": {"type": "cable", "body": "beam", "points": [[0.004, 0.01, 0.002], [0.056, 0.01, 0.002]]},
    },
    "effectors": {"tip": {"body": "beam", "point": "60 10 5 mm", "directions": ["z"]}},
}

CONTACT = {
    "contacts": {
        "floor": {
            "body": "beam",
            "surface": {"sphere": {"centre": "60 10 -15 mm", "radius": "14.9 mm"}},
            "nodes": {"set": "x_max"},
            "friction": 0.5,
        }
    },
    "gravity": "0 0 -9.81 m/s^2",
}


def test_a_state_is_a_value():
    sim = sinew.load(SCENE)
    start = sim.state()
    sim.actuator("up").tension = 0.2
    sim.step(3)
    later = sim.state()
    assert later.steps == 3 and start.steps == 0
    assert later != start and later != 3
    assert copy.deepcopy(later) == later and hash(copy.copy(later)) == hash(later)
    assert pickle.loads(pickle.dumps(later)) == later
    sim.step(4)
    there = sim.state()
    sim.restore(later)
    assert sim.state() == later and sim.steps == 3
    sim.step(4)
    assert sim.state() == there


def test_a_state_of_another_robot_is_refused_by_what_differs():
    sim = sinew.load(SCENE)
    for change, part in [
        ({"integrator": "backward-euler"}, "integrator"),
        ({"time_step": "5 ms"}, "time step"),
    ]:
        other = sinew.load({**SCENE, **change})
        with pytest.raises(sinew.Error, match=f"differs in: {part}") as error:
            other.restore(sim.state())
        assert error.value.kind == "state-mismatch"
    shorter = copy.deepcopy(SCENE)
    shorter["actuators"]["down"]["points"][1][0] = 0.05
    with pytest.raises(sinew.Error, match="differs in: actuator 'down'"):
        sinew.load(shorter).restore(sim.state())
    assert sim.steps == 0


def test_a_tolerance_may_differ():
    sim = sinew.load(SCENE)
    sim.step(2)
    finer = sinew.load({**SCENE, "solver": {"tolerance": 1e-10}})
    finer.restore(sim.state())
    finer.step()
    assert finer.steps == 3


def test_a_controller_takes_up_its_memory():
    scene = copy.deepcopy(SCENE)
    scene["integrator"] = "quasi-static"
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": [0.06, 0.01, 0.009]})
    for _ in range(5):
        ik.step()
    half = sim.state()
    for _ in range(5):
        ik.step()
    there, status = sim.state(), ik.status
    sim.restore(half)
    for _ in range(5):
        ik.step()
    assert sim.state() == there and ik.status == status
    clone = sinew.load(scene)
    clone.restore(half)  # without a controller, the controller's memory is ignored
    assert clone.steps == 5


def test_a_copy_has_forces_of_contacts():
    sim = sinew.load({**SCENE, **CONTACT})
    sim.step(20)
    force = sim.contact("floor").force
    assert np.linalg.norm(force) > 1e-3
    np.testing.assert_array_equal(sim.clone().contact("floor").force, force)
    other = sinew.load({**SCENE, **CONTACT})
    other.restore(sim.state())
    np.testing.assert_array_equal(other.contact("floor").force, force)


def test_looking_at_the_linearisation_moves_nothing():
    sim = sinew.load({**SCENE, **CONTACT})
    sim.step(5)
    sim.body("beam").move_base(translation=[0.0, 0.0, 0.01])
    before, force = sim.state(), sim.contact("floor").force
    sim.linearise()
    assert sim.state() == before
    np.testing.assert_array_equal(sim.contact("floor").force, force)
    names = sim.rows
    assert len(set(names)) == len(names) and "floor point 0 normal" in names


def test_the_size_does_not_depend_on_the_order_of_bodies():
    def first_move(bodies):
        scene = copy.deepcopy(SCENE)
        scene["integrator"] = "quasi-static"
        arm = {
            "type": "pcc",
            "segments": [{"length": "30 mm", "mass": "5 g", "stiffness": "0.01 N m"}],
        }
        both = {"beam": scene["bodies"]["beam"], "arm": arm}
        scene["bodies"] = {name: both[name] for name in bodies}
        sim = sinew.load(scene)
        ik = sinew.InverseController(sim, targets={"tip": [0.06, 0.01, 0.03]}, actuators=["up"])
        ik.step()
        return sim.effector("tip").position

    np.testing.assert_allclose(first_move(["beam", "arm"]), first_move(["arm", "beam"]), atol=1e-12)
    np.testing.assert_allclose(first_move(["beam"]), first_move(["arm", "beam"]), atol=1e-12)
