"""Energy of a swinging beam by each integrator."""

import numpy as np
import sinew

from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Energy of a swinging beam"
SETUP = """A beam, 100 x 20 x 20 mm, E = 200 kPa, nu = 0.4, 1070 kg/m^3, clamped at one end and without damping, is released
under its weight. It swings for 0.4 s with each integrator and Newton's method. The quantity is the loss of energy (strain,
kinetic and gravity energy, zero at the start) relative to the largest kinetic energy, and its order over steps of 2 to 0.5
ms. Undamped motion conserves energy, so all loss is due to the integrator."""
SOURCES = {"theory": "orders of accuracy: 1 for backward Euler, 2 for BDF2 and generalized-alpha (Hairer, Wanner 1996; Chung, "
                     "Hulbert 1993), so that energy is lost at these orders or better"}
COST = 25
STEPS = (2e-3, 1e-3, 5e-4)
METHODS = {"backward Euler": "backward-euler", "BDF2": "bdf2",
           "generalized-alpha, 0.5": {"type": "generalized-alpha", "spectral_radius": 0.5},
           "generalized-alpha, 1": {"type": "generalized-alpha", "spectral_radius": 1.0}}


def swing(integrator, step):
    """Times, total energy / largest kinetic energy."""
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.81], "time_step": step, "integrator": integrator,
        "solver": {**SOLVER, "method": "newton", "tangent": "exact", "tolerance": 1e-9},
        "bodies": {"beam": {"type": "fem", "density": 1070.0, "fixed": [{"set": "x_min"}],
                            "material": {"young_modulus": 200e3, "poisson_ratio": 0.4},
                            "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02}}}})
    times, total, kinetic = [0.0], [0.0], [0.0]
    for _ in range(round(0.4 / step)):
        sim.step()
        body = sim.body("beam")
        times.append(sim.time)
        kinetic.append(body.kinetic_energy)
        total.append(body.strain_energy + body.kinetic_energy + body.gravity_energy)
    return np.array(times), np.array(total) / max(kinetic)


def run(case):
    figure, axis = plots.axes()
    for (name, integrator), colour in zip(METHODS.items(), (plots.OURS, plots.SECOND, plots.THIRD, plots.REFERENCE)):
        losses = []
        for step in STEPS:
            times, total = swing(integrator, step)
            losses.append(np.abs(total[len(total) // 2:]).mean())
            if step == STEPS[0]:
                axis.plot(times, 100 * total, color=colour, label=name)
        case.report(f"{name}: mean loss in the second half, 0.5 ms", 100 * losses[-1], unit="%", source="theory")
        order = observed_order(STEPS, losses)
        if name == "backward Euler":
            case.report(f"{name}: order of the loss", order, source="theory")
        else:
            case.check(f"{name}: order of the loss, at least 1.8", min(order, 1.8), 1.8, 1e-12, source="theory",
                       relative=False)
    axis.set(xlabel="time (s)", ylabel="energy / largest kinetic energy (%)")
    axis.legend()
    case.figure(figure, "Energy over time, steps of 2 ms: all loss is due to the integrator.")
