"""Stiffness damping resists strain, but not rotation."""

import numpy as np
import pytest
import sinew


def spin_after(time, element, material, stiffness, tension):
    """Spin (rad/s) of a free block that starts at 5 rad/s, with a tendon between two points of the block."""
    # The tendon pulls from the first moment. The error of the integrator in the angular momentum of the damped body is 1.6 % at time steps
    # of 1 ms, 0.4 % at 0.5 ms and 0.1 % at 0.25 ms.
    sim = sinew.load({
        "sinew": 1, "time_step": "0.5 ms", "integrator": "bdf2",
        "bodies": {"block": {
            "type": "fem", "element": element, "material": material, "density": "1000 kg/m^3",
            "mesh": {"shape": "block", "length": "60 mm", "width": "20 mm", "height": "20 mm", "element_size": "10 mm"},
            "damping": {"stiffness": stiffness}, "velocity": {"angular": "0 0 5 rad/s"}}},
        "actuators": {"tendon": {"type": "cable", "body": "block", "pull": "body", "command": {"tension": tension},
                                 "points": ["10 10 10 mm", "50 10 10 mm"]}}})
    sim.run(duration=time)
    body = sim.body("block")
    arms = body.positions - body.positions.mean(axis=0)
    turning = arms[:, 0] * body.velocities[:, 1] - arms[:, 1] * body.velocities[:, 0]
    return turning.sum() / (arms[:, :2] ** 2).sum()


@pytest.mark.parametrize("element", ["hex8", "tet10", "tet4-patch"])
@pytest.mark.parametrize("tension", ["0 N", "5 N"])
def test_a_strained_body_keeps_its_spin(element, tension):
    free = spin_after(0.3, element, "dragon-skin-30", "0 s", tension)
    damped = spin_after(0.3, element, "dragon-skin-30", "10 ms", tension)
    assert damped == pytest.approx(free, rel=0.01) and free == pytest.approx(5.0, rel=0.05)


@pytest.mark.parametrize("tension", ["0 N", "5 N"])
def test_a_strained_corotational_body_keeps_its_spin(tension):
    material = {"model": "corotational", "young_modulus": "600 kPa", "poisson_ratio": 0.4}
    free = spin_after(0.3, "tet4", material, "0 s", tension)
    damped = spin_after(0.3, "tet4", material, "10 ms", tension)
    assert damped == pytest.approx(free, rel=0.01) and free == pytest.approx(5.0, rel=0.05)


def test_it_damps_as_rayleigh_says():
    # A released beam vibrates in its first mode, which decays at the rate beta omega^2 / 2.
    def peaks(stiffness):
        sim = sinew.load({
            "sinew": 1, "time_step": "1 ms", "integrator": "bdf2",
            "bodies": {"beam": {
                "type": "fem", "element": "hex8", "density": "1000 kg/m^3", "fixed": {"set": "x_min"},
                "material": {"model": "neo-hookean", "young_modulus": "1 MPa", "poisson_ratio": 0.3},
                "mesh": {"shape": "block", "length": "100 mm", "width": "10 mm", "height": "10 mm", "element_size": "5 mm"},
                "damping": {"stiffness": stiffness}}},
            "actuators": {"push": {"type": "force", "body": "beam", "point": "100 5 5 mm", "direction": "0 0 1",
                                   "command": {"force": "1 mN"}}}})
        tip = np.argmax(sim.body("beam").positions[:, 0])
        rest = sim.body("beam").positions[tip, 2]
        sim.solve_static()
        sim.actuator("push").force = 0.0
        bent = []
        for _ in range(800):
            sim.step()
            bent.append(sim.body("beam").positions[tip, 2] - rest)
        tops = [k for k in range(1, 799) if bent[k] > max(0.0, bent[k - 1]) and bent[k] >= bent[k + 1]][:3]
        return 1e-3 * np.array(tops), np.log([bent[k] for k in tops])

    times, heights = peaks("0 s")
    omega, own = 2 * np.pi / np.diff(times).mean(), -np.polyfit(times, heights, 1)[0]
    rate = -np.polyfit(*peaks("2 ms"), 1)[0]
    assert rate - own == pytest.approx(2e-3 * omega**2 / 2, rel=0.05)
