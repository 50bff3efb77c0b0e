"""A neo-Hookean trunk whose cable is pulled settles where statics say."""

import numpy as np
import sinew

from suite import plots
from suite.robots import own_trunk

TITLE = "A neo-Hookean trunk settles"
SETUP = """The trunk of examples/trunk of a neo-Hookean material (E 450 kPa, nu_0 0.45), eight cables, no
gravity, backward Euler at 10 ms; one long cable is pulled by 5, 10, 15 or 20 mm at its rate limit of
100 mm/s while the others are slack, without damping and with 0.1 s of stiffness damping. One linearisation
a step. After 8 s the tip must stand where Newton's method finds the equilibrium, within 0.05 mm, without
lasting oscillation. Large pulls make the cables' geometric stiffness matter; simulators without it have been
seen to diverge here."""
SOURCES = {"statics": "Simulation.solve_static() of the same body and pull, from the end of the run"}
COST = 25
PULLS = (5, 10, 15, 20)  # mm
STEPS, LAST = 800, 50


def pulled(pull, damping):
    """Tip positions (steps, 3) m of a run, and where statics put it."""
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
            what = f"{pull} mm, {'damped' if damping else 'not damped'}"
            case.bound(f"{what}: tip from its equilibrium after 8 s", apart[-1], 0.05, unit="mm",
                       source="statics")
            case.bound(f"{what}: largest motion of the tip in the last 0.5 s",
                       1e3 * np.ptp(tips[-LAST:], axis=0).max(), 0.05, unit="mm", source="statics")
            axis.semilogy(times, np.maximum(apart, 1e-9), style, label=what)
    axis.set(xlabel="time (s)", ylabel="tip from its equilibrium (mm)")
    axis.legend(fontsize=7)
    case.figure(figure, "Distance of the tip from its equilibrium over time.")
