"""Mechanisms and bodies that nothing fixes, without inertia: what holds them is found, what does not is named.

References are own moment balances, minimisations of the potential energy, and sums of forces.
"""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

import sinew

GRAVITY = 9.81
EDGE = 0.01  # m, of the cubes
KUHN = [(1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)]  # six tetrahedra around the diagonal 0-6


def cubes(path, cells, kind):
    """Writes cubes of 10 mm on a grid, with common nodes, as legacy VTK."""
    numbers, nodes, elements = {}, [], []

    def node(*at):
        if at not in numbers:
            numbers[at] = len(nodes)
            nodes.append(np.array(at) * EDGE)
        return numbers[at]

    for x, y, z in cells:
        h = [node(x + a, y + b, z + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        elements += [h] if kind == "hex8" else [[h[0], h[a], h[b], h[6]] for a, b in KUHN]
    code = 12 if kind == "hex8" else 10
    lines = ["# vtk DataFile Version 3.0", "cubes", "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(nodes)} double"]
    lines += [" ".join(map(repr, map(float, n))) for n in nodes]
    lines += [f"CELLS {len(elements)} {sum(len(e) + 1 for e in elements)}"]
    lines += [" ".join(map(str, [len(e), *e])) for e in elements]
    lines += [f"CELL_TYPES {len(elements)}", *[str(code)] * len(elements)]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def soft(mesh, kind, **more):
    law = {"model": "neo-hookean", "young_modulus": 1e5, "poisson_ratio": 0.45} if kind == "tet10" else {
        "young_modulus": 1e5, "poisson_ratio": 0.3}
    if kind == "hex8":
        law = {"model": "neo-hookean", "young_modulus": 1e5, "poisson_ratio": 0.3}
    return {"type": "fem", "mesh": {"file": mesh}, "element": kind, "material": law, "density": 1000.0,
            "fixed": {"box": [-0.1, -1, -1, 1e-4, 1, 1]}, **more}


HINGE, BALL, APART = [(0, 0, 0), (1, 0, 1)], [(0, 0, 0), (1, 1, 1)], [(0, 0, 0), (1, 0, 0)]
KINDS = ["tet4", "tet10", "hex8"]


def scene(bodies, **more):
    return {"sinew": 1, "gravity": [0, 0, -GRAVITY], "time_step": 0.01, "bodies": bodies, **more}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("cells, words", [(HINGE, "along the edge"), (BALL, "only at node")])
def test_parts_joined_at_an_edge_or_a_node_are_named(tmp_path, kind, cells, words):
    mesh = cubes(tmp_path / "m.vtk", cells, kind)
    with pytest.raises(sinew.Error, match=words) as caught:
        sinew.load(scene({"b": soft(mesh, kind)}))
    assert caught.value.kind == "nothing-fixed"
    assert "(0.01, " in str(caught.value)  # where
    with pytest.warns(sinew.SinewWarning, match="loose-part"):
        sim = sinew.load(scene({"b": soft(mesh, kind)}, integrator="backward-euler"))
    start = np.array(sim.body("b").positions)
    sim.step(5)  # a loose part swings
    assert np.abs(np.array(sim.body("b").positions) - start).max() > 1e-3


def test_a_loose_element_on_a_sound_beam_is_named(tmp_path):
    mesh = cubes(tmp_path / "m.vtk", [(k, 0, 0) for k in range(6)] + [(6, 0, 1)], "hex8")
    with pytest.raises(sinew.Error, match="1 element around .* along the edge from node"):
        sinew.load(scene({"b": soft(mesh, "hex8")}))


@pytest.mark.parametrize("kind", KINDS)
def test_a_cable_may_hold_a_loose_part(tmp_path, kind):
    mesh = cubes(tmp_path / "m.vtk", HINGE, kind)
    rope = {"type": "cable", "body": "b", "points": [[0.02, 0.005, 0.1], [0.019, 0.005, 0.019]], "command": {"displacement": 0.0}}
    sim = sinew.load(scene({"b": soft(mesh, kind)}, actuators={"rope": rope}))
    sim.step(3)
    assert sim.report.status == "solved"
    weight = 2 * EDGE**3 * 1000 * GRAVITY
    body = sim.body("b")
    fixed = np.abs(np.array(body.rest_positions)[:, 0]) < 1e-9
    held = np.array(body.reactions)[fixed].sum(axis=0)[2]
    assert held + sim.actuator("rope").tension == pytest.approx(weight, rel=1e-3)
    lever = 0.005 / 0.009  # of the weight of one cube and of the rope, about the common edge
    assert sim.actuator("rope").tension == pytest.approx(weight / 2 * lever, rel=0.03)


def bar(z=-0.15, axis="y", **more):
    return scene({"b": {"type": "rigid", "shape": {"box": [0.02, 0.02, 0.3]}, "mass": 0.2, "pose": {"position": [0, 0, z]}}},
                 joints={"j": {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": axis}}, **more)


SPRING = {"type": "spring", "body": "b", "points": [[0.3, 0, -0.3], [0, 0, -0.25]], "pull": "world", "stiffness": 40.0,
          "free_length": 0.2}


def spring_moment(q):
    e = np.array([-np.sin(q), 0, -np.cos(q)])
    d = np.array([0.3, 0, -0.3]) - 0.25 * e
    pull = 40.0 * (np.linalg.norm(d) - 0.2) * d / np.linalg.norm(d)
    return (np.cross(0.25 * e, pull) + np.cross(0.15 * e, [0, 0, -0.2 * GRAVITY]))[1]


def test_a_hinged_bar_balances_weight_and_spring():
    reference = brentq(spring_moment, -1.2, 0.3)
    sim = sinew.load(bar(actuators={"k": SPRING}))
    assert sim.solve_static().stable
    assert sim.joint("j").angle == pytest.approx(reference, abs=1e-6)
    sim = sinew.load(bar(actuators={"k": SPRING}))
    for _ in range(3):
        sim.step()
        assert sim.report.status == "solved"
    assert sim.joint("j").angle == pytest.approx(reference, abs=1e-5)


@pytest.mark.parametrize("steps", [False, True])
def test_a_pendulum_hangs_and_does_not_stand(steps):
    sim = sinew.load(bar(z=0.15))
    if steps:
        sim.step()
    else:
        assert sim.solve_static().stable
    assert np.allclose(sim.body("b").centre_of_mass, [0, 0, -0.15], atol=1e-6)
    standing = sinew.load(bar(z=0.15))
    standing.solve_static(stability="any")
    assert np.allclose(standing.body("b").centre_of_mass, [0, 0, 0.15], atol=1e-6)


def test_a_neutral_mechanism_is_named():
    sim = sinew.load(bar(axis="z", z=0.0) | {"joints": {"j": {"type": "hinge", "bodies": ["world", "b"], "point": [0.1, 0, 0], "axis": "z"}}})
    with pytest.raises(sinew.Error, match=r"body 'b' turns freely about the axis through \(0.1, 0, ") as caught:
        sim.step()
    assert caught.value.kind == "singular-matrix"


def test_nothing_acts_on_a_mechanism():
    with pytest.raises(sinew.Error, match="leave it free to move"):
        sinew.load({**bar(), "gravity": [0, 0, 0]})


def test_a_chain_hangs_as_least_energy_says():
    count, link, span = 6, 0.05, 0.22
    shape = lambda a: np.cumsum(np.r_[[[0, 0]], link * np.c_[np.cos(np.linspace(-a, a, count)), np.sin(np.linspace(-a, a, count))]], axis=0)
    a = brentq(lambda q: shape(q)[-1, 0] - span, 0.1, 1.5)
    at = shape(a)
    bodies, joints = {}, {}
    for k in range(count):
        d, middle = at[k + 1] - at[k], 0.5 * (at[k] + at[k + 1])
        pose = {"position": [middle[0], 0, middle[1]], "rotation": {"axis": [0, 1, 0], "angle": float(np.arctan2(-d[1], d[0]))}}
        bodies[f"l{k}"] = {"type": "rigid", "shape": {"box": [link, 0.004, 0.004]}, "mass": 0.02, "pose": pose}
        joints[f"j{k}"] = {"type": "hinge", "axis": "y", "bodies": ["world" if k == 0 else f"l{k - 1}", f"l{k}"], "point": [at[k][0], 0, at[k][1]]}
    joints["end"] = {"type": "ball", "bodies": [f"l{count - 1}", "world"], "point": [at[-1][0], 0, at[-1][1]]}
    height = lambda t: sum(link * (np.sin(t[:k]).sum() + 0.5 * np.sin(t[k])) for k in range(count))
    ends = [{"type": "eq", "fun": lambda t: link * np.cos(t).sum() - span}, {"type": "eq", "fun": lambda t: link * np.sin(t).sum()}]
    t = minimize(height, np.linspace(-a, a, count), constraints=ends, method="SLSQP", options={"ftol": 1e-15, "maxiter": 500}).x
    points = np.cumsum(np.r_[[[0, 0]], link * np.c_[np.cos(t), np.sin(t)]], axis=0)
    for steps in (False, True):
        sim = sinew.load(scene(bodies, joints=joints))
        if steps:
            sim.step(2)
            assert sim.report.status == "solved"
        else:
            assert sim.solve_static().stable
        centres = np.array([sim.body(f"l{k}").centre_of_mass for k in range(count)])
        assert np.abs(centres[:, [0, 2]] - 0.5 * (points[1:] + points[:-1])).max() < 1e-5 * span
        assert sim.joint("j0").force[2] == pytest.approx(count * 0.02 * GRAVITY / 2, rel=1e-5)


def test_a_plate_hangs_on_four_ropes():
    bodies = {"frame": {"type": "rigid", "shape": {"box": [2, 2, 0.02]}, "fixed": True, "pose": {"position": [0, 0, 1]}},
              "plate": {"type": "rigid", "shape": {"box": [0.2, 0.2, 0.02]}, "mass": 2.0, "pose": {"position": [0, 0, 0]}}}
    ropes = {f"c{k}": {"type": "cable", "body": "frame", "points": [[0.9 * x, 0.9 * y, 0.99], {"body": "plate", "point": [0.1 * x, 0.1 * y, 0.01]}],
                       "command": {"displacement": 0.0}} for k, (x, y) in enumerate([(1, 1), (-1, 1), (-1, -1), (1, -1)])}
    length = np.linalg.norm([0.8, 0.8, 0.98])
    for steps in (False, True):
        sim = sinew.load(scene(bodies, actuators=ropes))
        if steps:
            sim.step(3)
            assert sim.report.status == "solved"
        else:
            assert sim.solve_static().stable
        tensions = [sim.actuator(f"c{k}").tension for k in range(4)]
        assert tensions == pytest.approx([2.0 * GRAVITY / 4 * length / 0.98] * 4, rel=1e-5)
        assert np.allclose(sim.body("plate").position, 0.0, atol=1e-7)
    for k in range(4):  # all four are pulled by 0.1 m
        sim.actuator(f"c{k}").displacement = sinew.Ramp(0.0, 0.1, start=sim.time, duration=0.1)
    sim.step(12)
    assert sim.report.status == "solved"
    shorter = length - 0.1
    assert sim.body("plate").position[2] == pytest.approx(0.98 - np.sqrt(shorter**2 - 2 * 0.8**2), abs=1e-5)


def plane(axis, angle):
    return {"type": "rigid", "shape": {"plane": {}}, "fixed": True, "pose": {"rotation": {"axis": axis, "angle": angle}}}


def block(position, **pose):
    return {"type": "rigid", "shape": {"box": [0.04, 0.04, 0.04]}, "mass": 0.2, "pose": {"position": position, **pose}}


def sloped(angle, friction):
    at = [0.02 * np.sin(angle), 0, 0.02 * np.cos(angle)]
    return scene({"b": block(at, rotation={"axis": [0, 1, 0], "angle": angle}), "floor": plane([0, 1, 0], angle)},
                 contacts={"c": {"between": ["b", "floor"], "friction": friction}})


@pytest.mark.parametrize("steps", [False, True])
def test_friction_holds_a_block(steps):
    sim = sinew.load(sloped(0.3, 0.5))
    start = np.array(sim.body("b").position)
    sim.step(3) if steps else sim.solve_static()
    assert np.abs(sim.body("b").position - start).max() < 1e-6
    force = np.array(sim.contact("c").force)
    assert np.abs(force) == pytest.approx([0, 0, 0.2 * GRAVITY], abs=1e-4)


@pytest.mark.parametrize("friction", [0.1, 0.0])
def test_what_slides_is_named(friction):
    for act in ("step", "solve_static"):
        sim = sinew.load(sloped(0.3, friction))
        with pytest.raises(sinew.Error, match="body 'b' .*moves freely"):
            getattr(sim, act)()
        assert np.abs(sim.body("b").position - np.array(sloped(0.3, friction)["bodies"]["b"]["pose"]["position"])).max() < 1e-12


# A motor that is told an effort holds nothing: its joint is as free as without it.


WHEEL = """sinew: 1
time_step: 10 ms
gravity: {gravity} m/s^2
bodies:
  wheel: {{type: rigid, shape: {{box: 10 10 10 mm}}, mass: 10 g, pose: {{position: 0 80 0 mm}}}}
joints:
  axle: {{type: {kind}, bodies: [world, wheel], point: {point}, axis: z}}
actuators:
  turn: {{type: {motor}, joint: axle{told}}}
"""


def wheel(kind="hinge", point="0 70 0 mm", gravity="0 0 0", told=""):
    motor = "motor" if kind == "hinge" else "linear-motor"
    return sinew.loads(WHEEL.format(kind=kind, point=point, gravity=gravity, motor=motor, told=told))


def test_a_wheel_that_an_idle_motor_may_turn_rests():
    sim = wheel(point="0 80 0 mm")
    report = sim.solve_static()
    assert report.stable and report.negative_pivots == 0
    assert sim.body("wheel").position == pytest.approx([0.0, 0.08, 0.0], abs=1e-9)


@pytest.mark.parametrize("gravity, height", [("0 -9.81 0", 0.06), ("0 9.81 0", 0.08)])
def test_an_idle_motor_lets_it_hang(gravity, height):
    sim = wheel(gravity=gravity)
    assert sim.solve_static().stable
    assert sim.body("wheel").position[:2] == pytest.approx([0.0, height], abs=1e-5)


def test_a_motor_holds_against_weight_where_its_torque_balances():
    torque, lever = 2e-4, 0.01
    sim = wheel(gravity="0 9.81 0", told=", command: {torque: 0.2 N mm}")
    assert sim.solve_static().stable
    sine = torque / (0.01 * 9.81 * lever)
    assert abs(sim.body("wheel").position[0]) == pytest.approx(lever * sine, rel=1e-6)


@pytest.mark.parametrize("options, words", [
    ({}, "the equilibrium is neutral: body 'wheel' turns freely about the axis"),
    ({"kind": "slider"}, "the equilibrium is neutral: body 'wheel' moves freely along"),
    ({"point": "0 80 0 mm", "told": ", command: {torque: 1 N mm}"}, "nothing holds a part: body 'wheel' turns freely"),
    ({"kind": "slider", "gravity": "0 0 -9.81"}, "nothing holds a part: body 'wheel' moves freely along"),
    ({"kind": "slider", "told": ", command: {force: 1 N}"}, "nothing holds a part: body 'wheel' moves freely along"),
])
def test_a_motor_that_holds_nothing_leaves_it_free(options, words):
    with pytest.raises(sinew.RunError) as caught:
        wheel(**options).solve_static()
    assert words in str(caught.value)
