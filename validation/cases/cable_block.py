"""A cable of constant tension in a straight block, compared with a hand calculation."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "A cable of constant tension in a straight block"
SETUP = """A block of 200 x 20 x 20 mm, E = 200 kPa, nu = 0, linear material, is clamped at x = 0. A straight cable is pulled
at the clamp and anchored at the free end. On the axis, it shortens the middle half of the block uniformly by T/(E A). At a
distance e = 5 mm from the axis, it also bends the block to the curvature T e/(E I) of Euler and Bernoulli. T = 0.5 mN deflects
the end by 20 um: at 50 mN, 2 mm, the linear law in equilibrium is 18 % off this theory of small deflections. Strain and
curvature are measured over the middle half, away from the ends (Saint-Venant). Linear tetrahedra are too stiff in bending and
converge from below."""
SOURCES = {"Timoshenko 1955": "S. Timoshenko, Strength of Materials I, 3rd ed., Van Nostrand 1955, "
                              "articles 2 and 32 (eccentric compression)"}
COST = 3
YOUNG, SIDE, LENGTH, TENSION, OFFSET = 200e3, 0.02, 0.2, 5e-4, 0.005


def measure(cells, offset):
    """Mean axial strain and curvature (1/m) of the middle half."""
    size = SIDE / cells
    middle = SIDE / 2
    scene = {
        "sinew": 1, "integrator": "quasi-static", "solver": dict(SOLVER),
        "bodies": {"block": {
            "type": "fem", "mesh": {"shape": "block", "length": LENGTH, "width": SIDE,
                                    "height": SIDE, "element_size": size},
            "material": {"model": "linear", "young_modulus": YOUNG, "poisson_ratio": 0.0},
            "fixed": [{"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}}]}},
        "actuators": {"cable": {
            "type": "cable", "body": "block",
            "points": [[0, middle, middle + offset], [LENGTH, middle, middle + offset]],
            "command": {"tension": TENSION}}},
    }
    sim = sinew.load(scene)
    sim.step()
    body = sim.body("block")
    rest = np.array(body.rest_positions)
    moved = np.array(body.positions) - rest
    inside = (rest[:, 0] > LENGTH / 4 - 1e-9) & (rest[:, 0] < 3 * LENGTH / 4 + 1e-9)
    x, u = rest[inside], moved[inside]
    strain = np.polyfit(x[:, 0], u[:, 0], 1)[0]
    # u_x = -z w' + ..., w = kappa x^2 / 2: fit the deflection
    curvature = 2 * np.polyfit(x[:, 0], u[:, 2], 2)[0]
    return strain, curvature


def run(case):
    area, inertia = SIDE**2, SIDE**4 / 12
    source = "Timoshenko 1955"
    strain, _ = measure(4, 0.0)
    case.check("axial strain, cable on the axis", strain, -TENSION / (YOUNG * area), 0.005,
               source=source)
    expected = TENSION * OFFSET / (YOUNG * inertia)
    cells = (2, 4, 8)
    curvatures = [abs(measure(n, OFFSET)[1]) for n in cells]
    for n, curvature in zip(cells[:-1], curvatures):
        case.report(f"curvature, cable 5 mm off the axis, {n} cells across", curvature, unit="1/m",
                    reference=expected, source=source)
    finest = curvatures[-1] + (curvatures[-1] - curvatures[-2]) / 3
    case.check("curvature, extrapolated to h = 0 (second order)", finest, expected, 0.02,
               unit="1/m", source=source)
    figure, axis = plots.axes()
    axis.plot([1 / n for n in cells], curvatures, "o-", color=plots.OURS, label="linear tetrahedra")
    axis.axhline(expected, color=plots.REFERENCE, ls="--", lw=1, label="T e / (E I)")
    axis.set(xlabel="1 / cells across", ylabel="curvature (1/m)", xlim=(0, None), ylim=(0, None))
    axis.legend()
    case.figure(figure, "Curvature under an eccentric cable against cell size.")
