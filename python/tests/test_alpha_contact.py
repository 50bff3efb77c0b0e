"""Generalized-alpha with contacts: impacts create no energy; second order while the set of touching points is constant."""

import numpy as np
import pytest
import sinew


def mechanical(sim):
    return sum(sim.ledger[name] for name in ("kinetic_energy", "strain_energy", "gravity_energy"))


ALPHA = {"type": "generalized-alpha", "spectral_radius": 0.9}
RUBBER = {"model": "neo-hookean", "young_modulus": "300 kPa", "poisson_ratio": 0.4}


@pytest.mark.parametrize("step", ["1 ms", "4 ms"])
@pytest.mark.parametrize("soft", [True, False])
def test_a_tumbling_block_never_has_more_energy_than_at_its_start(soft, step):
    motion = {"linear": "0.3 0 0 m/s", "angular": "3 2 0 rad/s"}
    block = ({"type": "fem", "element": "hex8", "material": RUBBER, "density": "1000 kg/m^3", "pose": {"position": "-20 -20 5 mm"},
              "mesh": {"shape": "block", "length": "40 mm", "width": "40 mm", "height": "20 mm", "element_size": "10 mm"},
              "velocity": motion} if soft else
             {"type": "rigid", "shape": {"box": "40 40 20 mm"}, "mass": "32 g", "pose": {"position": "0 0 15 mm"}, "velocity": motion})
    sim = sinew.load({"sinew": 1, "time_step": step, "integrator": ALPHA, "gravity": "0 0 -9.81 m/s^2", "bodies": {"block": block},
                      "contacts": {"floor": {"body": "block", "surface": {"plane": {}}, "friction": 0.4}}})
    start = mechanical(sim)
    for _ in range(int(0.5 / sim.time_step)):
        sim.step()
        assert mechanical(sim) <= start
    assert sim.contact("floor").normal_force == pytest.approx(0.032 * 9.81, rel=0.02)


def test_a_sliding_box_stops_where_coulomb_says():
    sim = sinew.load({"sinew": 1, "time_step": "1 ms", "integrator": ALPHA, "gravity": "0 0 -9.81 m/s^2",
                      "bodies": {"box": {"type": "rigid", "shape": {"box": "40 30 20 mm"}, "mass": "100 g",
                                         "pose": {"position": "0 0 10 mm"}, "velocity": {"linear": "0.5 0 0 m/s"}}},
                      "contacts": {"floor": {"body": "box", "surface": {"plane": {}}, "friction": 0.4}}})
    sim.run(duration=0.3)
    assert sim.body("box").position[0] == pytest.approx(0.5**2 / (2 * 0.4 * 9.81), rel=2e-3)
    assert np.abs(sim.body("box").velocity).max() < 1e-9


def sheared(integrator, step):
    """A block that hangs from its top and rests on a smooth floor, pushed to and fro."""
    push = {"type": "force", "body": "block", "point": "40 10 10 mm", "direction": "-1 0 0",
            "command": {"force": {"sine": {"amplitude": "40 mN", "frequency": "8 Hz"}}}}
    sim = sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": "0 0 -9.81 m/s^2",
                      "bodies": {"block": {"type": "fem", "element": "hex8", "fixed": {"set": "z_max"}, "density": "1000 kg/m^3",
                                           "mesh": {"shape": "block", "length": "40 mm", "width": "20 mm", "height": "20 mm",
                                                    "element_size": "10 mm"},
                                           "material": {**RUBBER, "young_modulus": "20 kPa"}}},
                      "contacts": {"floor": {"body": "block", "surface": {"plane": {}}, "nodes": {"set": "z_min"}}},
                      "actuators": {"push": push}})
    sim.solve_static()
    sim.step(round(0.1 / step))
    assert (np.array(sim.contact("floor").normal_forces) > 0).all()
    return sim.body("block").positions.copy()


def test_errors_fall_with_the_square_of_the_step():
    exact = sheared(ALPHA, 5e-5)
    coarse, fine = (np.abs(sheared(ALPHA, step) - exact).max() for step in (1e-3, 5e-4))
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.25)
    assert fine < 0.5 * np.abs(sheared("bdf2", 5e-4) - exact).max()
