"""The published conical arm contracted by its cables."""

import numpy as np
import sinew

from suite import plots
from suite.case import REPOSITORY

TITLE = "Conical arm of Ecoflex 00-30 contracted by cables"
SETUP = """The arm of examples/arm/conical.yaml hangs under gravity, or is free of gravity. Its cables are 10 mm (base) to 5
mm (tip) from the axis. Two opposite cables, or all four, are ramped to 2 N each in 1 s. Backward Euler at 10 ms, Ogden's law,
hexahedra of 6.5 mm. The source gives no damping; a stiffness damping of 10 ms is assumed.

The source reports a nearly linear relation of force and contraction, and oscillation under gravity, but no numbers; therefore
nothing is scored. In theory, a perfect arm that is compressed along its axis stays straight until its symmetry is broken,
here by rounding. *Straight* means that the tip is less than 0.1 mm off the axis. The soft tip folds until the last two points
of a cable meet and the direction of the pull would reverse. There the run ends with an error that says so."""
SOURCES = {"published": "the multi-flexible-body simulation of this arm"}
COST = 8
PAIRS = {"two cables": ("east", "west"), "four cables": ("east", "north", "west", "south")}


def run(case):
    figure, axis = plots.axes()
    for (name, cables), colour in zip(PAIRS.items(), (plots.OURS, plots.SECOND)):
        for gravity, style in (([0, 0, 0], "-"), ([0, 0, 9.81], "--")):
            ramps = [f"actuators.{c}.command={{tension: {{ramp: {{to: 2 N, duration: 1 s}}}}}}" for c in cables]
            sim = sinew.load(REPOSITORY / "examples" / "arm" / "conical.yaml",
                             set=[*ramps, "gravity=%g %g %g m/s^2" % tuple(gravity), "duration=2 s"])
            told = "hanging" if gravity[2] else "without gravity"
            if gravity[2]:
                for c in cables:
                    sim.actuator(c).tension = 0.0
                sim.solve_static(max_iterations=300)
                for c in cables:
                    sim.actuator(c).tension = sinew.Ramp(0.0, 2.0, duration=1.0)
            start = sim.effector("tip").position[2]
            forces, shorter, straight = [0.0], [0.0], 0
            for _ in range(100):
                try:
                    sim.step()
                except sinew.RunError as error:
                    if "its points meet" not in str(error):
                        raise
                    break
                if 1e3 * np.hypot(*np.array(sim.effector("tip").position)[:2]) < 0.1:
                    straight = len(forces)
                forces.append(len(cables) * sim.actuator(cables[0]).tension)
                shorter.append(1e3 * (start - sim.effector("tip").position[2]))
            case.report(f"{name}, {told}: ends at the tension", forces[-1] / len(cables), unit="N", source="published")
            case.report(f"{name}, {told}: contraction at the end", shorter[-1], unit="mm", source="published")
            part = slice(0, straight + 1)
            line = np.polyval(np.polyfit(forces[part], shorter[part], 1), forces[part])
            share = 1 - np.var(np.array(shorter[part]) - line) / np.var(shorter[part])
            case.report(f"{name}, {told}: straight up to the tension", forces[straight] / len(cables), unit="N",
                        source="published")
            case.report(f"{name}, {told}: contraction there", shorter[straight], unit="mm", source="published")
            case.report(f"{name}, {told}: R^2 of a linear fit of contraction over force up to there", share,
                        source="published")
            axis.plot(forces, shorter, style, color=colour, label=f"{name}, {told}")
    axis.set(xlabel="sum of tensions (N)", ylabel="contraction of the arm (mm)")
    axis.legend()
    case.figure(figure, "Contraction against cable force.")
