"""A rope over a bollard."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Friction of cables: the capstan equation"
SETUP = """A block of 100 x 100 x 20 mm, E = 1 MPa, is held on one side. A cable enters it straight, follows an arc of 40 mm
radius over 45 to 300 degrees, and leaves it straight to its fixed end. The cable is pulled with 3 N. The tension behind the
arc is read from the stick-slip solution at the points, with the arc divided into 1 to 32 points. The wrap angle is the sum of
the angles by which the deformed cable turns.

For mu theta above 1.6, little tension is left behind the arc, and the contraction of the block under the front of the arc
slackens the rear. Those points stick or slide back, and T_1/T_2 correctly stays below e^(mu theta); this is reported. Then
the pull falls to zero: the tension at the fixed end plotted over the pull forms a loop whose two slopes are Euler's."""
SOURCES = {"Euler": "L. Euler, Remarques sur l'effet du frottement dans l'equilibre, Mem. Acad. Sci. Berlin 18 (1762): "
                    "T_1/T_2 = e^(mu theta)"}
COST = 3
PULL, MIDDLE, RADIUS = 3.0, np.array([0.05, 0.05]), 0.04


def bollard(friction, wrap, points):
    """A simulation of a cable on an arc that starts at the top of its circle."""
    angles = np.arange(points) * wrap / points + 0.5 * wrap / points
    arc = [[*(MIDDLE + RADIUS * np.array([np.sin(a), np.cos(a)])), 0.01] for a in angles]
    enter = [0.0, MIDDLE[1] + RADIUS, 0.01]
    tangent = np.array([np.cos(wrap), -np.sin(wrap)])
    leave = MIDDLE + RADIUS * np.array([np.sin(wrap), np.cos(wrap)]) + 0.008 * tangent
    return sinew.load({
        "sinew": 1, "integrator": "quasi-static", "solver": {**SOLVER, "method": "newton"},
        "bodies": {"block": {
            "type": "fem", "fixed": [{"set": "x_min"}],
            "material": {"model": "corotational", "young_modulus": 1e6, "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": 0.1, "width": 0.1, "height": 0.02, "element_size": 0.0125}}},
        "actuators": {"rope": {"type": "cable", "body": "block", "friction": friction,
                               "points": [enter, *arc, [*leave, 0.01]]}}})


def run(case):
    worst = 0.0
    figure, (left, right) = plots.axes(2)
    for friction, color in ((0.1, plots.OURS), (0.3, plots.REFERENCE), (0.6, "0.4")):
        wraps, ratios = [], []
        for degrees in (45, 90, 180, 300):
            sim = bollard(friction, np.radians(degrees), 16)
            rope = sim.actuator("rope")
            rope.tension = PULL
            sim.step()
            ratio = rope.tensions[0] / rope.tensions[-1]
            if friction * rope.wrap < 1.6:  # see SETUP for larger values
                worst = max(worst, abs(ratio / np.exp(friction * rope.wrap) - 1.0))
            else:
                case.report(f"mu = {friction}, {degrees} degrees: T_1/T_2 / e^(mu theta)",
                            ratio / float(np.exp(friction * rope.wrap)), source="Euler")
            wraps.append(rope.wrap)
            ratios.append(ratio)
        left.semilogy(np.degrees(wraps), ratios, "o", color=color, label=f"mu = {friction}")
        fine = np.linspace(0, 6, 50)
        left.semilogy(np.degrees(fine), np.exp(friction * fine), "-", color=color, lw=1)
    case.check("T_1/T_2 / e^(mu theta), worst of 10", 1.0 + worst, 1.0, 0.005, source="Euler")
    for points in (1, 4, 32):
        sim = bollard(0.3, np.pi / 2, points)
        rope = sim.actuator("rope")
        rope.tension = PULL
        sim.step()
        case.check(f"T_1/T_2, quarter turn as {points} points", rope.tensions[0] / rope.tensions[-1],
                   float(np.exp(0.3 * rope.wrap)), 0.005, source="Euler")

    sim = bollard(0.3, np.pi / 2, 16)
    rope = sim.actuator("rope")
    pulls = np.concatenate([np.linspace(0.1, PULL, 30), np.linspace(PULL, 0.0, 60), np.linspace(0.0, PULL, 60)])
    tied = []
    for pull in pulls:
        rope.tension = pull
        sim.step()
        tied.append(rope.tensions[-1])
    right.plot(pulls, tied, ".-", color=plots.OURS, ms=3, lw=1)
    slope = float(np.exp(-0.3 * rope.wrap))
    right.plot([0, PULL], [0, PULL * slope], "--", color=plots.REFERENCE, lw=1, label="e^(-mu theta)")
    right.plot([0, PULL * slope**2], [0, PULL * slope], ":", color=plots.REFERENCE, lw=1, label="e^(mu theta)")
    back = 30 + int(np.argmin(np.abs(pulls[30:90] - 0.5 * PULL * slope**2)))
    case.check("tension at the fixed end / pull while the cable slides back", tied[back] / pulls[back], 1.0 / slope, 0.02, source="Euler")
    left.set(xlabel="wrap (degrees)", ylabel="T_1/T_2")
    left.legend()
    right.set(xlabel="pull (N)", ylabel="tension at the fixed end (N)")
    right.legend()
    case.figure(figure, "Left: tensions in front of and behind the arc; lines: Euler. Right: a cycle of the pull.")
