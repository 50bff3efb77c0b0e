"""Efforts that hold a motion: their accuracy in every integrator, and the spectral radii that would keep their errors."""

import numpy as np
import pytest
import sinew

G, LENGTH, MASS = 9.81, 0.3, 0.2
INERTIA = MASS * (LENGTH**2 + 0.02**2) / 12 + MASS * LENGTH**2 / 4  # about the hinge
ALPHA = "generalized-alpha"


def alpha(radius):
    return {"type": ALPHA, "spectral_radius": radius}


def bar(integrator, **more):
    return {"sinew": 1, "gravity": [0, 0, -G], "integrator": integrator, "time_step": 1e-3,
            "bodies": {"b": {"type": "rigid", "shape": {"box": [0.02, 0.02, LENGTH]}, "mass": MASS,
                             "pose": {"position": [0, 0, -LENGTH / 2]}}}, **more}


HINGE = {"j": {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": "y"}}
SWING = {"m": {"type": "motor", "joint": "j", "command": {"angle": {"sine": {"amplitude": 0.5, "period": 1.0}}}}}


def block(integrator, **more):
    return {"sinew": 1, "integrator": integrator, "time_step": 1e-3,
            "bodies": {"b": {"type": "fem", "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.1, "element_size": 0.02},
                             "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": 2e5, "poisson_ratio": 0.4},
                             "density": 1000.0, "damping": {"stiffness": 2e-3}, "fixed": [{"set": "z_min"}]}}, **more}


def cable(command):
    points = [[0.017, 0.01, z] for z in (0.0, 0.05, 0.1)]
    return {"c": {"type": "cable", "body": "b", "points": points, "command": command}}


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", alpha(0.8), alpha(0.95), "event-driven"])
def test_the_torque_of_a_motor_that_follows_a_sine(integrator):
    """Newton-Euler about the hinge: I a + m g L/2 sin(angle)."""
    sim = sinew.load(bar(integrator, joints=HINGE, actuators=SWING))
    torque = []
    for _ in range(1200):
        sim.step()
        torque.append(sim.actuator("m").torque)
    t = 1e-3 * np.arange(1, 1201)
    angle = 0.5 * np.sin(2 * np.pi * t)
    inertial = -INERTIA * (2 * np.pi) ** 2 * angle
    exact = inertial + MASS * G * LENGTH / 2 * np.sin(angle)
    error = np.abs(np.array(torque) - exact)[600:].max()
    if integrator in ("backward-euler", "event-driven"):
        # The acceleration of backward Euler, which event-driven steps use for commanded motions, is that of a step before: w h.
        assert error < 1.3 * 2 * np.pi * 1e-3 * np.abs(inertial).max()
    else:
        assert error < 3e-3 * np.abs(exact).max()


@pytest.mark.parametrize("radius", [0.96, 1.0])
def test_a_spectral_radius_that_keeps_errors_of_held_efforts_is_refused(radius):
    for scene in (bar(alpha(radius), joints=HINGE), block(alpha(radius), actuators=cable({"displacement": 1e-3}))):
        with pytest.raises(sinew.Error, match=r"integrator\.spectral_radius: it is .* or less") as caught:
            sinew.load(scene)
        assert caught.value.kind == "out-of-range"


def test_the_scene_names_the_place_of_the_radius(tmp_path):
    path = tmp_path / "bar.yaml"
    path.write_text("sinew: 1\nintegrator: {type: generalized-alpha, spectral_radius: 1}\n"
                    "bodies: {b: {type: rigid, shape: {box: 20 20 300 mm}, mass: 200 g}}\n"
                    "joints: {elbow: {type: ball, bodies: [world, b], point: 0 0 150 mm}}\n")
    with pytest.raises(sinew.Error, match=r"bar\.yaml:2:\d+: integrator\.spectral_radius: it is 1, but joint 'elbow' holds a motion"):
        sinew.load(path)


def test_robots_without_held_motions_keep_a_radius_of_one_until_one_is_commanded():
    sim = sinew.load(block(alpha(1.0), actuators=cable({"tension": 0.2})))
    sim.step(20)
    assert sim.report.status == "solved"
    with pytest.raises(sinew.Error, match="the command of 'c' holds a motion"):
        sim.actuator("c").displacement = 1e-3
    sim.step(20)
    assert sim.actuator("c").tension == pytest.approx(0.2)
