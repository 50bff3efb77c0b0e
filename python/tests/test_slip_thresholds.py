"""Friction slightly below and slightly above the slip threshold."""

import numpy as np
import pytest
import sinew

G = 9.81


def block_on_a_slope(friction, integrator, on_box):
    angle = np.arctan(0.5)
    bodies = {"block": {"type": "rigid", "shape": {"box": "40 40 20 mm"}, "mass": 0.1, "pose": {"position": "0 0 10 mm"}}}
    contact = {"body": "block", "surface": {"plane": {}}}
    if on_box:
        bodies["slope"] = {"type": "rigid", "shape": {"box": "2000 400 20 mm"}, "fixed": True, "pose": {"position": "0 0 -10 mm"}}
        contact = {"between": ["block", "slope"]}
    return sinew.load({"sinew": 1, "time_step": "5 ms", "integrator": integrator, "gravity": [G * np.sin(angle), 0.0, -G * np.cos(angle)],
                       "bodies": bodies, "contacts": {"floor": {**contact, "friction": friction}}})  # fmt: skip


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
@pytest.mark.parametrize("on_box", [False, True])
def test_a_slope_of_one_half(integrator, on_box):
    rests = block_on_a_slope(0.505, integrator, on_box)
    rests.step(200)
    assert abs(rests.body("block").position[0]) < 1e-9 * 0.04
    # The net force is 1 % of the weight's component along the slope.
    slides = block_on_a_slope(0.495, integrator, on_box)
    slides.step(200)
    assert slides.body("block").velocity[0] == pytest.approx(G * 0.005 / np.sqrt(1.25), rel=1e-4)


@pytest.mark.parametrize("ratio", [0.99, 1.01])
def test_a_box_on_a_turntable_slips_beyond_its_friction(ratio):
    radius, friction = 0.1, 0.5
    rate = float(np.sqrt(ratio * friction * G / radius))
    sim = sinew.load({
        "sinew": 1, "time_step": "2 ms", "integrator": "backward-euler", "gravity": [0.0, 0.0, -G],
        "bodies": {
            "table": {"type": "rigid", "shape": {"cylinder": {"radius": 0.3, "height": 0.02}}, "pose": {"position": [0, 0, -0.01]},
                      "motion": {"axis": [0, 0, 1], "angle": {"ramp": {"to": rate, "duration": 1.0}}}},
            "box": {"type": "rigid", "shape": {"box": "4 4 2 mm"}, "density": 1000.0, "pose": {"position": [radius, 0, 0.001]},
                    "velocity": {"linear": [0, rate * radius, 0], "angular": [0, 0, rate]}},
        },
        "contacts": {"rest": {"between": ["box", "table"], "friction": friction}},
    })  # fmt: skip
    sim.step(150)
    out = np.hypot(*sim.body("box").position[:2]) - radius
    if ratio < 1.0:
        assert abs(out) < 1e-7 * radius
    else:
        # (ratio - 1) mu g t^2/2 = 2.2 mm, and more at larger radii; purely radial slip, cosh(w t), is an upper bound.
        start = 0.5 * 0.01 * friction * G * 0.3**2
        bound = 0.01 * friction * G / rate**2 * (np.cosh(0.3 * rate) - 1.0)
        assert 0.95 * start < out < bound
