"""Contact of bodies with moving rigid bodies of primitive shape."""

import numpy as np
import pytest
import sinew

GRAVITY = 9.81
TABLE = {"type": "rigid", "shape": {"box": "200 200 20 mm"}, "fixed": True, "pose": {"position": "0 0 -10 mm"}}


def cube(mass="200 g", height=20, **more):
    return {"type": "rigid", "shape": {"box": "40 40 40 mm"}, "mass": mass,
            "pose": {"position": f"0 0 {height} mm"}, **more}


def make(bodies, contacts, step="1 ms", gravity="0 0 -9.81 m/s^2", **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": "backward-euler", "gravity": gravity,
                       "bodies": bodies, "contacts": contacts, **more})


def soft_block(**more):
    return {"type": "fem", "density": 1000.0, "damping": {"stiffness": "2 ms"},
            "material": {"young_modulus": "200 kPa", "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.02, "element_size": 0.005}, **more}


def momenta(sim, *names):
    """Linear and angular momentum about the origin, and kinetic energy."""
    linear, angular, energy = np.zeros(3), np.zeros(3), 0.0
    for name in names:
        body = sim.body(name)
        velocity, spin = body.velocity[:3], body.velocity[3:]
        turned = body.inertia @ spin
        linear += body.mass * velocity
        angular += np.cross(body.centre_of_mass, body.mass * velocity) + turned
        energy += 0.5 * body.mass * velocity @ velocity + 0.5 * spin @ turned
    return linear, angular, energy


@pytest.mark.parametrize("order", [["cube", "table"], ["table", "cube"]])
def test_a_cube_falls_on_a_table_and_rests(order):
    sim = make({"table": TABLE, "cube": cube(height=25)}, {"floor": {"between": order, "friction": 0.5}})
    sim.run(duration=0.2)
    floor = sim.contact("floor")
    assert floor.bodies == order
    assert sim.body("cube").position == pytest.approx([0, 0, 0.02], abs=1e-8)
    assert floor.normal_force == pytest.approx(0.2 * GRAVITY, rel=1e-6)
    assert np.linalg.norm(sim.body("cube").velocity) < 1e-8


@pytest.mark.parametrize("friction", [0.1, 0.25, 0.5])
def test_a_cube_on_a_tilted_table_obeys_coulomb(friction):
    angle = 0.3
    tilt = {"axis": "y", "angle": f"{angle} rad"}
    up = np.array([np.sin(angle), 0.0, np.cos(angle)])
    place = lambda height: " ".join(f"{1e3 * x:.12g}" for x in height * up) + " mm"
    sim = make({"table": {**TABLE, "pose": {"position": place(-0.01), "rotation": tilt}},
                "cube": cube(pose={"position": place(0.02), "rotation": tilt})},
               {"floor": {"between": ["cube", "table"], "friction": friction}})
    sim.run(duration=0.1)
    speed = sim.body("cube").velocity[:3] @ np.array([np.cos(angle), 0.0, -np.sin(angle)])
    slides = max(0.0, np.sin(angle) - friction * np.cos(angle))
    assert speed == pytest.approx(GRAVITY * slides * 0.1, rel=1e-3, abs=1e-7)
    assert sim.contact("floor").normal_force == pytest.approx(0.2 * GRAVITY * np.cos(angle), rel=1e-5)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_bodies_that_collide_exchange_momentum(friction):
    """The impact is off-centre, so both bodies rotate. Backward Euler loses angular momentum to first order in the step."""
    kept = []
    for step in (1.0, 0.25):
        sim = make({"still": cube(pose={"position": "0 0 0 mm"}),
                    "moving": cube(pose={"position": "-45 15 3 mm"}, velocity={"linear": "0.5 0.1 0 m/s"})},
                   {"touch": {"between": ["moving", "still"], "friction": friction}},
                   gravity="0 0 0 m/s^2", step=f"{step} ms")
        before = momenta(sim, "still", "moving")
        sim.run(duration=0.05)
        linear, angular, energy = momenta(sim, "still", "moving")
        assert sim.contact("touch").gap > -1e-5  # surfaces rotate within a step
        assert linear == pytest.approx(before[0], abs=1e-12)
        assert sim.body("still").velocity[0] > 0.05
        assert np.abs(sim.body("still").velocity[3:]).max() > 0.05
        assert energy < before[2]
        kept.append(np.abs(angular - before[1]).max() / np.linalg.norm(before[1]))
    assert kept[1] < 0.35 * kept[0] and kept[0] < 0.05


def test_a_soft_block_stands_on_a_cube_that_stands_on_a_table():
    sim = make({"block": soft_block(pose={"position": "-10 -10 40.1 mm"}), "cube": cube(), "table": TABLE},
               {"top": {"between": ["block", "cube"], "nodes": {"set": "z_min"}, "friction": 0.5},
                "floor": {"between": ["cube", "table"], "friction": 0.5}})
    sim.run(duration=1.0)
    block = sim.body("block").mass
    assert sim.contact("top").normal_force == pytest.approx(block * GRAVITY, rel=1e-5)
    assert sim.contact("floor").normal_force == pytest.approx((block + 0.2) * GRAVITY, rel=1e-5)
    assert sim.contact("top").force == pytest.approx([0, 0, block * GRAVITY], abs=1e-5 * GRAVITY)


def grasp(friction, mass, lift="20 mm"):
    """Two soft pads close on a cube that stands on a table, and lift it."""
    ramp = lambda to, start: {"ramp": {"to": to, "start": start, "duration": "0.2 s"}}
    pad = lambda at, push: soft_block(pose={"position": at}, fixed={"set": "x_min" if push[0] != "-" else "x_max"},
                                      motion={"x": ramp(push, "0 s"), "z": ramp(lift, "0.2 s")})
    sim = make({"left": pad("-41 -10 10 mm", "3 mm"), "right": pad("21 -10 10 mm", "-3 mm"),
                "cube": cube(mass=mass), "table": TABLE},
               {"left_pad": {"between": ["left", "cube"], "nodes": {"set": "x_max"}, "friction": friction},
                "right_pad": {"between": ["right", "cube"], "nodes": {"set": "x_min"}, "friction": friction},
                "floor": {"between": ["cube", "table"], "friction": 0.3}}, step="2 ms")
    sim.run(duration=0.2)
    squeeze = 0.5 * (sim.contact("left_pad").normal_force + sim.contact("right_pad").normal_force)
    sim.run(duration=1.0)
    return sim, squeeze


def test_a_squeeze_lifts_what_its_friction_can_carry():
    """Two pads with normal force N carry m g <= 2 mu N; the pull shears them, which reduces N by a tenth."""
    friction = 0.3
    _, squeeze = grasp(friction, "10 g", "0 mm")
    assert squeeze > 1.0
    limit = 2 * friction * squeeze / GRAVITY
    lifted, _ = grasp(friction, f"{0.75 * limit} kg")
    assert lifted.body("cube").position[2] > 0.03  # it slips while the pads accelerate
    assert lifted.contact("floor").normal_force == 0.0
    carried = sum(lifted.contact(name).force[2] for name in ("left_pad", "right_pad"))
    assert carried == pytest.approx(-0.75 * limit * GRAVITY, rel=1e-3)
    left, _ = grasp(friction, f"{1.1 * limit} kg")
    assert left.body("cube").position[2] < 0.025


LYING = {"axis": "y", "angle": "90 deg"}
ROUND = {  # shape, height of its centre when lying, rotation, I / (m r^2) about its axis
    "ball": ({"sphere": {"radius": "20 mm"}}, 20, None, 0.4),
    "roller": ({"cylinder": {"radius": "20 mm", "height": "60 mm"}}, 20, LYING, 0.5),
}


def rolling(name, angle, friction, step="1 ms", table=False):
    """Speed after 0.2 s of a round body on a slope that descends along +y: a plane of the world or a fixed box."""
    shape, height, rotation, inertia = ROUND[name]
    gravity = f"0 {GRAVITY * np.sin(angle)} {-GRAVITY * np.cos(angle)} m/s^2"
    bodies = {name: {"type": "rigid", "shape": shape, "mass": "100 g",
                     "pose": {"position": f"0 0 {height} mm", **({"rotation": rotation} if rotation else {})}}}
    contact = {"body": name, "surface": {"plane": {"point": "0 0 0 mm"}}, "friction": friction}
    if table:
        bodies["table"] = {**TABLE, "shape": {"box": "200 800 20 mm"}}
        contact = {"between": [name, "table"], "friction": friction}
    sim = make(bodies, {"floor": contact}, gravity=gravity, step=step)
    sim.run(duration=0.2)
    return sim, inertia


@pytest.mark.parametrize("table", [False, True])
@pytest.mark.parametrize("name", list(ROUND))
def test_a_round_body_rolls_down_a_slope(name, table):
    """Without slip a = g sin(angle) / (1 + I / (m r^2)), with angular velocity v / r."""
    sim, inertia = rolling(name, 0.3, 0.5, table=table)
    body = sim.body(name)
    speed = GRAVITY * np.sin(0.3) / (1 + inertia) * 0.2
    assert body.velocity[:3] == pytest.approx([0, speed, 0], abs=2e-3 * speed)
    assert body.velocity[3:] == pytest.approx([-speed / 0.02, 0, 0], abs=2e-3 * speed / 0.02)
    assert body.position[2] == pytest.approx(0.02, abs=1e-7)
    assert sim.contact("floor").normal_force == pytest.approx(0.1 * GRAVITY * np.cos(0.3), rel=1e-3)


@pytest.mark.parametrize("name", list(ROUND))
def test_a_round_body_slips_where_friction_is_too_small(name):
    """a = g (sin - mu cos), and the angular acceleration is mu g cos / (k r), k = I / (m r^2)."""
    friction = 0.05
    sim, inertia = rolling(name, 0.5, friction)
    body = sim.body(name)
    speed = GRAVITY * (np.sin(0.5) - friction * np.cos(0.5)) * 0.2
    spin = friction * GRAVITY * np.cos(0.5) / (inertia * 0.02) * 0.2
    assert body.velocity[1] == pytest.approx(speed, rel=2e-3)
    assert body.velocity[3] == pytest.approx(-spin, rel=5e-3)
    assert "slip" in sim.contact("floor").states and "stick" not in sim.contact("floor").states


@pytest.mark.parametrize("shape,height", [({"cylinder": {"radius": "15 mm", "height": "40 mm"}}, 20),
                                          ({"capsule": {"radius": "10 mm", "length": "40 mm"}}, None),
                                          ({"sphere": {"radius": "10 mm"}}, 10)])
def test_shapes_rest_on_a_table(shape, height):
    pose = {"position": f"0 0 {height or 10} mm", **({} if height else {"rotation": LYING})}
    sim = make({"it": {"type": "rigid", "shape": shape, "mass": "100 g", "pose": pose}, "table": TABLE},
               {"floor": {"between": ["it", "table"], "friction": 0.5}})
    sim.run(duration=0.3)
    assert sim.contact("floor").normal_force == pytest.approx(0.1 * GRAVITY, rel=1e-6)
    assert sim.body("it").position == pytest.approx([0, 0, (height or 10) * 1e-3], abs=1e-8)
    assert np.abs(sim.body("it").velocity).max() < 1e-6


def test_three_boxes_are_stacked():
    names = ["low", "middle", "high"]
    bodies = {name: cube(height=20.1 + 40.2 * k, mass=f"{100 * (k + 1)} g") for k, name in enumerate(names)}
    bodies["middle"]["pose"]["rotation"] = {"axis": "z", "angle": "45 deg"}
    sim = make({**bodies, "table": TABLE}, {
        "a": {"between": ["low", "table"], "friction": 0.5}, "b": {"between": ["low", "middle"], "friction": 0.5},
        "c": {"between": ["high", "middle"], "friction": 0.5}})
    sim.run(duration=0.3)
    carried = {"a": 0.6, "b": 0.5, "c": 0.3}
    for name, mass in carried.items():
        assert sim.contact(name).normal_force == pytest.approx(mass * GRAVITY, rel=1e-6)
    assert [sim.body(name).position[2] for name in names] == pytest.approx([0.02, 0.06, 0.1], abs=1e-7)


def test_edges_that_cross_hold_each_other():
    """A beam lies across the edge of another one: only edges touch, no vertices."""
    edge = {"axis": "x", "angle": "45 deg"}
    across = {"rotation": {"axis": "y", "angle": "45 deg"}}
    half = 5 * np.sqrt(2)
    sim = make({
        "under": {"type": "rigid", "shape": {"box": "100 10 10 mm"}, "fixed": True,
                  "pose": {"position": f"0 0 {-half} mm", "rotation": edge}},
        "over": {"type": "rigid", "shape": {"box": "10 100 10 mm"}, "mass": "50 g",
                 "pose": {"position": f"0 0 {half + 1} mm", **across}}},
        {"cross": {"between": ["over", "under"], "friction": 0.5}})
    sim.run(duration=0.05)
    assert sim.contact("cross").normal_force == pytest.approx(0.05 * GRAVITY, rel=1e-4)
    assert sim.body("over").position == pytest.approx([0, 0, half * 1e-3], abs=1e-6)


def test_balls_that_meet_share_their_momentum():
    """Inelastic impact: both bodies continue at the mean velocity."""
    ball = lambda x, **more: {"type": "rigid", "shape": {"sphere": {"radius": "10 mm"}}, "mass": "50 g",
                              "pose": {"position": f"{x} 0 0 mm"}, **more}
    sim = make({"a": ball(0, velocity={"linear": "1 0 0 m/s", "angular": "0 0 30 rad/s"}), "b": ball(30)},
               {"hit": {"between": ["a", "b"]}}, gravity="0 0 0 m/s^2")
    sim.run(duration=0.05)
    assert sim.body("a").velocity[:3] == pytest.approx([0.5, 0, 0], abs=1e-9)
    assert sim.body("b").velocity[:3] == pytest.approx([0.5, 0, 0], abs=1e-9)
    assert sim.body("a").velocity[5] == pytest.approx(30.0, rel=1e-9)  # without friction, it keeps its spin


def test_bodies_that_overlap_at_the_start_are_refused():
    with pytest.raises(sinew.Error) as error:
        make({"cube": cube(height=15), "table": TABLE}, {"floor": {"between": ["cube", "table"]}})
    assert error.value.kind == "out-of-range" and "0.005 m inside" in str(error.value)


def test_a_rigid_body_does_not_touch_itself():
    with pytest.raises(sinew.Error) as error:
        make({"cube": cube()}, {"touch": {"body": "cube", "between": ["cube", "cube"]}})
    assert error.value.kind in ("conflicting-keys", "unknown-key", "wrong-type")


def test_a_saved_state_goes_on_bit_for_bit():
    def scene():
        return make({"cube": cube(velocity={"linear": "0.3 0 0 m/s", "angular": "5 2 1 rad/s"}, height=35),
                     "table": TABLE}, {"floor": {"between": ["cube", "table"], "friction": 0.4}})
    sim = scene()
    sim.run(duration=0.05)
    other = scene()
    other.restore(sim.state())
    assert np.array_equal(sim.contact("floor").positions, other.contact("floor").positions)
    for _ in range(50):
        sim.step()
        other.step()
    assert sim.state() == other.state()


def heap(**more):
    ball = {"type": "rigid", "shape": {"sphere": {"radius": "10 mm"}}, "mass": "50 g"}
    return make({"low": {**ball, "pose": {"position": "0 0 11 mm"}}, "high": {**ball, "pose": {"position": "1 0 32 mm"}},
                 "table": TABLE, "wall": {**TABLE, "pose": {"position": "0 300 0 mm"}}},
                {"all": {"between": "all", "friction": 0.3, **more.pop("entry", {})}, **more.pop("contacts", {})}, **more)


def test_all_pairs_touch():
    """`between: all` omits pairs of fixed bodies, pairs connected by joints, pairs with their own entry, and exceptions."""
    assert set(heap().contacts) == {"all-low-high", "all-low-table", "all-high-table", "all-low-wall", "all-high-wall"}
    sim = heap(entry={"except": [["wall", "low"], ["high", "wall"]]}, contacts={"own": {"between": ["high", "low"], "friction": 0.1}})
    assert set(sim.contacts) == {"own", "all-low-table", "all-high-table"}
    assert sim.contact("own").friction == 0.1
    sim.run(duration=0.3)
    assert sum(sim.contact(f"all-{name}-table").normal_force for name in ("low", "high")) > 0.0
    # A pair excepted by one entry may belong to the next one.
    sim = heap(entry={"except": [["low", "high"]]}, contacts={"rest": {"between": "all", "friction": 0.7}})
    assert "all-low-high" not in sim.contacts and sim.contact("rest-low-high").friction == 0.7
    assert len(sim.contacts) == 5
    joined = heap(joints={"rod": {"type": "ball", "bodies": ["low", "high"], "point": "0 0 21 mm"}})
    assert "all-low-high" not in joined.contacts


def test_what_all_cannot_be_is_said():
    arm = {"type": "pcc", "segments": [{"length": "50 mm", "mass": "10 g", "stiffness": "0.02 N m"}]}
    with pytest.raises(sinew.Error) as error:
        make({"arm": arm, "cube": cube(height=80)}, {"all": {"between": "all"}})
    assert error.value.kind == "not-in-this-version" and "except: [[arm, arm], [arm, cube]]" in str(error.value)
    sim = make({"a": soft_block(), "cube": cube(height=80)}, {"all": {"between": "all", "except": [["a", "a"]]}})
    assert list(sim.contacts) == ["all-a-cube"]
    with pytest.raises(sinew.Error) as error:
        heap(contacts={"one": {"between": ["low", "high"]}, "two": {"between": ["high", "low"]}})
    assert error.value.kind == "conflicting-keys"
