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


def swing_torques(steps):
    """I a, and with it the moment of the weight, of a bar that swings by 0.5 sin(2 pi t), at the ends of steps of 1 ms."""
    angle = 0.5 * np.sin(2 * np.pi * 1e-3 * np.arange(1, steps + 1))
    inertial = -INERTIA * (2 * np.pi) ** 2 * angle
    return inertial, inertial + MASS * G * LENGTH / 2 * np.sin(angle)


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", alpha(0.8), alpha(0.95), "event-driven"])
def test_the_torque_of_a_motor_that_follows_a_sine(integrator):
    """Newton-Euler about the hinge: I a + m g L/2 sin(angle)."""
    sim = sinew.load(bar(integrator, joints=HINGE, actuators=SWING))
    torque = []
    for _ in range(1200):
        sim.step()
        torque.append(sim.actuator("m").torque)
    inertial, exact = swing_torques(1200)
    error = np.abs(np.array(torque) - exact)[600:].max()
    if integrator == "backward-euler":  # its acceleration is that of a step before: w h
        assert error < 1.3 * 2 * np.pi * 1e-3 * np.abs(inertial).max()
    elif integrator == "event-driven":  # the mean of a step: the torque h/2 before its end
        assert error < 0.51e-3 * np.abs(np.diff(exact)).max() / 1e-3
    else:
        assert error < 3e-3 * np.abs(exact).max()


def ended(command, seconds, **more):
    sim = sinew.load(bar("event-driven", joints=HINGE, actuators={"m": {"type": "motor", "joint": "j", "command": command, **more}}))
    rows = []
    for _ in range(round(seconds / 1e-3)):
        sim.step()
        rows.append((sim.time, sim.actuator("m").torque, sim.joint("j").angle))
        assert sim.report.status == "solved"
    return sim, np.array(rows)


def test_event_driven_efforts_of_a_commanded_motion_are_means_of_second_order():
    errors = []
    for h in (4e-3, 2e-3, 1e-3):
        sim = sinew.load({**bar("event-driven", joints=HINGE, actuators=SWING), "time_step": h})
        rows = []
        for _ in range(round(1.2 / h)):
            sim.step()
            rows.append((sim.time - h / 2, sim.actuator("m").torque))
        t, torque = np.array(rows).T
        angle = 0.5 * np.sin(2 * np.pi * t)
        exact = -INERTIA * (2 * np.pi) ** 2 * angle + MASS * G * LENGTH / 2 * np.sin(angle)
        errors.append(np.abs(torque - exact)[len(t) // 2:].max())
    assert errors[-1] < 1e-4 * 0.0225  # N m, of the amplitude
    assert 3.5 < errors[0] / errors[1] < 4.5 and 3.5 < errors[1] / errors[2] < 4.5


def test_event_driven_motions_reach_commands_with_corners_limits_and_velocities():
    for command, angle in (({"angle": {"ramp": {"to": 0.4, "start": 0.0505, "duration": 0.1}}}, 0.4), ({"angle": 0.3}, 0.3),
                           ({"velocity": 1.5}, 0.3)):
        sim, rows = ended(command, 0.2)
        assert rows[-1, 2] == pytest.approx(angle, abs=1e-9)
        still = MASS * G * LENGTH / 2 * np.sin(angle)
        assert rows[-1, 1] == pytest.approx(still, rel=5e-3)
    # A ramp needs no torque but that of the weight, from the second step after its corner on.
    sim, rows = ended({"angle": {"ramp": {"to": 0.4, "start": 0.0505, "duration": 0.1}}}, 0.14)
    late = rows[rows[:, 0] > 0.0535]
    assert np.allclose(late[:, 1], MASS * G * LENGTH / 2 * np.sin(late[:, 2] - 2e-3), rtol=0, atol=1e-4)
    # A motor that is too weak for its command stalls.
    sim, rows = ended(SWING["m"]["command"], 0.6, limits={"torque": {"min": -0.01, "max": 0.01}})
    assert np.abs(rows[:, 1]).max() <= 0.01 + 1e-12


def test_event_driven_commands_of_a_script_in_every_step():
    sim = sinew.load(bar("event-driven", joints=HINGE, actuators={"m": {"type": "motor", "joint": "j", "command": {"angle": 0.0}}}))
    torque = []
    for k in range(1, 1001):
        sim.actuator("m").angle = 0.5 * np.sin(2 * np.pi * 1e-3 * k)
        sim.step()
        torque.append(sim.actuator("m").torque)
    inertial, exact = swing_torques(1000)
    error = np.abs(np.array(torque) - exact)[500:].max()
    assert error < 1.3 * 2 * np.pi * 1e-3 * np.abs(inertial).max()  # of backward Euler


def test_event_driven_work_of_a_motor_is_the_energy_of_its_bar():
    """After the first step, in which the motor sets the resting bar in motion at once."""
    sim = sinew.load(bar("event-driven", joints=HINGE, actuators=SWING))

    def energy(t):
        angle, rate = 0.5 * np.sin(2 * np.pi * t), np.pi * np.cos(2 * np.pi * t)
        return 0.5 * INERTIA * rate**2 + MASS * G * LENGTH / 2 * (1 - np.cos(angle))

    sim.step(50)
    work = sim.ledger["actuator_work"]
    sim.step(825)
    assert sim.ledger["actuator_work"] - work == pytest.approx(energy(0.875) - energy(0.05), rel=1e-4)
