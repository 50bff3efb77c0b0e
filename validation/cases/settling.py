"""A neo-Hookean trunk whose cable is pulled settles at its static equilibrium."""

import numpy as np
import sinew

from suite import plots
from suite.robots import own_trunk

TITLE = "A neo-Hookean trunk settles"
SETUP = """The trunk of examples/trunk has a neo-Hookean material (E = 450 kPa, nu_0 = 0.45) and eight cables, no gravity, and
backward Euler steps of 10 ms. One long cable is pulled by 5, 10, 15 or 20 mm at its rate limit of
100 mm/s while the others are slack, without damping and with 0.1 s of stiffness damping. After 8 s the tip must be within
0.05 mm of the equilibrium found by Newton's method, without lasting oscillation. With large pulls the cables' geometric
stiffness matters; simulators without it have been seen to diverge here."""
SOURCES = {"statics": "Simulation.solve_static() of the same body and pull, from the end of the run"}
COST = 25
PULLS = (5, 10, 15, 20)  # mm
STEPS, LAST = 800, 50


def pulled(pull, damping):
    """Tip positions (steps, 3) in m of a run, and in static equilibrium."""
    scene = own_trunk()
    scene["integrator"] = "backward-euler"
    body = scene["bodies"]["trunk"]
    body["material"] = {"model": "neo-hookean", "young_modulus": 450e3, "poisson_ratio": 0.45}
    body["damping"] = {"stiffness": damping}
    sim = sinew.load(scene)
    sim.actuator("long_0").displacement = 1e-3 * pull
    tips = np.empty((STEPS, 3))
    for k in range(STEPS):
        sim.step()
        tips[k] = sim.effector("tip").position
    sim.solve_static()
    return tips, np.array(sim.effector("tip").position)


def run(case):
    figure, axis = plots.axes()
    times = 0.01 * np.arange(1, STEPS + 1)
    for damping, style in ((0.0, "-"), (0.1, "--")):
        for pull in PULLS:
            tips, rest = pulled(pull, damping)
            apart = 1e3 * np.linalg.norm(tips - rest, axis=1)
            what = f"{pull} mm, {'damped' if damping else 'undamped'}"
            case.bound(f"{what}: distance of the tip from its equilibrium after 8 s", apart[-1], 0.05, unit="mm",
                       source="statics")
            case.bound(f"{what}: largest motion of the tip in the last 0.5 s",
                       1e3 * np.ptp(tips[-LAST:], axis=0).max(), 0.05, unit="mm", source="statics")
            axis.semilogy(times, np.maximum(apart, 1e-9), style, label=what)
    axis.set(xlabel="time (s)", ylabel="distance of the tip from its equilibrium (mm)")
    axis.legend(fontsize=7)
    case.figure(figure, "Distance of the tip from its equilibrium over time.")
