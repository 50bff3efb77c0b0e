"""Static friction, and a lower coefficient of kinetic friction."""

import numpy as np
import pytest
import sinew

GRAVITY = 9.81
STATIC, KINETIC = 0.5, 0.3
HALF = 0.01  # m, half of the box's height


def box(**more):
    return {"type": "rigid", "shape": {"box": [0.04, 0.04, 2.0 * HALF]}, "mass": "1 kg",
            "pose": {"position": [0, 0, HALF]}, **more}


def soft_box():
    return {"type": "fem", "density": 1000.0, "material": {"young_modulus": "1 MPa", "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.02, "element_size": 0.01}}


def make(body, step="1 ms", integrator="bdf2", gravity="0 0 -9.81 m/s^2", floor=None, **more):
    floor = {"body": "box", "surface": {"plane": {}}, "friction": STATIC, "kinetic_friction": KINETIC, **(floor or {})}
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": gravity,
                       "bodies": {"box": body}, "contacts": {"floor": floor}, **more})


def test_both_coefficients_are_told():
    sim = make(box())
    assert (sim.contact("floor").friction, sim.contact("floor").kinetic_friction) == (STATIC, KINETIC)
    same = make(box(), floor={"kinetic_friction": STATIC})
    assert same.contact("floor").kinetic_friction == STATIC


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
@pytest.mark.parametrize("slope", [0.4, 0.2])
def test_a_box_on_a_slope_stays_until_it_is_moved(slope, integrator):
    angle = np.arctan(slope)
    gravity = [GRAVITY * np.sin(angle), 0.0, -GRAVITY * np.cos(angle)]
    resting = make(box(), integrator=integrator, gravity=gravity)
    resting.run(duration=0.2)
    assert abs(resting.body("box").position[0]) < 1e-9
    assert set(resting.contact("floor").states) <= {"stick", "open"}
    # Once it slides, the kinetic coefficient applies: on a slope between the two coefficients it accelerates.
    start = 0.3
    moved = make(box(velocity={"linear": [start, 0, 0]}), integrator=integrator, gravity=gravity)
    slows = GRAVITY * (np.sin(angle) - KINETIC * np.cos(angle))
    time = 0.1
    moved.run(duration=time)
    assert moved.body("box").velocity[0] == pytest.approx(start + slows * time, rel=2e-3)
    normal, friction = moved.contact("floor").normal_force, moved.contact("floor").friction_force
    assert friction == pytest.approx(KINETIC * normal, rel=1e-6)


def test_a_box_that_has_stopped_holds_with_the_higher_coefficient():
    pull = {"type": "force", "body": "box", "point": [0, 0, HALF], "direction": [1, 0, 0], "command": {"force": "4 N"}}
    sim = make(box(velocity={"linear": [-0.2, 0, 0]}), actuators={"pull": pull})
    sim.run(duration=0.3)  # friction and force both decelerate it
    stays = float(sim.body("box").position[0])
    assert stays == pytest.approx(-0.2**2 / (2.0 * (KINETIC * GRAVITY + 4.0)), rel=0.02)
    sim.run(duration=0.2)  # 4 N is between kinetic friction, 2.9 N, and static friction, 4.9 N
    assert sim.body("box").position[0] == pytest.approx(stays, abs=1e-9)
    sim.actuator("pull").force = 5.0
    sim.run(duration=0.1)
    assert sim.body("box").velocity[0] == pytest.approx(0.1 * (5.0 - KINETIC * GRAVITY), rel=0.03)


def stick_slip(step, integrator):
    """Positions over 3 s of a box on a belt that is held by a spring."""
    sim = make(box(), step=step, integrator=integrator, floor={"motion": {"x": {"ramp": {"to": 4.0 * BELT, "duration": 4.0}}}},
               actuators={"spring": {"type": "spring", "body": "box", "pull": "world",
                                     "points": [[-1.0, 0, HALF], [0, 0, HALF]], "stiffness": 100.0, "free_length": 1.0}})
    seen = []
    for _ in range(round(3.0 / step)):
        sim.step()
        seen.append(float(sim.body("box").position[0]))
    return np.array(seen)


BELT = 0.1  # m/s


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2"])
def test_stick_slip_has_its_closed_form(integrator):
    """The box sticks to the belt up to x_1 = mu_s m g/k. It then slides and oscillates about x_0 = mu_k m g/k with initial
    velocity v, x = x_0 + (x_1 - x_0) cos wt + v/w sin wt, until its velocity is v again, at x_0 - (x_1 - x_0)."""
    step, natural = 2.5e-4 if integrator == "backward-euler" else 1e-3, 10.0
    seen = stick_slip(step, integrator)
    upper, lower = STATIC * GRAVITY / 100.0, KINETIC * GRAVITY / 100.0
    settled = seen[round(1.0 / step):]
    assert settled.min() == pytest.approx(lower - np.hypot(upper - lower, BELT / natural), rel=0.03)
    assert settled.max() == pytest.approx(lower + np.hypot(upper - lower, BELT / natural), rel=0.03)
    slip = (2.0 * np.pi - 2.0 * np.arctan2((upper - lower) * natural, BELT)) / natural
    period = slip + 2.0 * (upper - lower) / BELT
    rises = 1.0 + step * np.flatnonzero((settled[:-1] < lower) & (settled[1:] >= lower))
    assert np.diff(rises) == pytest.approx(period, rel=0.02)


def test_a_state_goes_on_sliding_bit_for_bit():
    sim = make(box(velocity={"linear": [0.5, 0.1, 0]}))
    sim.run(duration=0.05)
    state = sim.state()
    sim.run(duration=0.1)
    other = make(box(velocity={"linear": [0.5, 0.1, 0]}))
    other.restore(state)
    other.run(duration=0.1)
    assert np.array_equal(other.body("box").position, sim.body("box").position)


@pytest.mark.parametrize("more", [{}, {"aggregate": "20 mm"}])
def test_a_soft_block_slides_by_the_lower_coefficient(more):
    # Suddenly applied gravity makes the block slip below the static coefficient, so 0.2 g is well below it.
    sim = make(soft_box(), gravity=[0.2 * GRAVITY, 0.0, -GRAVITY], floor=more, integrator="backward-euler")
    sim.run(duration=0.3)
    assert np.linalg.norm(sim.body("box").velocities, axis=1).max() < 1e-6
    push = make(soft_box(), gravity=[0.6 * GRAVITY, 0.0, -GRAVITY], floor=more, integrator="backward-euler")
    push.run(duration=0.2)
    floor = push.contact("floor")
    loaded = floor.normal_forces > 0.1 * floor.normal_forces.max()
    slides = np.array(floor.states)[loaded] == "slip"
    ratios = np.linalg.norm(floor.friction_forces, axis=1)[loaded] / floor.normal_forces[loaded]
    assert slides.all()
    assert ratios == pytest.approx(KINETIC, rel=1e-6)


@pytest.mark.parametrize("kinetic", [0.6, 0.0, -0.1])
def test_a_kinetic_coefficient_above_the_static_one_is_refused(kinetic):
    with pytest.raises(sinew.Error) as error:
        make(box(), floor={"kinetic_friction": kinetic})
    assert error.value.kind == "out-of-range"
    assert "kinetic" in str(error.value)


def test_a_step_tells_how_far_its_contacts_are_from_their_laws():
    sim = make(box(velocity={"linear": [0.5, 0.1, 0]}))
    table = sim.run(duration=0.01)
    report = sim.report
    assert 0.0 <= report.contact_residual < 1e-9
    assert 0.0 <= report.contact_signorini < 1e-12
    assert 0.0 <= report.contact_coulomb < 1e-12
    assert 0.0 <= report.contact_complementarity < 1e-12
    for name in ("contact_residual", "contact_signorini", "contact_coulomb"):
        assert table[name][-1] == getattr(report, name), name
