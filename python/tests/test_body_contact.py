"""Contact of bodies with the shape of a rigid body that moves."""

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


def test_a_cube_falls_on_a_table_and_rests():
    sim = make({"table": TABLE, "cube": cube(height=25)}, {"floor": {"between": ["cube", "table"], "friction": 0.5}})
    sim.run(duration=0.2)
    floor = sim.contact("floor")
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
    """Off the centre, so that both turn; a backward Euler step loses spin at its order, a millisecond."""
    kept = []
    for step in (1.0, 0.25):
        sim = make({"still": cube(pose={"position": "0 0 0 mm"}),
                    "moving": cube(pose={"position": "-45 15 3 mm"}, velocity={"linear": "0.5 0.1 0 m/s"})},
                   {"touch": {"between": ["moving", "still"], "friction": friction}},
                   gravity="0 0 0 m/s^2", step=f"{step} ms")
        before = momenta(sim, "still", "moving")
        sim.run(duration=0.05)
        linear, angular, energy = momenta(sim, "still", "moving")
        assert sim.contact("touch").gap > -1e-5  # surfaces turn within a step
        assert linear == pytest.approx(before[0], abs=1e-12)
        assert sim.body("still").velocity[0] > 0.05
        assert np.abs(sim.body("still").velocity[3:]).max() > 0.05
        assert energy < before[2]
        kept.append(np.abs(angular - before[1]).max() / np.linalg.norm(before[1]))
    assert kept[1] < 0.35 * kept[0] and kept[0] < 0.05


def test_a_soft_block_stands_on_a_cube_that_stands_on_a_table():
    sim = make({"block": soft_block(position="-10 -10 40.1 mm"), "cube": cube(), "table": TABLE},
               {"top": {"between": ["block", "cube"], "nodes": {"set": "z_min"}, "friction": 0.5},
                "floor": {"between": ["cube", "table"], "friction": 0.5}})
    sim.run(duration=0.6)
    block = sim.body("block").mass
    assert sim.contact("top").normal_force == pytest.approx(block * GRAVITY, rel=1e-5)
    assert sim.contact("floor").normal_force == pytest.approx((block + 0.2) * GRAVITY, rel=1e-5)
    assert sim.contact("top").force == pytest.approx([0, 0, block * GRAVITY], abs=1e-5 * GRAVITY)


def grasp(friction, mass, lift="20 mm"):
    """Two soft pads close on a cube that stands on a table, and lift it."""
    ramp = lambda to, start: {"ramp": {"to": to, "start": start, "duration": "0.2 s"}}
    pad = lambda at, push: soft_block(position=at, fixed={"set": "x_min" if push[0] != "-" else "x_max"},
                                      base={"x": ramp(push, "0 s"), "z": ramp(lift, "0.2 s")})
    sim = make({"left": pad("-41 -10 10 mm", "3 mm"), "right": pad("21 -10 10 mm", "-3 mm"),
                "cube": cube(mass=mass), "table": TABLE},
               {"left_pad": {"between": ["left", "cube"], "nodes": {"set": "x_max"}, "friction": friction},
                "right_pad": {"between": ["right", "cube"], "nodes": {"set": "x_min"}, "friction": friction},
                "floor": {"between": ["cube", "table"], "friction": 0.3}}, step="2 ms")
    sim.run(duration=0.2)
    squeeze = 0.5 * (sim.contact("left_pad").normal_force + sim.contact("right_pad").normal_force)
    sim.run(duration=0.6)
    return sim, squeeze


def test_a_squeeze_lifts_what_its_friction_can_carry():
    """Two pads with normal force N carry m g <= 2 mu N; the pull shears them, and N falls by a tenth."""
    friction = 0.3
    _, squeeze = grasp(friction, "10 g", "0 mm")
    assert squeeze > 1.0
    limit = 2 * friction * squeeze / GRAVITY
    lifted, _ = grasp(friction, f"{0.75 * limit} kg")
    assert lifted.body("cube").position[2] > 0.03  # it slips while the pads get up to speed
    assert lifted.contact("floor").normal_force == 0.0
    carried = sum(lifted.contact(name).force[2] for name in ("left_pad", "right_pad"))
    assert carried == pytest.approx(-0.75 * limit * GRAVITY, rel=1e-3)
    left, _ = grasp(friction, f"{1.1 * limit} kg")
    assert left.body("cube").position[2] < 0.025
