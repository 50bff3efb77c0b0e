"""Contact force tasks and priorities of controllers."""

import copy

import numpy as np
import pytest
import sinew
import yaml

WALL = {"body": "finger", "friction": 0.4, "surface": {"plane": {"point": "12 0 0 mm", "normal": "-1 0 0"}}}


@pytest.fixture
def beside_a_wall(scene):
    """Scene of the finger with a wall 2 mm beside it, as a dict."""
    tree = yaml.safe_load(scene.read_text())
    tree["contacts"] = {"wall": dict(WALL)}
    return tree


def steer(tree, steps=60, **asked):
    sim = sinew.load(tree)
    ik = sinew.InverseController(sim, **asked)
    ik.step(steps)
    return sim, ik


@pytest.mark.parametrize("friction", [0.0, 0.4])
@pytest.mark.parametrize(
    "asked, least, most",
    [(0.3, 0.3, 0.3), ({"min": 0.2, "max": 0.25}, 0.2, 0.25), ({"min": 0.4}, 0.4, 5.0), ({"max": 0.1}, 0.1, 0.1)],
)
def test_a_normal_force_is_as_asked(beside_a_wall, friction, asked, least, most):
    beside_a_wall["contacts"]["wall"]["friction"] = friction
    # The target alone would lead to another contact force.
    target = {"tip": [0.0 if asked == {"min": 0.4} else 0.0035, 0.0, 0.079]}
    sim, ik = steer(beside_a_wall, targets=target, contacts={"wall": {"normal_force": asked}})
    found = sim.contact("wall").normal_force
    assert least - 1e-5 <= found <= most + 1e-5
    assert ik.force_errors["wall"] == pytest.approx(0.0, abs=1e-5)
    # The same tensions without a controller give the same force.
    efforts = dict(zip(ik.actuators, ik.efforts))
    ik.detach()
    for name, effort in efforts.items():
        if name == "push":
            sim.actuator(name).force = effort
        else:
            sim.actuator(name).tension = effort
    sim.step(10)
    assert sim.contact("wall").normal_force == pytest.approx(found, abs=1e-6)


@pytest.mark.parametrize("x, least, most", [(0.0035, 0.5, 50.0), (0.0, 0.0, 0.0)])
def test_without_a_task_the_force_is_another(beside_a_wall, x, least, most):
    sim, _ = steer(beside_a_wall, targets={"tip": [x, 0.0, 0.079]})
    assert least <= sim.contact("wall").normal_force <= most


def test_a_force_is_asked_without_targets(beside_a_wall):
    sim, ik = steer(beside_a_wall, contacts={"wall": {"normal_force": 0.2}})
    assert sim.contact("wall").normal_force == pytest.approx(0.2, abs=1e-5)
    assert ik.status == "on-target"


def worst_share(tree, reserve):
    """Largest |F_t| / (mu F_n) while the target moves along the wall with a normal force of 0.3 N."""
    sim = sinew.load(tree)
    contacts = {"wall": {"normal_force": {"min": 0.3}}}
    if reserve is not None:
        contacts["wall"]["reserve"] = reserve
    ik = sinew.InverseController(sim, targets={"tip": [0.003, 0.0, 0.079]}, contacts=contacts)
    ik.step(40)
    worst = 0.0
    for step in range(40):
        ik.targets["tip"] = [0.003, 0.0001 * step, 0.079]
        ik.step()
        contact = sim.contact("wall")
        worst = max(worst, np.linalg.norm(contact.force[1:]) / (0.4 * contact.normal_force))
    return worst


def test_a_reserve_keeps_the_resultant_inside_its_cone(beside_a_wall):
    assert worst_share(beside_a_wall, None) > 0.95
    for reserve in (0.1, 0.3, 0.6):
        # The corners of the octagon lie on the requested cone, its sides 8 % inside.
        assert 0.5 * (1 - reserve) < worst_share(beside_a_wall, reserve) < (1 - reserve) * (1 + 1e-3)


def test_scene_and_python_ask_the_same(beside_a_wall):
    asked = {"normal_force": {"min": 0.2, "max": 0.3}, "slip": False, "reserve": 0.2}
    _, from_python = steer(beside_a_wall, targets={"tip": [0.003, 0.001, 0.079]}, contacts={"wall": asked})
    tree = copy.deepcopy(beside_a_wall)
    tree["controllers"] = {
        "hold": {
            "type": "inverse",
            "effectors": {"tip": {"target": "3 1 79 mm", "priority": 1}},
            "contacts": {"wall": {"normal_force": {"min": "200 mN", "max": "0.3 N"}, "slip": False, "reserve": 0.2}},
        }
    }
    sim = sinew.load(tree)
    sim.step(60)
    assert np.array_equal(sim.controller.efforts, from_python.efforts)
    assert sim.controller.force_errors.keys() == {"wall"}


def test_states_clones_and_threads_give_the_same_bits(beside_a_wall):
    asked = dict(targets={"tip": [0.003, 0.001, 0.079]}, contacts={"wall": {"normal_force": 0.3, "reserve": 0.2}})
    sim, _ = steer(beside_a_wall, steps=15, **asked)
    state = sim.state()
    sim.step(20)
    after = sim.state_hash
    sim.restore(state)
    other = sim.clone()
    sim.step(20)
    other.step(20)
    assert sim.state_hash == after == other.state_hash
    again, _ = steer({**beside_a_wall, "solver": {**beside_a_wall.get("solver", {}), "threads": 2}}, steps=35, **asked)
    assert np.array_equal(again.body("finger").positions, sim.body("finger").positions)


def test_a_later_priority_gives_way(beside_a_wall):
    tree = beside_a_wall
    del tree["contacts"]
    tree["effectors"]["middle"] = {"body": "finger", "point": "0 0 40 mm"}
    targets = {"tip": [0.004, 0.0, 0.079], "middle": [-0.003, 0.0, 0.04]}
    errors = {}
    for name, order in {"none": None, "tip": {"middle": 2}, "middle": {"tip": 2}}.items():
        _, ik = steer(tree, steps=600, targets=targets, priorities=order)
        errors[name] = ik.errors
    assert errors["none"]["tip"] > 1e-4 and errors["none"]["middle"] > 1e-3
    # Least squares with weights 1 and 1e-4: the ratio of the errors falls by 1e-4, times the growth of the error that yields.
    assert errors["tip"]["tip"] < 1e-2 * errors["none"]["tip"]
    assert errors["middle"]["middle"] < 0.1 * errors["none"]["middle"]


@pytest.mark.parametrize(
    "asked, kind",
    [
        ({"wall": {"normal_force": -1.0}}, "out-of-range"),
        ({"wall": {"normal_force": {"min": 2.0, "max": 1.0}}}, "out-of-range"),
        ({"wall": {"normal_force": {"least": 2.0}}}, "unknown-key"),
        ({"wall": {"reserve": 1.0}}, "out-of-range"),
        ({"wall": {"grip": 1.0}}, "unknown-key"),
        ({"floor": {"normal_force": 1.0}}, "unknown-name"),
        ({"wall": {"normal_force": float("nan")}}, "not-finite"),
    ],
)
def test_bad_tasks_are_named(beside_a_wall, asked, kind):
    sim = sinew.load(beside_a_wall)
    with pytest.raises(sinew.Error) as caught:
        sinew.InverseController(sim, contacts=asked)
    assert caught.value.kind == kind


def test_no_friction_cannot_keep_from_slipping(beside_a_wall):
    beside_a_wall["contacts"]["wall"]["friction"] = 0
    with pytest.raises(sinew.Error, match="no friction"):
        sinew.InverseController(sinew.load(beside_a_wall), contacts={"wall": {"slip": False}})


def test_a_controller_that_steers_nothing_says_so(beside_a_wall):
    with pytest.raises(sinew.Error) as caught:
        sinew.InverseController(sinew.load(beside_a_wall), targets={})
    assert caught.value.kind == "no-effectors"
    beside_a_wall["controllers"] = {"hold": {"type": "inverse"}}
    with pytest.raises(sinew.Error) as caught:
        sinew.load(beside_a_wall)
    assert caught.value.kind == "missing-key"


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_every_choice_has_a_certificate(beside_a_wall, friction):
    beside_a_wall["contacts"]["wall"]["friction"] = friction
    sim = sinew.load(beside_a_wall)
    ik = sinew.InverseController(sim, targets={"tip": [0.0035, 0.0005, 0.079]}, certify=True)
    assert ik.certificate is None
    for _ in range(60):
        ik.step()
        found = ik.certificate
        assert found["violation"] < 1e-8 and found["stays"] < 1e-8
        if friction == 0.0:
            assert found["cold"] < 1e-8
    assert sim.contact("wall").normal_force > 0.1
    assert found["best_nearby"] and found["stationarity"] == "S"
    plain = sinew.load(beside_a_wall)
    sinew.InverseController(plain, targets={"tip": [0.0035, 0.0005, 0.079]}).step(60)
    assert plain.state_hash == sim.state_hash


def test_a_flat_optimum_is_stationary(beside_a_wall):
    # Efforts that the wall and the friction of its points leave undetermined may differ without any gain.
    sim, ik = steer(beside_a_wall, targets={"tip": [0.0035, 0.002, 0.079]}, certify=True)
    assert ik.status == "on-target"
    assert ik.certificate["stationarity"] != "none" and ik.certificate["best_nearby"]


def between_pads(motor):
    """A block of 100 g slides between a wall and a pad. A motor presses the pad with 0.5 N; 1.09 N would hold the block."""
    motor = {"type": "linear-motor", "joint": "press", "command": {"force": 0.5}, "limits": {"force": {"min": 0.0, **motor}}}
    sim = sinew.load(
        {
            "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": "5 ms",
            "bodies": {
                "block": {"type": "rigid", "shape": {"box": [0.02, 0.02, 0.04]}, "mass": "100 g"},
                "wall": {"type": "rigid", "shape": {"box": [0.01, 0.02, 0.6]}, "mass": "50 g",
                         "pose": {"position": [-0.015, 0.0, 0.0]}},
                "pad": {"type": "rigid", "shape": {"box": [0.01, 0.02, 0.6]}, "mass": "50 g",
                        "pose": {"position": [0.015, 0.0, 0.0]}},
            },
            "joints": {
                "held": {"type": "weld", "bodies": ["world", "wall"]},
                "press": {"type": "slider", "bodies": ["world", "pad"], "point": [0.015, 0.0, 0.0], "axis": [-1.0, 0.0, 0.0]},
            },
            "actuators": {"press": motor},
            "contacts": {name: {"between": [name, "block"], "friction": 0.5} for name in ("wall", "pad")},
            "effectors": {"block": {"body": "block", "point": [0.0, 0.0, 0.0]}},
        }
    )  # fmt: skip
    sim.step(20)
    return sim, sinew.InverseController(sim, contacts={name: {"slip": False, "reserve": 0.1} for name in ("wall", "pad")})


@pytest.mark.parametrize("motor, steps", [({"max": 5.0}, 5), ({"max": 5.0, "rate": 10.0}, 40)])
def test_a_grip_that_slides_is_pressed_until_it_sticks(motor, steps):
    sim, ik = between_pads(motor)
    assert {"slip"} == set(sim.contact("pad").states) - {"open"}
    before = sim.effector("block").position[2]
    sim.step()
    assert sim.effector("block").position[2] - before < -1e-3  # m, not slower than before
    assert ik.efforts[0] > 0.5 and max(ik.force_errors.values()) > 0.1
    assert ik.status in ("moving", "rate-limited")
    sim.step(steps)
    caught = sim.effector("block").position.copy()
    sim.step(50)
    assert np.linalg.norm(sim.effector("block").position - caught) < 2e-4
    assert sim.contact("pad").normal_force > 0.981 / (2 * 0.5)  # N, the minimum without sliding
    assert max(ik.force_errors.values()) < 0.1


def test_a_grip_too_weak_to_stop_the_slide_is_pressed_and_not_let_go():
    sim, ik = between_pads({"max": 0.8})
    sim.step()
    for _ in range(40):
        sim.step()
        assert sim.contact("pad").normal_force == pytest.approx(0.8, abs=1e-6)
        assert ik.status == "out-of-reach"
        # Of the weight of 0.981 N, 0.8 N are carried by friction; the two contacts share the remainder.
        assert min(ik.force_errors.values()) > 0.09
