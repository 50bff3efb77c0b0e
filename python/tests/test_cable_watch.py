"""Simulation.run() warns of cables as `sinew run` does, and a watched run has the same bits as single steps."""

import warnings

import numpy as np
import pytest
import sinew


def beam(to, **cable):
    return sinew.load({
        "sinew": 1, "time_step": "100 ms", "integrator": "quasi-static", "gravity": "0 0 0 m/s^2",
        "bodies": {"beam": {"type": "fem", "element": "hex8", "density": 1000.0, "fixed": [{"set": "x_min"}],
                            "material": {"model": "neo-hookean", "young_modulus": "200 kPa", "poisson_ratio": 0.45},
                            "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01}}},
        "actuators": {"pull": {"type": "cable", "body": "beam", "points": ["0 10 16 mm", "100 10 16 mm"], "guide_radius": "4 mm",
                               "command": {"displacement": {"ramp": {"to": to, "duration": "1 s"}}}, **cable}}})


def test_a_slack_cable_is_warned_of_once():
    sim = beam("-12 mm")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim.run(0.0)
        sim.run(0.5)  # too short to say anything
    with pytest.warns(sinew.SinewWarning, match=r"cable 'pull' is slack in all 10 steps: its displacement of -12 mm.*\[slack-cable\]"):
        sim.run(1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim.run(1.0)


def test_a_bowstring_is_warned_of():
    sim, stepped = beam("5 mm"), beam("5 mm")
    with pytest.warns(sinew.SinewWarning, match=r"like a bowstring.*guide_spacing: 10 mm \[bowstring\]"):
        sim.run(1.0)
    stepped.step(10)
    assert np.array_equal(sim.body("beam").positions, stepped.body("beam").positions)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        beam("5 mm", guide_spacing="10 mm").run(1.0)
