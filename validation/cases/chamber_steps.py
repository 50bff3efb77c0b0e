"""Chambers: independence of the time step, and the gas law."""

import numpy as np
import sinew

from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Chambers do not depend on the time step"
SETUP = """A tube with inner and outer radius 10 and 15 mm and height 30 mm is held at both ends. It has 96 neo-Hookean
hexahedra (mu = 24 kPa, nu_0 = 0.49) and stiffness damping of 5 ms; its bore is a chamber.

- **Steady state**: the pressure rises to 2 kPa in 0.1 s, or in 20 quasi-static steps. The volume gained after 0.3 s, or 40
  quasi-static steps, is compared for steps of 10 us to 10 ms, with one linearisation each.
- **Transient**: the chamber holds air (isothermal) that enters through a valve. The volume at 40 ms is compared with a run
  with 16 times smaller steps (Newton's method). The supply is integrated by backward Euler, whichever method integrates the
  body.
- **Gas law**: air is let in, and the stiffness of the body changes with the pressure. p (V/v)^n keeps its value at rest."""
SOURCES = {"itself": "the same robot with other steps",
           "polytropic": "p V^n constant for a given amount; n = 1 isothermal, 1.4 adiabatic air"}
COST = 45


def tube(step, integrator, gas=None, method="one-linearisation"):
    air = {"type": "chamber", "body": "tube", "surface": {"set": "inner"}, "cap": True}
    if gas is not None:
        air["gas"] = gas
    return sinew.load({
        "sinew": 1, "time_step": step, "integrator": integrator,
        "solver": {**SOLVER, "method": method, "tolerance": 1e-9},
        "bodies": {"tube": {
            "type": "fem", "element": "hex8", "density": 1070.0, "damping": {"stiffness": 0.005},
            "material": {"model": "neo-hookean", "shear_modulus": 24e3, "poisson_ratio": 0.49},
            "mesh": {"shape": "hollow-cylinder", "inner_radius": 0.01, "outer_radius": 0.015, "height": 0.03,
                     "element_size": 0.006},
            "fixed": [{"set": "bottom"}, {"set": "top"}]}},
        "actuators": {"air": air}})


def run(case):
    steps = (1e-2, 1e-3, 1e-4, 1e-5)
    for integrator in ("quasi-static", "backward-euler", {"type": "generalized-alpha", "spectral_radius": 0.5}):
        name = integrator if isinstance(integrator, str) else "generalized-alpha"
        reached = []
        for step in steps if name == "backward-euler" else steps[:3]:
            sim = tube(step, integrator)
            still = name == "quasi-static"
            sim.actuator("air").pressure = sinew.Ramp(0.0, 2000.0, duration=20 * step if still else 0.1)
            sim.step(40 if still else round(0.3 / step))
            reached.append(sim.actuator("air").volume_growth)
        case.bound(f"{name}: volume gained in the steady state, relative spread for steps of 10 ms to "
                   f"{1e6 * steps[len(reached) - 1]:.0f} us", np.ptp(reached) / np.mean(reached), 1e-3, source="itself")
    supply = {"supply": {"conductance": 2e-9, "critical_ratio": 0.3}}
    figure, (left, right) = plots.axes(2)
    sizes = (4e-3, 2e-3, 1e-3, 5e-4)
    for integrator, colour in (("backward-euler", plots.OURS), ("bdf2", plots.SECOND)):
        def after(step):
            sim = tube(step, integrator, supply, "newton")
            sim.actuator("air").pressure = 3000.0
            sim.step(round(0.04 / step))
            return sim.actuator("air").volume_growth
        exact = after(sizes[-1] / 16)
        errors = [abs(after(step) / exact - 1) for step in sizes]
        case.check(f"{integrator}, fed through a valve: order of the transient", observed_order(sizes[1:], errors[1:]),
                   1.0, 0.15, source="itself", relative=False)
        left.loglog([1e3 * s for s in sizes], errors, "o-", color=colour, label=integrator)
    plots.slope_line(left, [1e3 * s for s in sizes], errors, 1)
    left.set(xlabel="time step (ms)", ylabel="relative error of the volume gained")
    left.legend()
    for exponent, colour in ((1.0, plots.OURS), (1.4, plots.SECOND)):
        sim = tube(0.01, "quasi-static", {"polytropic_exponent": exponent, "dead_volume": 2e-6})
        air = sim.actuator("air")
        rest, volumes, pressures, worst = air.volume + 2e-6, [], [], 0.0
        for share in np.linspace(0.005, 0.06, 12):
            air.gas = share * rest
            sim.solve_static()
            volume = air.volume + 2e-6
            pressure = air.pressure + 101325.0
            worst = max(worst, abs(pressure * (volume / (rest * (1 + share))) ** exponent / 101325.0 - 1))
            volumes.append(1e6 * volume)
            pressures.append(1e-3 * air.pressure)
        case.bound(f"gas of exponent {exponent:g}: p (V/v)^n against that at rest", worst, 1e-8, source="polytropic")
        right.plot(volumes, pressures, "o-", color=colour, label=f"n = {exponent:g}")
    right.set(xlabel="volume of the gas (ml)", ylabel="pressure above ambient (kPa)")
    right.legend()
    case.figure(figure, "Convergence of the transient; pressure and volume while gas is let in.")
