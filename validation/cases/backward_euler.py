"""Backward Euler: free fall to rounding, and the energy loss of a pendulum."""

import numpy as np
import sinew

from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Backward Euler: free fall, and the decay of a pendulum"
SETUP = """- A free block falls for 1 s at 10 ms. The discrete solution is v_n = -g h n, z_n = -g h^2 n (n + 1)/2.
- A stiff slender block hangs from one edge (a hinge) and swings from 0.5 rad. Its numerical loss of energy is compared with
  that of a rigid block under the same method, which acts on positions, x_f = x_i + h v_f. Virtual work with x = R(theta) X
  gives for the rotations D of two successive steps I (2 sin D_f - sin(D_f + D_i)) = -h^2 m g r sin(theta_f), and the kinetic
  energy is I (1 - cos D)/h^2. Backward Euler in the coordinate theta would lose less, because it would not see the
  centripetal part of the acceleration."""
SOURCES = {"Hairer 1996": "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd "
                          "ed., Springer 1996, section IV.3, doi:10.1007/978-3-642-05221-7"}
COST = 3
G = 9.81


def fall(case):
    h, n = 0.01, 100
    sim = sinew.load({
        "sinew": 1, "time_step": h, "integrator": "backward-euler", "gravity": [0, 0, -G],
        "solver": dict(SOLVER),
        "bodies": {"block": {"type": "fem", "density": 1000,
                             "mesh": {"shape": "block", "length": 0.04, "width": 0.02,
                                      "height": 0.02},
                             "material": {"young_modulus": 1e5, "poisson_ratio": 0.3}}}})
    sim.step(n)
    body = sim.body("block")
    moved = np.array(body.positions) - np.array(body.rest_positions)
    expected = -G * h * h * n * (n + 1) / 2
    case.identity("height after 1 s, every node", np.abs(moved[:, 2] / expected - 1).max(), 1e-11,
                  source="Hairer 1996")
    case.identity("speed after 1 s, every node",
                  np.abs(np.array(body.velocities)[:, 2] / (-G * h * n) - 1).max(), 1e-11,
                  source="Hairer 1996")


def swing(h, duration):
    """Energy (J) over time of the block, and of the rigid pendulum by the same method."""
    length, side, tilt = 0.1, 0.02, 0.5
    gravity = [G * np.sin(tilt), 0.0, -G * np.cos(tilt)]  # the block hangs along -z at theta = 0
    sim = sinew.load({
        "sinew": 1, "time_step": h, "integrator": "backward-euler", "gravity": gravity,
        "solver": {**SOLVER, "method": "newton", "tangent": "exact"},
        "bodies": {"block": {"type": "fem", "density": 1000,
                             "mesh": {"shape": "block", "length": side, "width": side,
                                      "height": length, "element_size": 0.01},
                             "mass_matrix": "consistent",
                             "material": {"young_modulus": 5e8, "poisson_ratio": 0.3},
                             "fixed": [{"box": [-1e-6, -1, length - 1e-6, 1e-6, 1,
                                                length + 1e-6]}]}}})
    body = sim.body("block")
    times, energy = [0.0], [0.0]
    for k in range(round(duration / h)):
        sim.step()
        times.append(sim.time)
        energy.append(body.kinetic_energy + body.gravity_energy + body.strain_energy)
    # The hinge is the edge x = 0, z = length; the centre of mass is at (side/2, -length/2) relative to it.
    mass = 1000 * side * side * length
    arm = np.hypot(side / 2, length / 2)
    inertia = mass * (side**2 + length**2) / 3
    start = np.arctan2(side / 2, length / 2)  # angle of the centre of mass from -z
    down = np.arctan2(gravity[0], -gravity[2])  # direction of gravity, as an angle from -z
    potential = mass * G * arm
    angle, turn, level = start, 0.0, []
    for _ in range(round(duration / h)):
        new = turn
        for _ in range(50):
            residual = inertia * (2 * np.sin(new) - np.sin(new + turn)) + h * h * potential * np.sin(
                angle + new - down)
            slope = inertia * (2 * np.cos(new) - np.cos(new + turn)) + h * h * potential * np.cos(
                angle + new - down)
            new -= residual / slope
        angle, turn = angle + new, new
        level.append(inertia * (1 - np.cos(turn)) / h**2
                     - potential * (np.cos(angle - down) - np.cos(start - down)))
    scale = mass * G * arm * (1 - np.cos(start - down))
    return np.array(times), np.array(energy) / scale, np.array([0.0] + level) / scale


def run(case):
    fall(case)
    steps = (4e-3, 2e-3, 1e-3)
    losses, rigid_losses = [], []
    figure, axis = plots.axes()
    for h, colour in zip(steps, (plots.THIRD, plots.SECOND, plots.OURS)):
        times, energy, rigid = swing(h, 1.0)
        losses.append(-energy[-1])
        rigid_losses.append(-rigid[-1])
        axis.plot(times, energy, color=colour, label=f"h = {1e3 * h:g} ms")
        axis.plot(times, rigid, "--", color=plots.REFERENCE, lw=1)
        case.check(f"energy lost in 1 s / swing energy, h = {1e3 * h:g} ms", -energy[-1],
                   -rigid[-1], 0.05, source="Hairer 1996")
    case.check("order of the loss in h", observed_order(steps, losses),
               observed_order(steps, rigid_losses), 0.02, relative=False, source="Hairer 1996",
               remark="tends to 1 as h tends to 0; here the losses are large")
    axis.plot([], [], "--", color=plots.REFERENCE, lw=1, label="rigid pendulum, same method")
    axis.set(xlabel="time (s)", ylabel="energy / swing energy")
    axis.legend()
    case.figure(figure, "Energy of the swinging block and of the rigid pendulum.")
