"""Event-driven impacts of rigid bodies, with restitution."""

import numpy as np
import pytest
import sinew

GRAVITY = 9.81
FLOOR = {"plane": {"point": "0 0 0 mm", "normal": "0 0 1"}}
BALL = {"type": "rigid", "shape": {"sphere": {"radius": "50 mm"}}, "mass": "2 kg", "pose": {"position": "0 0 550 mm"}}
BLOCK = {"type": "fem", "density": 1000.0, "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.02, "element_size": 0.01},
         "material": {"young_modulus": "200 kPa", "poisson_ratio": 0.3}}


def make(bodies, contacts, step=20e-3, restitution=0.5, gravity=(0.0, 0.0, -GRAVITY), **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": {"type": "event-driven", "restitution": restitution},
                       "gravity": list(gravity), "bodies": bodies, "contacts": contacts, **more})


def ball_on_floor(step=20e-3, restitution=0.5, **contact):
    return make({"ball": BALL}, {"floor": {"body": "ball", "surface": FLOOR, **contact}}, step, restitution)


@pytest.mark.parametrize("restitution", [0.5, 0.9])
@pytest.mark.parametrize("step", [2e-3, 20e-3])
def test_a_ball_comes_to_rest_in_time(restitution, step):
    first = np.sqrt(2 * 0.5 / GRAVITY)
    end = first * (1 + restitution) / (1 - restitution)
    steps = int(np.ceil(end / step))
    for part, rests in ((0.999, False), (1.001, True)):
        sim = ball_on_floor(part * end / steps, restitution)
        for _ in range(steps):
            sim.step()
        body = sim.body("ball")
        speed = np.hypot(body.velocity[2], np.sqrt(2 * GRAVITY * max(body.position[2] - 0.05, 0.0)))
        assert (speed < 1e-6) == rests


def test_the_restitution_of_a_contact_is_its_own():
    sim = make({"low": BALL, "high": {**BALL, "pose": {"position": "1 0 0.55 m"}}},
               {"floor": {"body": "low", "surface": FLOOR, "restitution": 0.25}, "other": {"body": "high", "surface": FLOOR}}, 5e-3, 0.75)
    first, impacts = np.sqrt(2 * 0.5 / GRAVITY), 0
    while not impacts:
        sim.step()
        impacts = sim.report.impacts
    for name, restitution in (("low", 0.25), ("high", 0.75)):
        expected = restitution * GRAVITY * first - GRAVITY * (sim.time - first)
        assert sim.body(name).velocity[2] == pytest.approx(expected, abs=1e-9)


def test_balls_head_on_keep_momentum_and_return_e_of_their_approach():
    left = {**BALL, "pose": {"position": "-200 0 0 mm"}, "velocity": {"linear": "3 0 0 m/s"}}
    right = {**BALL, "mass": "1 kg", "pose": {"position": "100 0 0 mm"}, "velocity": {"linear": "-1 0 0 m/s"}}
    sim = make({"left": left, "right": right}, {"pair": {"between": ["left", "right"]}}, restitution=0.6, gravity=(0, 0, 0))
    sim.run(duration=0.2)
    u, v = sim.body("left").velocity[0], sim.body("right").velocity[0]
    assert 2 * u + v == pytest.approx(5.0, abs=1e-9)
    assert v - u == pytest.approx(0.6 * 4.0, abs=1e-9)


def test_a_state_between_rebounds_goes_on_bit_for_bit(tmp_path):
    sim = ball_on_floor(restitution=0.9)
    sim.run(duration=1.0)
    sim.save_state(tmp_path / "flight.state")
    copy = sim.clone()
    other = ball_on_floor(restitution=0.9)
    other.load_state(tmp_path / "flight.state")
    for one in (sim, copy, other):
        one.run(duration=6.0)
    assert sim.state_hash == copy.state_hash == other.state_hash
    sim.reset()
    sim.run(duration=7.0)
    assert sim.state_hash == copy.state_hash


def test_a_state_of_another_restitution_is_refused(tmp_path):
    ball_on_floor(restitution=0.9).save_state(tmp_path / "one.state")
    with pytest.raises(sinew.Error, match="contact 'floor'"):
        ball_on_floor(restitution=0.8).load_state(tmp_path / "one.state")


def test_bodies_beside_a_deformable_one():
    sim = make({"ball": BALL, "other": {**BALL, "pose": {"position": "1 0 0.3 m"}},
                "block": {**BLOCK, "damping": {"stiffness": "2 ms"}}},
               {"all": {"between": "all", "restitution": 0.5}, "floor": {"body": "ball", "surface": FLOOR},
                "next": {"body": "other", "surface": FLOOR, "restitution": 0.0},
                "ground": {"body": "block", "surface": {"plane": {"point": "0 0 -10 mm"}}}}, 2e-3)
    sim.run(duration=1.2)
    assert not sim.report.flagged
    for name in ("ball", "other"):
        assert sim.body(name).position[2] == pytest.approx(0.05, abs=1e-8)
    assert sim.contact("ground").normal_force == pytest.approx(0.008 * GRAVITY, rel=1e-3)


@pytest.mark.parametrize(("change", "kind"), [
    ({"solver": {"adaptive": {"smallest": "1 ms"}}}, "not-in-this-version"),
    ({"solver": "one-linearisation"}, "not-in-this-version"),
    ({"integrator": {"type": "bdf2", "restitution": 0.5}}, "conflicting-keys"),
    ({"integrator": {"type": "event-driven", "restitution": 1.5}}, "out-of-range"),
    ({"integrator": "bdf2", "contacts": {"floor": {"body": "ball", "surface": FLOOR, "restitution": 0.5}}}, "conflicting-keys"),
    ({"contacts": {"floor": {"body": "ball", "surface": FLOOR, "motion": {"z": {"steps": [[0, 0], [0.1, 0.001]]}}}}}, "conflicting-keys"),
    ({"bodies": {"ball": BLOCK}, "contacts": {"floor": {"body": "ball", "surface": {"plane": {"point": "0 0 -20 mm"}}, "restitution": 0.5}}},
     "conflicting-keys"),
])
def test_what_cannot_be_combined_is_refused(change, kind):
    scene = {"sinew": 1, "integrator": {"type": "event-driven", "restitution": 0.5}, "bodies": {"ball": BALL},
             "contacts": {"floor": {"body": "ball", "surface": FLOOR}}}
    sinew.load(scene)
    with pytest.raises(sinew.Error) as error:
        sinew.load({**scene, **change})
    assert error.value.kind == kind


def test_the_example_comes_to_rest():
    sim = sinew.load("examples/rigid/bounce.yaml")
    impacts = 0
    for _ in range(200):
        sim.step()
        impacts += sim.report.impacts
    assert impacts > 10
    assert sim.body("ball").position[2] == pytest.approx(0.03, abs=1e-8)
    assert sim.contact("floor").normal_force == pytest.approx(0.1 * GRAVITY, rel=1e-6)


def test_a_robot_with_a_limited_cable_goes_on_from_a_state_bit_for_bit():
    """Regression: whether a part of a step is smooth depended on rows that a state does not contain."""
    sim = sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": "event-driven", "gravity": "-3 0 -5 m/s^2",
        "bodies": {"link": {"type": "rigid", "shape": {"box": "60 20 10 mm"}, "density": "1000 kg/m^3",
                            "pose": {"position": "30 8 48 mm"}}},
        "joints": {"hinge": {"type": "hinge", "bodies": ["link", "world"], "point": "0 8 48 mm", "axis": "0 1 0"}},
        "actuators": {"cable": {"type": "cable", "body": "link", "pull": "body", "points": ["3 14 47 mm", "30 14 47.1 mm", "57 12.8 47 mm"],
                                "limits": {"tension": {"max": "5 N"}, "displacement": {"min": "-10 mm", "max": "8 mm"}},
                                "command": {"tension": {"ramp": {"to": "0.4 N", "duration": "40 ms"}}}}},
    })  # fmt: skip
    sim.step(3)
    other = sim.clone()
    for _ in range(4):
        sim.step()
        other.step()
        assert sim.state() == other.state()


@pytest.mark.parametrize("use", ["surface", "convex"])
def test_a_mesh_bounces_on_a_lift(tmp_path, use):
    (tmp_path / "brick.obj").write_text(
        "\n".join(f"v {x} {y} {z}" for x in (-0.03, 0.03) for y in (-0.02, 0.02) for z in (-0.01, 0.01))
        + "\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")  # fmt: skip
    mesh = {"file": "brick.obj", "unit": "m", "use": use}
    sim = sinew.load(
        {"sinew": 1, "gravity": [0, 0, -GRAVITY], "time_step": "10 ms", "integrator": {"type": "event-driven", "restitution": 0.6},
         "bodies": {"brick": {"type": "rigid", "mesh": mesh, "density": 1000.0, "pose": {"position": [0, 0, 0.11]}},
                    "lift": {"type": "rigid", "mesh": {**mesh, "scale": [2, 2, 1]}, "fixed": True, "pose": {"position": [0, 0, -0.01]},
                             "motion": {"z": {"ramp": {"to": "2 m", "duration": "10 s"}}}}},
         "contacts": {"all": {"between": "all", "friction": 0.3}}}, folder=tmp_path)  # fmt: skip
    first = (-0.2 + np.sqrt(0.04 + 2 * GRAVITY * 0.1)) / GRAVITY
    impacts = 0
    while not impacts:
        sim.step()
        impacts = sim.report.impacts
    approach = GRAVITY * first + 0.2
    assert sim.body("brick").velocity[2] == pytest.approx(0.2 + 0.6 * approach - GRAVITY * (sim.time - first), abs=1e-5)
    copy = sim.clone()
    for one in (sim, copy):
        one.run(duration=1.0)
    assert sim.state_hash == copy.state_hash
    assert sim.body("brick").position[2] == pytest.approx(sim.body("lift").position[2] + 0.02, abs=1e-6)
    assert sim.body("lift").position[2] == pytest.approx(0.2 * sim.time - 0.01, abs=1e-12)
    assert sim.body("brick").velocity[2] == pytest.approx(0.2, abs=1e-7)


def test_a_step_that_looks_at_contacts_leaves_no_linearisation():
    sim = ball_on_floor()
    sim.step()
    with pytest.raises(sinew.Error, match="event-driven integration ended it"):
        sim.last_linearisation()
    assert sim.linearise(statics=False).rows == []


@pytest.mark.parametrize("spin, step", [(10.0, 20e-3), (100.0, 20e-3), (400.0, 20e-3), (1000.0, 5e-3), (1000.0, 20e-3), (3000.0, 5e-3)])
def test_hinges_hold_whatever_turns_in_a_step(spin, step):
    """A double pendulum that turns by 0.2 to 20 rad in a step: its hinges stay where they are, and no step gains energy."""
    def rod(at, turn, speed):
        return {"type": "rigid", "shape": {"box": [0.2, 0.01, 0.01]}, "mass": 0.1, "pose": {"position": [at, 0, 0]},
                "velocity": {"angular": [0, 0, turn], "linear": [0, speed, 0]}}

    sim = sinew.load({
        "sinew": 1, "time_step": step, "integrator": "event-driven", "gravity": [0, 0, -GRAVITY],
        "bodies": {"near": rod(0.1, spin, 0.1 * spin), "far": rod(0.3, -spin, 0.1 * spin)},
        "joints": {"ground": {"type": "hinge", "bodies": ["world", "near"], "point": [0, 0, 0], "axis": [0, 0, 1]},
                   "elbow": {"type": "hinge", "bodies": ["near", "far"], "point": [0.2, 0, 0], "axis": [0, 0, 1]}}})
    for _ in range(20):
        sim.step()
        assert not sim.report.flagged
        near, far = sim.body("near"), sim.body("far")
        elbow = 2.0 * np.array(near.position)
        assert np.linalg.norm(near.position) == pytest.approx(0.1, abs=1e-8)
        assert np.linalg.norm(far.position - elbow) == pytest.approx(0.1, abs=1e-8)
