"""Bodies that a limit of a joint or a cable stops: inelastic impacts in every integrator."""

import numpy as np
import pytest
import sinew

G, LENGTH, MASS = 9.81, 0.3, 0.2
INTEGRATORS = ["backward-euler", "bdf2", *({"type": "generalized-alpha", "spectral_radius": rho} for rho in (0.0, 0.5, 0.8, 0.95))]
in_every_integrator = pytest.mark.parametrize("integrator", INTEGRATORS, ids=lambda i: i if isinstance(i, str) else f"alpha-{i['spectral_radius']}")


def statuses(sim, steps, read):
    rows, found = [], set()
    for _ in range(steps):
        sim.step()
        rows.append(read())
        found.add(sim.report.status)
    return np.array(rows), found


@in_every_integrator
def test_a_bar_stays_at_the_stop_of_its_hinge(integrator):
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -G], "integrator": integrator, "time_step": 1e-3,
                      "bodies": {"b": {"type": "rigid", "shape": {"box": [0.02, 0.02, LENGTH]}, "mass": MASS,
                                       "pose": {"position": [-np.sin(0.8) * LENGTH / 2, 0, -np.cos(0.8) * LENGTH / 2],
                                                "rotation": {"axis": "y", "angle": 0.8}}}},
                      "joints": {"j": {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": "y",
                                       "limits": {"angle": {"min": -0.5, "max": 1.0}}}}})
    angle, found = statuses(sim, 400, lambda: sim.joint("j").angle)
    assert angle.min() > -0.5 - 1e-9
    assert (angle[200:] < -0.5 + 1e-9).all()
    assert found == {"solved"}


@in_every_integrator
def test_a_weight_that_falls_into_a_rope_hangs_on_it(integrator):
    rope = {"type": "cable", "body": "b", "points": [{"body": "w", "point": [0, 0, 0.01]}, {"body": "b", "point": [0, 0, -0.3]}],
            "command": {"displacement": -0.05}}
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -G], "integrator": integrator, "time_step": 1e-3,
                      "bodies": {"w": {"type": "rigid", "shape": {"box": [0.02] * 3}, "mass": 1.0, "fixed": True, "pose": {"position": [0, 0, 0.01]}},
                                 "b": {"type": "rigid", "shape": {"sphere": {"radius": 0.02}}, "mass": 0.3, "pose": {"position": [0, 0, -0.3]}}},
                      "actuators": {"c": rope}})
    rows, found = statuses(sim, 300, lambda: (sim.body("b").position[2], sim.body("b").velocity[2], sim.actuator("c").tension))
    height, speed, tension = rows.T
    assert height.min() > -0.35 - 1e-9
    assert speed.min() > -np.sqrt(2 * G * 0.05) - 0.02
    assert np.abs(height[110:] + 0.35).max() < 1e-9
    assert tension[-1] == pytest.approx(0.3 * G, rel=1e-4)
    assert found == {"solved"}


@in_every_integrator
def test_a_pendulum_on_a_rope_that_is_drawn_in_gains_no_speed(integrator):
    """The rope may slacken for a step while efforts settle; the bob does not jump off it."""
    draw = {"displacement": {"sine": {"mean": 0.02, "amplitude": 0.02, "period": 0.6, "phase": -np.pi / 2}}}
    rope = {"type": "cable", "body": "b", "points": [{"body": "w", "point": [0, 0, 0.01]}, {"body": "b", "point": [0.1, 0, -0.3]}], "command": draw}
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -G], "integrator": integrator, "time_step": 1e-3,
                      "bodies": {"w": {"type": "rigid", "shape": {"box": [0.02] * 3}, "mass": 1.0, "fixed": True, "pose": {"position": [0, 0, 0.01]}},
                                 "b": {"type": "rigid", "shape": {"sphere": {"radius": 0.02}}, "mass": 0.3, "pose": {"position": [0.1, 0, -0.3]}}},
                      "actuators": {"c": rope}})
    wanted, found = statuses(sim, 700, lambda: 0.02 - 0.02 * np.cos(2 * np.pi * sim.time / 0.6) - sim.actuator("c").displacement)
    assert np.abs(wanted[300:]).max() < 1e-4
    assert found == {"solved"}
