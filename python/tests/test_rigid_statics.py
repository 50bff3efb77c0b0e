"""Rigid bodies that only touch others, without inertia: at rest where geometry and friction hold them.

References are balances of forces by hand.
"""

import numpy as np
import pytest

import sinew

GRAVITY = 9.81


def plane(axis, angle, position=(0, 0, 0)):
    pose = {"position": list(position), "rotation": {"axis": axis, "angle": angle}}
    return {"type": "rigid", "shape": {"plane": {}}, "fixed": True, "pose": pose}


def rigid(shape, mass, position, axis=(0, 1, 0), angle=0.0, **more):
    pose = {"position": list(position), "rotation": {"axis": list(axis), "angle": angle}}
    return {"type": "rigid", "shape": shape, "mass": mass, "pose": pose, **more}


def ball(radius, mass, position, **more):
    return rigid({"sphere": {"radius": radius}}, mass, position, **more)


def scene(bodies, friction=0.0, gravity=(0, 0, -GRAVITY), **more):
    contacts = {"all": {"between": "all", "friction": friction}}
    return {"sinew": 1, "gravity": list(gravity), "time_step": 0.01, "bodies": bodies, "contacts": contacts, **more}


def settle(tree, steps):
    """Statics, or two quasi-static steps."""
    sim = sinew.load(tree)
    if steps:
        for _ in range(2):
            sim.step()
            assert sim.report.status == "solved"
    else:
        sim.solve_static()
    return sim


def total(sim):
    """Sum of the forces on body b, N."""
    force = np.zeros(3)
    for contact in map(sim.contact, sim.contacts):
        sense = 1.0 if contact.bodies[0] == "b" else -1.0 if contact.bodies[-1] == "b" else 0.0
        force += sense * np.array(contact.force)
    return force


def groove(angle, above=0.0, turned=0.0, friction=0.0, gravity=(0, 0, -GRAVITY), shape="box"):
    """A square bar (turned by 45 degrees at angle = 45 degrees) or a cylinder between two sloping planes."""
    walls = {"left": plane([0, 1, 0], angle), "right": plane([0, 1, 0], -angle)}
    if shape == "box":
        low = 0.02 * np.sqrt(2.0)
        body = rigid({"box": [0.04, 0.06, 0.04]}, 0.2, [0, 0, low + above], angle=np.pi / 4 + turned)
    else:
        body = rigid({"cylinder": {"radius": 0.02, "height": 0.06}}, 0.2, [0, 0, 0.02 / np.cos(angle) + above], [1, 0, 0], np.pi / 2)
    return scene({**walls, "b": body}, friction, gravity)


@pytest.mark.parametrize("steps", [False, True])
@pytest.mark.parametrize(
    "shape, angle, above, turned",
    [("box", np.pi / 4, 0.0, 0.0), ("box", np.pi / 4, 3e-3, 0.0), ("box", np.pi / 4, 3e-3, 0.05), ("cylinder", np.pi / 6, 0.0, 0.0),
     ("cylinder", np.pi / 3, 2e-3, 0.0)],
)  # fmt: skip
def test_the_sides_of_a_groove_carry_a_body_without_friction(steps, shape, angle, above, turned):
    sim = settle(groove(angle, above, turned, shape=shape), steps)
    for name, side in (("left", 1.0), ("right", -1.0)):
        contact = next(c for c in map(sim.contact, sim.contacts) if name in c.bodies or c.name.endswith(name))
        push = 0.2 * GRAVITY / (2 * np.cos(angle))
        assert np.allclose(contact.force, [side * push * np.sin(angle), 0, push * np.cos(angle)], atol=1e-6 * push)
    low = 0.02 * np.sqrt(2.0) if shape == "box" else 0.02 / np.cos(angle)
    assert np.allclose(np.array(sim.body("b").position)[[0, 2]], [0, low], atol=1e-6)


@pytest.mark.parametrize("act", ["step", "solve_static"])
@pytest.mark.parametrize("shape, friction", [("box", 0.0), ("cylinder", 0.0), ("box", 0.1)])
def test_a_body_loaded_along_a_groove_is_named(act, shape, friction):
    down = [0, GRAVITY * np.sin(0.3), -GRAVITY * np.cos(0.3)]
    sim = sinew.load(groove(np.pi / 4, friction=friction, gravity=down, shape=shape))
    with pytest.raises(sinew.Error, match=r"body 'b' .*along.* \(0, 1, 0\)") as caught:
        getattr(sim, act)()
    assert caught.value.kind == "singular-matrix"


@pytest.mark.parametrize("steps", [False, True])
def test_friction_holds_a_body_along_a_groove(steps):
    down = np.array([0, GRAVITY * np.sin(0.3), -GRAVITY * np.cos(0.3)])
    sim = settle(groove(np.pi / 4, friction=0.5, gravity=down), steps)
    assert np.allclose(total(sim), -0.2 * down, atol=1e-6)
    assert np.allclose(sim.body("b").position, [0, 0, 0.02 * np.sqrt(2.0)], atol=1e-6)


@pytest.mark.parametrize("steps", [False, True])
@pytest.mark.parametrize("above", [(0, 0, 0), (0.005, 0.004, 0.003)])
def test_three_planes_carry_a_ball(steps, above):
    walls = {"x": plane([0, 1, 0], np.pi / 2), "y": plane([1, 0, 0], -np.pi / 2), "z": plane([0, 0, 1], 0.0)}
    weight = np.array([-3.0, -4.0, -8.0])
    sim = settle(scene({**walls, "b": ball(0.02, 0.1, 0.02 + np.array(above))}, 0.0, weight), steps)
    assert np.allclose(sim.body("b").position, 0.02, atol=1e-7)
    forces = sorted(sim.contact(name).normal_force for name in sim.contacts)
    assert forces == pytest.approx([0.3, 0.4, 0.8], rel=1e-6)


@pytest.mark.parametrize("steps", [False, True])
@pytest.mark.parametrize("above", [(0, 0, 0), (0.002, 0.001, 0.004)])
def test_three_balls_carry_a_ball(steps, above):
    nest = {f"s{k}": ball(0.02, 1.0, [0.03 * np.cos(2.1 * k), 0.03 * np.sin(2.1 * k), 0], fixed=True) for k in (0, 1, 2)}
    at = [0.03 * np.exp(2.1j * k) for k in (0, 1, 2)]
    # The balance of three forces along the lines between the centres.
    height = np.sqrt(0.05**2 - 0.03**2)
    lines = np.array([[-p.real, -p.imag, height] for p in at]).T / 0.05
    expected = np.linalg.solve(lines, [0, 0, 0.1 * GRAVITY])
    sim = settle(scene({**nest, "b": ball(0.03, 0.1, np.array([0, 0, height]) + above)}), steps)
    assert np.allclose(sim.body("b").position, [0, 0, height], atol=1e-6)
    assert sorted(sim.contact(name).normal_force for name in sim.contacts if "b" in sim.contact(name).bodies) == pytest.approx(sorted(expected), rel=1e-5)


@pytest.mark.parametrize("steps", [False, True])
@pytest.mark.parametrize("friction, needed", [(0.5, 2.0), (0.5, 1.05), (0.3, 4.0)])
def test_plates_hold_a_block_between_them(steps, friction, needed):
    press = needed * 0.1 * GRAVITY / 2 / friction
    bodies = {"wall": rigid({"box": [0.02, 0.1, 0.1]}, 1.0, [-0.03, 0, 0], fixed=True), "b": rigid({"box": [0.04, 0.04, 0.04]}, 0.1, [0, 0, 0]),
              "plate": rigid({"box": [0.02, 0.1, 0.1]}, 1.0, [0.03, 0, 0])}  # fmt: skip
    motor = {"type": "linear-motor", "joint": "s", "command": {"force": -press}}
    slider = {"type": "slider", "bodies": ["world", "plate"], "axis": [1, 0, 0], "point": [0.03, 0, 0]}
    sim = settle(scene(bodies, friction, joints={"s": slider}, actuators={"m": motor}), steps)
    assert np.allclose(sim.body("b").position, 0.0, atol=1e-7)
    assert np.allclose(total(sim), [0, 0, 0.1 * GRAVITY], atol=1e-6)


@pytest.mark.parametrize("act", ["step", "solve_static"])
def test_a_ball_does_not_stay_on_a_ball(act):
    sim = sinew.load(scene({"s": ball(0.05, 1.0, [0, 0, 0], fixed=True), "b": ball(0.02, 0.1, [0, 0, 0.07])}))
    with pytest.raises(sinew.Error, match="body 'b'"):
        getattr(sim, act)()


@pytest.mark.parametrize("steps", [False, True])
def test_a_block_stands_on_a_level_floor_without_friction(steps):
    sim = settle(scene({"floor": plane([0, 0, 1], 0.0), "b": rigid({"box": [0.04, 0.04, 0.04]}, 0.2, [0.01, 0, 0.02])}), steps)
    assert np.allclose(sim.body("b").position, [0.01, 0, 0.02], atol=1e-9)
    assert np.allclose(total(sim), [0, 0, 0.2 * GRAVITY], atol=1e-6)
