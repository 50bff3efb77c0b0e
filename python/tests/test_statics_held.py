"""Bodies that contact, friction and ropes hold without inertia: statics and quasi-static steps.

References are balances of forces and moments by hand. The scenes are also turned as a whole, with their bodies in another order.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import sinew

GRAVITY = 9.81
TURNS = [(0.0, 0.0, 0.0), (0.3, -0.8, 0.5)]


def rigid(shape, mass, position, turn=(0.0, 0.0, 0.0), **more):
    return {"type": "rigid", "shape": shape, "mass": mass, "at": np.array(position), "turn": np.array(turn), **more}


def soft(edges, corner, cell=0.01, element="hex8", **more):
    mesh = dict(zip(("length", "width", "height"), edges), shape="block", element_size=cell)
    law = {"model": "neo-hookean", "young_modulus": 2e5, "poisson_ratio": 0.3}
    return {"type": "fem", "density": 1000.0, "material": law, "mesh": mesh, "element": element, "at": np.array(corner),
            "turn": np.zeros(3), **more}


def placed(body, world):
    """A body of a scene that is turned as a whole."""
    turn = (world * Rotation.from_rotvec(body["turn"])).as_rotvec()
    angle = float(np.linalg.norm(turn))
    rotation = {"axis": (turn / angle).tolist() if angle > 0 else [0, 0, 1], "angle": angle}
    position = world.apply(body["at"]).tolist()
    rest = {k: v for k, v in body.items() if k not in ("at", "turn")}
    return rest | ({"pose": {"position": position, "rotation": rotation}} if body["type"] == "rigid" else
                   {"position": position, "rotation": turn.tolist()})


def load(bodies, friction, down=(0, 0, -1), turn=(0, 0, 0), reverse=False, rope=None):
    """@param rope from a point of the wall to a point of body b, m."""
    world = Rotation.from_rotvec(turn)
    names = list(bodies)[::-1] if reverse else list(bodies)
    tree = {"sinew": 1, "gravity": (GRAVITY * world.apply(down)).tolist(), "time_step": 0.01,
            "bodies": {name: placed(bodies[name], world) for name in names},
            "contacts": {"c": {"between": names, "friction": friction}}}
    if rope is not None:
        points = [world.apply(rope[0]).tolist(), {"body": "b", "point": world.apply(rope[1]).tolist()}]
        tree["actuators"] = {"rope": {"type": "cable", "body": "base", "points": points, "command": {"displacement": 0.0}}}
    return sinew.load(tree), world


def hold(sim, steps, each=lambda: None):
    """Statics, or quasi-static steps, each of which must be solved."""
    if not steps:
        sim.solve_static()
        each()
    for _ in range(steps):
        sim.step()
        assert sim.report.status == "solved"
        each()


def axes(sim):
    """Rotation of body b from its own axes."""
    return Rotation.from_quat(np.roll(sim.body("b").rotation, -1))


def force_on_b(sim, world):
    """N, in the axes of the scene before it was turned."""
    sense = 1.0 if sim.contact("c").bodies[0] == "b" else -1.0
    return sense * world.inv().apply(sim.contact("c").force)


PAD = soft((0.04, 0.04, 0.02), (-0.02, -0.02, 0.0), fixed=[{"set": "z_min"}])
FLOOR = rigid({"box": [0.2, 0.2, 0.02]}, 1.0, (0, 0, -0.01), fixed=True)


@pytest.mark.parametrize("steps", [0, 4])
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("aside", [(0.0, 0.0), (0.002, 0.001)])
def test_a_block_rests_on_a_soft_pad_without_friction(steps, reverse, turn, aside):
    block = rigid({"box": [0.02, 0.02, 0.02]}, 0.1, (*aside, 0.0301))
    sim, world = load({"base": PAD, "b": block}, 0.0, turn=turn, reverse=reverse)

    def balanced():
        assert np.allclose(force_on_b(sim, world), [0, 0, 0.1 * GRAVITY], atol=1e-5)
        weight = sim.body("base").mass * GRAVITY + 0.1 * GRAVITY
        assert np.allclose(world.inv().apply(np.sum(sim.body("base").reactions, axis=0)), [0, 0, weight], atol=1e-5)

    hold(sim, steps, balanced)


@pytest.mark.parametrize("steps", [0, 3])
@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("tilt, friction", [(0.0, 0.0), (np.radians(10), 0.5)])
@pytest.mark.parametrize("scene", ["rigid on soft", "soft on rigid"])
def test_friction_or_a_level_floor_holds_soft_and_rigid_blocks(steps, turn, tilt, friction, scene):
    down = np.array([np.sin(tilt), 0, -np.cos(tilt)])
    block = rigid({"box": [0.02, 0.02, 0.02]}, 0.1, (0.002, 0.001, 0.0301))
    bodies = {"base": PAD, "b": block} if scene == "rigid on soft" else {"base": FLOOR, "b": soft((0.04, 0.04, 0.02), (-0.02, -0.02, 0))}
    sim, world = load(bodies, friction, down, turn)
    hold(sim, steps)
    assert np.allclose(force_on_b(sim, world), -sim.body("b").mass * GRAVITY * down, atol=1e-5)


@pytest.mark.parametrize("act", ["step", "solve_static"])
@pytest.mark.parametrize("turn", TURNS)
def test_a_soft_block_slides_off_a_slope_without_friction(act, turn):
    plane = rigid({"plane": {}}, 1.0, (0, 0, 0), fixed=True)
    del plane["mass"]
    sim, world = load({"base": plane, "b": soft((0.04, 0.04, 0.02), (-0.02, -0.02, 0))}, 0.0, (np.sin(0.1), 0, -np.cos(0.1)), turn)
    with pytest.raises(sinew.Error, match="body 'b' moves freely along") as caught:
        getattr(sim, act)()
    assert caught.value.kind == "singular-matrix"
    named = np.array([float(x) for x in str(caught.value).split("along (")[1].split(")")[0].split(",")])
    assert abs(world.inv().apply(named)[0]) == pytest.approx(1.0, abs=0.02)


WALL = rigid({"box": [0.02, 0.4, 1.0]}, 1.0, (-0.01, 0, 0), fixed=True)


def strut(kind):
    """A rod that stands off a wall, held by a rope from its outer end to the wall above. Returns the bodies, the rope, and its angle."""
    length, thick, height = 0.3, 0.02, 0.2
    rod = rigid({"box": [length, thick, thick]}, 0.2, (length / 2, 0, 0))
    if kind == "round":
        rod = rigid({"capsule": {"radius": thick / 2, "length": length - thick}}, 0.2, (length / 2, 0, 0), (0, np.pi / 2, 0))
    end = length - 0.01
    return {"base": WALL, "b": rod}, ((0, 0, height), (end, 0, 0)), np.arctan2(height, end)


@pytest.mark.parametrize("steps", [0, 3])
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("kind, friction", [("square", 0.8), ("square", 0.72), ("round", 0.8)])
def test_a_rope_and_a_rough_wall_hold_a_rod(steps, reverse, turn, kind, friction):
    """The line of the force at the wall meets those of the weight and of the rope in one point (three forces)."""
    bodies, rope, angle = strut(kind)
    sim, world = load(bodies, friction, turn=turn, reverse=reverse, rope=rope)

    def held():
        push, pull = force_on_b(sim, world), sim.actuator("rope").tension
        weight = 0.2 * GRAVITY
        assert np.allclose(push + pull * np.array([-np.cos(angle), 0, np.sin(angle)]), [0, 0, weight], atol=1e-5)
        # Moment about the middle of the end at the wall: the normal forces act within the end's height.
        lever = (weight * 0.15 - pull * np.sin(angle) * 0.29) / push[0]
        assert abs(lever) <= (0.01 if kind == "square" else 0.0) + 1e-6
        assert np.linalg.norm(push[1:]) <= friction * push[0] + 1e-6
        assert np.allclose(world.inv().apply(sim.body("b").centre_of_mass), [0.15, 0, 0], atol=1e-6)

    hold(sim, steps, held)


def test_the_forces_of_a_rod_depend_on_nothing_but_the_load():
    """A rope and the corners of a square end hold it in more than one way: the least forces are those of any order and axes."""
    pulls = []
    for turn in TURNS:
        for reverse in (False, True):
            bodies, rope, _ = strut("square")
            sim, _ = load(bodies, 0.8, turn=turn, reverse=reverse, rope=rope)
            hold(sim, 0)
            pulls.append([sim.actuator("rope").tension, *np.sort(sim.contact(list(sim.contacts)[0]).normal_forces)])
    assert np.allclose(pulls, pulls[0], rtol=1e-9)


def test_a_rod_follows_the_rope_that_holds_it():
    bodies, rope, _ = strut("square")
    sim, world = load(bodies, 0.8, rope=rope)
    sim.actuator("rope").displacement = sinew.Ramp(0.0, 0.005, duration=0.05)
    hold(sim, 7)
    top = np.array(rope[0])
    end = np.array(sim.body("b").position) + axes(sim).apply([0.14, 0, 0])
    assert np.linalg.norm(top - end) == pytest.approx(np.linalg.norm(top - rope[1]) - 0.005, abs=1e-6)
    pull = sim.actuator("rope").tension * (top - end) / np.linalg.norm(top - end)
    assert np.allclose(force_on_b(sim, world) + pull, [0, 0, 0.2 * GRAVITY], atol=1e-5)


@pytest.mark.parametrize("steps", [0, 3])
@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_picture_hangs_on_a_wall(steps, turn, friction):
    """A plate on a rope from a nail above, whose lower edge presses on the wall."""
    lean = 0.15
    own = Rotation.from_rotvec([0, lean, 0])
    plate = rigid({"box": [0.01, 0.15, 0.2]}, 0.3, own.apply([0.005, 0, 0.1]), (0, lean, 0))
    sim, world = load({"base": WALL, "b": plate}, friction, turn=turn, rope=((0, 0, 0.3), tuple(own.apply([0, 0, 0.18]))))
    hold(sim, steps)
    push, pull = force_on_b(sim, world), sim.actuator("rope").tension
    centre = world.inv().apply(sim.body("b").centre_of_mass)
    now = world.inv() * axes(sim)
    tied = centre + now.apply(own.inv().apply(own.apply([0, 0, 0.18]) - own.apply([0.005, 0, 0.1])))
    low = centre + now.apply([-0.005, 0, -0.1])
    rope = pull * (np.array([0, 0, 0.3]) - tied) / np.linalg.norm(np.array([0, 0, 0.3]) - tied)
    weight = np.array([0, 0, -0.3 * GRAVITY])
    assert np.allclose(push + rope + weight, 0, atol=1e-5)
    assert np.allclose(np.cross(low - centre, push) + np.cross(tied - centre, rope), 0, atol=1e-6)
    assert np.hypot(push[1], push[2]) <= friction * push[0] + 1e-6


PLANE = {k: v for k, v in rigid({"plane": {}}, 1.0, (0, 0, 0), fixed=True).items() if k != "mass"}


@pytest.mark.parametrize("steps", [0, 2])
@pytest.mark.parametrize("turn", TURNS)
def test_a_rod_does_not_stand_on_its_round_end(steps, turn):
    """Its centre is above that of the end, however little it leans. A spin about its axis is neutral and matters to nothing."""
    rod = rigid({"capsule": {"radius": 0.01, "length": 0.1}}, 0.1, (0, 0, 0.06))
    sim, world = load({"base": PLANE, "b": rod}, 0.5, turn=turn)
    hold(sim, steps)
    assert world.inv().apply(sim.body("b").position)[2] == pytest.approx(0.01, abs=1e-6)
    assert np.allclose(force_on_b(sim, world), [0, 0, 0.1 * GRAVITY], atol=1e-5)


@pytest.mark.parametrize("steps", [0, 2])
@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("height, stays", [(0.01, True), (0.08, True), (0.12, False)])
def test_a_board_rocks_on_a_ball_that_is_larger_than_half_its_height(steps, turn, height, stays):
    """Rolling by an angle raises its centre by (R - h/2) angle^2 / 2."""
    ball = rigid({"sphere": {"radius": 0.05}}, 1.0, (0, 0, 0), fixed=True)
    board = rigid({"box": [0.1, 0.1, height]}, 0.1, (0, 0, 0.05 + height / 2))
    sim, world = load({"base": ball, "b": board}, 0.5, turn=turn)
    if stays:
        hold(sim, steps)
        assert np.allclose(world.inv().apply(sim.body("b").position), [0, 0, 0.05 + height / 2], atol=1e-6)
        assert np.allclose(force_on_b(sim, world), [0, 0, 0.1 * GRAVITY], atol=1e-5)
    else:
        with pytest.raises(sinew.Error, match="body 'b'") as caught:
            hold(sim, steps)
        assert caught.value.kind == "singular-matrix"
