"""Errors name joints, limits and prescribed motions that contradict each other; redundant ones are accepted."""

import numpy as np
import pytest
import sinew

INTEGRATORS = ["backward-euler", "bdf2", "event-driven", "quasi-static"]
STEP = 1e-3  # s


def box(x=0.0, z=0.0, **keys):
    return {"type": "rigid", "shape": {"box": [0.04, 0.03, 0.02]}, "density": 1000.0,
            "pose": {"position": [x, 0, z]}, **keys}


def hinge(first, second, point=(0, 0, 0), axis="y", **keys):
    return {"type": "hinge", "bodies": [first, second], "point": list(point), "axis": axis, **keys}


def moved(x_end):
    """Setting for a prescribed motion to x_end (m) at the end of the first step."""
    return {"motion": {"x": {"ramp": {"to": x_end, "duration": STEP}}}}


def scene(integrator, **keys):
    return sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "time_step": STEP,
                       "integrator": integrator, **keys})


def fails(sim):
    with pytest.raises(sinew.Error, match="contradict each other") as caught:
        for _ in range(3):
            sim.step()
    assert caught.value.kind == "not-converged"
    assert "'other'" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_joint_between_given_motions_is_named(integrator):
    sim = scene(integrator, bodies={"jaw": box(**moved(1e-4)), "bench": box(0.1, fixed=True),
                                    "other": box(0.3)},
                joints={"pin": hinge("jaw", "bench", (0.05, 0, 0)),
                        "free": hinge("world", "other", (0.3, 0, 0), friction=1.0)})
    text = fails(sim)
    assert "'pin' is open by" in text
    assert "'free'" not in text
    if integrator == "quasi-static":  # other integrators try smaller steps first
        assert "'pin' is open by 0.1 mm" in text


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_link_that_is_too_short_is_named_by_both_ends(integrator):
    sim = scene(integrator, bodies={"jaw": box(**moved(1e-4)), "link": box(0.1),
                                    "bench": box(0.2, fixed=True)},
                joints={"near": hinge("jaw", "link", (0.05, 0, 0)),
                        "far": hinge("link", "bench", (0.15, 0, 0))})
    text = fails(sim)
    assert "'near' is open by" in text and "'far' is open by" in text
    assert "in any position of the bodies; let a joint leave" in text


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_motor_against_a_second_axis_is_named(integrator):
    motor = {"type": "motor", "joint": "first", "command": {"velocity": 1.0}}
    sim = scene(integrator, bodies={"box": box()}, actuators={"motor": motor},
                joints={"first": hinge("world", "box", axis="y"),
                        "second": hinge("world", "box", axis="x")})
    text = fails(sim)
    assert "'second' is open by" in text and "the command of 'motor' is missed by" in text
    assert "deg" in text and " mm" not in text


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_motors_of_one_loop_that_disagree_are_named_with_it(integrator):
    """A parallelogram linkage whose two cranks are driven in opposite directions."""
    pins = {"a": hinge("world", "left", (0, 0, 0)), "b": hinge("world", "right", (0.1, 0, 0)),
            "c": hinge("left", "top", (0, 0, 0.1)), "d": hinge("top", "right", (0.1, 0, 0.1))}
    motors = {name: {"type": "motor", "joint": joint, "command": {"velocity": rate}}
              for name, joint, rate in (("one", "a", 1.0), ("two", "b", -1.0))}
    bodies = {"left": box(0, 0.05), "right": box(0.1, 0.05), "top": box(0.05, 0.1)}
    text = fails(scene(integrator, bodies=bodies, joints=pins, actuators=motors))
    for name in ("a", "b", "c", "d", "one", "two"):
        assert f"'{name}'" in text
    motors["two"]["command"] = {"velocity": 1.0}
    sim = scene(integrator, bodies=bodies, joints=pins, actuators=motors)
    for _ in range(100):
        sim.step()
    assert sim.joint("c").angle == pytest.approx(-0.1, abs=1e-6)


@pytest.mark.parametrize("integrator", INTEGRATORS[:3])
def test_a_command_beyond_a_limit_is_named_with_it(integrator):
    pin = hinge("world", "box", limits={"angle": {"min": -0.1, "max": 0.1}})
    motor = {"type": "motor", "joint": "pin", "command": {"angle": 0.5}}
    text = fails(scene(integrator, bodies={"box": box()}, joints={"pin": pin},
                       actuators={"motor": motor}))
    assert "the limit of 'pin'" in text and "the command of 'motor'" in text


def test_a_static_solution_names_them():
    weld = {"type": "weld", "bodies": ["world", "box"]}
    motor = {"type": "motor", "joint": "pin", "command": {"angle": 0.5}}
    sim = scene("quasi-static", bodies={"box": box()}, actuators={"motor": motor},
                joints={"pin": hinge("world", "box"), "glue": weld})
    with pytest.raises(sinew.Error, match="contradict each other: .*'motor' is missed by 28.6 deg"):
        sim.solve_static()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_joints_that_repeat_each_other_hold(integrator):
    """Redundant joints: hinges about two axes, a weld, and a bar on two collinear hinges; nothing moves."""
    joints = {"first": hinge("world", "box", axis="y"), "second": hinge("world", "box", axis="x"),
              "glue": {"type": "weld", "bodies": ["world", "box"]},
              "left": hinge("world", "bar", (0.2, -0.01, 0)),
              "right": hinge("world", "bar", (0.2, 0.01, 0)),
              "stop": {"type": "weld", "bodies": ["box", "bar"]}}
    sim = scene(integrator, bodies={"box": box(), "bar": box(0.2)}, joints=joints)
    for _ in range(50):
        sim.step()
    held = [sim.joint(name) for name in ("first", "second", "glue")]
    assert sum(joint.force[2] for joint in held) + sim.joint("left").force[2] + sim.joint(
        "right").force[2] == pytest.approx(-2 * 0.04 * 0.03 * 0.02 * 1000 * -9.81, rel=1e-9)
    assert np.abs(sim.body("box").position).max() < 1e-12
    assert max(joint.gap for joint in sim.joints.values()) < 1e-12
