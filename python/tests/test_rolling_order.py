"""Order in time of contact between rigid shapes that roll, slide and spin on each other."""

import numpy as np
import pytest
import sinew
from scipy.integrate import solve_ivp

G, RADIUS, MASS = 9.81, 0.02, 0.1
SECOND_ORDER = ["bdf2", {"type": "generalized-alpha", "spectral_radius": 0.8}, "event-driven"]
NAMES = ["bdf2", "generalized-alpha", "event-driven"]


def load(bodies, contacts, step, integrator, gravity=(0.0, 0.0, -G), **more):
    return sinew.load({"sinew": 1, "gravity": list(gravity), "integrator": integrator, "time_step": step, "bodies": bodies,
                       "contacts": contacts, **more})


def ball(position=(0.0, 0.0, RADIUS), linear=(0.0, 0.0, 0.0), angular=(0.0, 0.0, 0.0)):
    return {"type": "rigid", "shape": {"sphere": {"radius": RADIUS}}, "mass": MASS, "pose": {"position": list(position)},
            "velocity": {"linear": list(linear), "angular": list(angular)}}


def fixed(shape, **pose):
    return {"type": "rigid", "shape": shape, "fixed": True, "pose": {"position": [0.0, 0.0, 0.0], **pose}}


def check_order(errors, least=1.7):
    assert np.log2(errors[-2] / errors[-1]) > least, errors


def roll_down(integrator, step, duration):
    """Velocity (6,) of a ball that rolls down 0.4 rad and spins about the normal, and the exact one."""
    incline, spin = 0.4, 50.0
    sim = load({"ball": ball(angular=(0.0, 0.0, spin))}, {"floor": {"body": "ball", "surface": {"plane": {}}, "friction": 0.8}}, step,
               integrator, (G * np.sin(incline), 0.0, -G * np.cos(incline)))
    sim.step(round(duration / step))
    speed = 5.0 / 7.0 * G * np.sin(incline) * duration
    return np.array(sim.body("ball").velocity), np.array([speed, 0.0, 0.0, 0.0, speed / RADIUS, spin]), np.array(sim.body("ball").position)


@pytest.mark.parametrize("integrator", SECOND_ORDER, ids=NAMES)
def test_a_ball_that_spins_about_the_normal_rolls_straight(integrator):
    """No moment acts about the normal, and friction acts along the slope: at the default step, it veers by less than 0.5 %."""
    velocity, exact, place = roll_down(integrator, 1e-2, 0.4)
    assert abs(velocity[1]) < 5e-3 * exact[0]
    assert abs(place[1]) < 5e-3 * place[0]
    assert abs(velocity[5] / exact[5] - 1.0) < 5e-3


@pytest.mark.parametrize("integrator", ["backward-euler", *SECOND_ORDER], ids=["backward-euler", *NAMES])
def test_a_skidding_ball_keeps_its_spin_about_the_vertical(integrator):
    """The direction of the slip is constant, and the contact point stays below the centre, so no moment acts about the vertical."""
    linear, angular, friction, duration = np.array([0.6, 0.3, 0.0]), np.array([20.0, 40.0, 50.0]), 0.2, 0.1
    sim = load({"ball": ball(linear=linear, angular=angular)}, {"floor": {"body": "ball", "surface": {"plane": {}}, "friction": friction}},
               5e-3, integrator)
    sim.step(round(duration / sim.time_step))
    slip = linear + np.cross(angular, [0.0, 0.0, -RADIUS])
    way = slip / np.linalg.norm(slip)
    velocity = np.array(sim.body("ball").velocity)
    assert np.allclose(velocity[:3], linear - friction * G * duration * way, atol=1e-2)
    assert abs(velocity[5] - 50.0) < 1e-6


def off_a_round_body(integrator, step, shape, rough, duration=0.2):
    """Error of the angle of a ball that rolls or slides off a round body, rad.

    (R + r) angle'' = k g sin(angle), k = 5/7 for rolling and 1 without friction.
    """
    radius, start = 0.1, 0.2
    shapes = {"world": None, "sphere": {"sphere": {"radius": radius}}, "cylinder": {"cylinder": {"radius": radius, "height": 0.4}},
              "capsule": {"capsule": {"radius": radius, "length": 0.4}}}
    far = radius + RADIUS
    bodies = {"ball": ball([far * np.sin(start), 0.0, far * np.cos(start)])}
    contact = {"friction": 0.9 if rough else 0.0}
    if shape == "world":
        contact |= {"body": "ball", "surface": {"sphere": {"centre": [0.0, 0.0, 0.0], "radius": radius}}}
    else:
        bodies["hill"] = fixed(shapes[shape], rotation={"axis": [1.0, 0.0, 0.0], "angle": np.pi / 2.0})
        contact["between"] = ["ball", "hill"]
    sim = load(bodies, {"touch": contact}, step, integrator)
    sim.step(round(duration / step))
    ratio = 5.0 / 7.0 if rough else 1.0
    exact = solve_ivp(lambda _, y: [y[1], ratio * G * np.sin(y[0]) / far], (0.0, duration), [start, 0.0], rtol=1e-11, atol=1e-13).y[0, -1]
    at = np.array(sim.body("ball").position)
    assert abs(np.hypot(at[0], at[2]) - far) < 1e-6
    return abs(np.arctan2(at[0], at[2]) - exact)


@pytest.mark.parametrize("rough", [True, False], ids=["rolls", "slides"])
@pytest.mark.parametrize("shape", ["world", "sphere", "cylinder", "capsule"])
@pytest.mark.parametrize("integrator", SECOND_ORDER, ids=NAMES)
def test_a_ball_moves_off_a_round_body_with_second_order(integrator, shape, rough):
    errors = [off_a_round_body(integrator, step, shape, rough) for step in (4e-3, 2e-3, 1e-3)]
    assert errors[-1] < 2e-4
    check_order(errors)


@pytest.mark.parametrize("integrator", SECOND_ORDER, ids=NAMES)
def test_two_free_balls_slide_on_each_other_with_second_order(integrator):
    """Forces press two balls together, which slide and turn about each other; reference: the same motion at a sixteenth of the step."""

    def place(step):
        bodies = {"one": ball([0.0, 0.0, RADIUS], linear=(0.3, 0.0, 0.0)), "two": ball([0.0, 0.0, -RADIUS], linear=(-0.3, 0.05, 0.0))}
        presses = {f"press_{name}": {"type": "force", "body": name, "point": [0.0, 0.0, at], "direction": [0.0, 0.0, 1.0],
                                     "command": {"force": force}} for name, at, force in (("one", RADIUS, -5.0), ("two", -RADIUS, 5.0))}
        sim = load(bodies, {"touch": {"between": ["one", "two"]}}, step, integrator, (0.0, 0.0, 0.0), actuators=presses)
        sim.step(round(0.024 / step))
        momentum = sum(np.array(sim.body(name).velocity[:3]) for name in ("one", "two"))
        assert np.allclose(momentum, [0.0, 0.05, 0.0], atol=1e-9)
        between = np.array(sim.body("one").position) - np.array(sim.body("two").position)
        assert abs(np.linalg.norm(between) - 2.0 * RADIUS) < (0.6 * step) ** 2 / (4.0 * RADIUS)  # what one step along the chord would open
        return between

    fine = place(0.125e-3)
    check_order([np.linalg.norm(place(step) - fine) for step in (2e-3, 1e-3, 0.5e-3)])


@pytest.mark.parametrize("other", ["ball", "disc"])
@pytest.mark.parametrize("integrator", SECOND_ORDER, ids=NAMES)
def test_a_body_that_rolls_leaves_others_alone(integrator, other):
    """Rolling is smooth: no integrator starts afresh, neither for the rolling body nor for a pendulum far away.

    Backward Euler for all bodies would change the velocity of the pendulum by 0.02.
    """

    def motion(rolling):
        shape = {"ball": {"sphere": {"radius": RADIUS}}, "disc": {"cylinder": {"radius": RADIUS, "height": 0.02}}}[other]
        turned = {"rotation": {"axis": [1.0, 0.0, 0.0], "angle": np.pi / 2.0}} if other == "disc" else {}
        bodies = {"bar": {"type": "rigid", "shape": {"box": [0.02, 0.02, 0.3]}, "mass": 0.2,
                          "pose": {"position": [3.0, 0.0, 0.85], "rotation": [0.0, 0.0, 0.0]}, "velocity": {"angular": [0.0, 4.0, 0.0],
                                                                                                            "linear": [-0.6, 0.0, 0.0]}}}
        contacts = {}
        if rolling:
            bodies["roller"] = {"type": "rigid", "shape": shape, "mass": MASS, "pose": {"position": [0.0, 0.0, RADIUS], **turned},
                                "velocity": {"linear": [0.2, 0.0, 0.0], "angular": [0.0, 10.0, 0.0]}}
            contacts = {"floor": {"body": "roller", "surface": {"plane": {}}, "friction": 0.5}}
        sim = load(bodies, contacts, 2e-3, integrator, joints={"hinge": {"type": "hinge", "bodies": ["world", "bar"], "point": [3.0, 0.0, 1.0],
                                                                         "axis": "y"}})
        sim.step(150)
        return np.array(sim.body("bar").velocity)

    assert np.allclose(motion(True), motion(False), rtol=0.0, atol=1e-5)  # iterations end at a residual of the whole scene


@pytest.mark.parametrize("integrator", SECOND_ORDER[:2], ids=NAMES[:2])
def test_an_impact_restarts_only_the_bodies_that_it_reaches(integrator):
    """A ball that falls on a table, and a pendulum that no force connects to it."""

    def bar(falling):
        bodies = {"bar": {"type": "rigid", "shape": {"box": [0.02, 0.02, 0.3]}, "mass": 0.2, "pose": {"position": [3.0, 0.0, 0.85]},
                          "velocity": {"angular": [0.0, 4.0, 0.0], "linear": [-0.6, 0.0, 0.0]}}, "table": fixed({"box": [0.2, 0.2, 0.02]})}
        if falling:
            bodies["ball"] = ball([0.0, 0.0, 0.04])
        sim = load(bodies, {"touch": {"between": ["ball", "table"]}} if falling else {}, 2e-3, integrator,
                   joints={"hinge": {"type": "hinge", "bodies": ["world", "bar"], "point": [3.0, 0.0, 1.0], "axis": "y"}})
        sim.step(80)
        return np.array(sim.body("bar").velocity)

    assert np.allclose(bar(True), bar(False), rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("integrator", SECOND_ORDER[:2], ids=NAMES[:2])
def test_a_state_between_restarts_continues_bit_for_bit(integrator):
    """Which bodies start afresh belongs to the state."""
    scene = {"bodies": {"ball": ball([0.0, 0.0, 0.03]), "other": ball([1.0, 0.0, 5.0], angular=(3.0, 2.0, 1.0))},
             "contacts": {"floor": {"body": "ball", "surface": {"plane": {}}, "friction": 0.3}}}
    sim = load(scene["bodies"], scene["contacts"], 2e-3, integrator)
    states = []
    for _ in range(40):
        sim.step()
        states.append(sim.state())
    for begin in range(10, 30):
        again = load(scene["bodies"], scene["contacts"], 2e-3, integrator)
        again.restore(states[begin])
        again.step(39 - begin)
        assert np.array_equal(again.body("other").velocity, sim.body("other").velocity)
        assert np.array_equal(again.body("ball").position, sim.body("ball").position)


@pytest.mark.parametrize("integrator", SECOND_ORDER[:2], ids=NAMES[:2])
def test_a_ball_on_a_turntable_has_second_order(integrator):
    """R. H. Romer, Am. J. Phys. 49 (1981) 985: a circle at 2/7 of the table's rate."""
    turn, at, speed = 7.0, np.array([0.1, 0.0]), np.array([0.05, 0.1])
    slip = turn * np.array([-at[1], at[0]]) - speed
    centre, radius = at + np.array([-speed[1], speed[0]]) * 3.5 / turn, np.linalg.norm(speed) * 3.5 / turn
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        rolling = ball([*at, RADIUS], [*speed, 0.0], [slip[1] / RADIUS, -slip[0] / RADIUS, 0.0])
        plate = {"type": "rigid", "shape": {"cylinder": {"radius": 0.5, "height": 0.02}}, "mass": 5.0, "pose": {"position": [0, 0, -0.01]},
                 "velocity": {"angular": [0, 0, turn]}}
        sim = load({"ball": rolling, "plate": plate}, {"touch": {"between": ["ball", "plate"], "friction": 0.8}}, step, integrator,
                   joints={"shaft": {"type": "hinge", "bodies": ["world", "plate"], "point": [0, 0, 0], "axis": "z"}},
                   actuators={"motor": {"type": "motor", "joint": "shaft", "command": {"velocity": turn}}})
        sim.step(round(1.0 / step))
        ahead = 2.0 / 7.0 * turn
        exact = centre + np.array([[np.cos(ahead), -np.sin(ahead)], [np.sin(ahead), np.cos(ahead)]]) @ (at - centre)
        errors.append(np.linalg.norm(np.array(sim.body("ball").position[:2]) - exact) / radius)
    assert errors[-1] < 1e-3
    check_order(errors)
