"""Virtual work: the work of the actuators equals the stored energy."""

import numpy as np
import sinew

from suite import plots
from suite.case import observed_order
from suite.robots import own_trunk

TITLE = "Virtual work: the sum of lambda . d delta equals the stored energy"
SETUP = """The trunk of examples/trunk is pulled quasi-statically by two cables (10 mm and 6 mm) and a lateral force on the
tip, through equilibria. The work of the actuators, by the trapezoidal rule over n steps, must converge to the strain energy
at the end, with second order in 1/n."""
SOURCES = {"work-energy": "C. Lanczos, The Variational Principles of Mechanics, 4th ed., Dover 1986, "
                          "chapter III (principle of virtual work)"}
COST = 2


def work_and_energy(steps):
    sim = sinew.load(own_trunk(tip_forces=True))
    names = ("long_0", "short_1", "tip_x")
    goal = {"long_0": 0.010, "short_1": 0.006, "tip_x": 0.2}
    work, before = 0.0, None
    for k in range(steps + 1):
        for name in names:
            actuator = sim.actuator(name)
            if name == "tip_x":
                actuator.force = goal[name] * k / steps
            else:
                actuator.displacement = goal[name] * k / steps
        sim.solve_static(tolerance=1e-11)
        now = []
        for name in sim.actuators:
            a = sim.actuator(name)
            now.append((a.force if name.startswith("tip") else a.tension, a.displacement))
        now = np.array(now)
        if before is not None:
            work += np.sum(0.5 * (now[:, 0] + before[:, 0]) * (now[:, 1] - before[:, 1]))
        before = now
    return work, sim.body("trunk").strain_energy


def run(case):
    counts = (4, 8, 16, 32)
    errors = []
    for steps in counts:
        work, energy = work_and_energy(steps)
        errors.append(abs(work - energy) / energy)
    case.check("work of the actuators, 32 steps", 1e3 * work, 1e3 * energy, 1e-3, unit="mJ",
               source="work-energy")
    case.check("order of the trapezoidal rule", observed_order([1 / n for n in counts], errors), 2.0,
               0.2, relative=False, source="work-energy")
    figure, axis = plots.axes()
    axis.loglog([1 / n for n in counts], errors, "o-", color=plots.OURS, label="|work - energy|")
    plots.slope_line(axis, [1 / n for n in counts], errors, 2)
    axis.set(xlabel="1 / steps", ylabel="relative error")
    axis.legend()
    case.figure(figure, "Work of the actuators compared with strain energy.")
