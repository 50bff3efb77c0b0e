"""Euler's column."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Buckling load of a clamped-free column"
SETUP = """A column of square section with a length of 10, 20 and 40 times its side, E = 1 MPa, nu = 0.3, is clamped at one
end. An axial dead load compresses it at the other. Hexahedra (neo-Hookean), four across. The load increases through static
equilibria until the exact tangent has a negative pivot, and is bracketed by bisection to 0.01 %. References are Euler's load,
and that of Haringx for a column with shear, P = G A_s/2 (sqrt(1 + 4 P_E/(G A_s)) - 1), both for the column before
compression."""
SOURCES = {"Euler": "P_E = pi^2 E I/(4 L^2)",
           "Haringx": "J. A. Haringx, Proc. Kon. Ned. Akad. Wet. 45 (1942) 533-539; Z. P. Bazant, L. Cedolin, Stability "
                      "of Structures, 2nd ed. 2003, sec. 1.7; shear correction 10 (1 + nu)/(12 + 11 nu)"}
COST = 20
E, NU, SIDE = 1e6, 0.3, 0.01


def critical(ratio):
    """Critical load (N), by bisection between stable and unstable."""
    length = ratio * SIDE
    sim = sinew.load({
        "sinew": 1, "solver": SOLVER,
        "bodies": {"column": {
            "type": "fem", "element": "hex8", "fixed": [{"set": "x_min"}],
            "material": {"model": "neo-hookean", "young_modulus": E, "poisson_ratio": NU},
            "mesh": {"shape": "block", "length": length, "width": SIDE, "height": SIDE, "element_size": SIDE / 4}}}})
    body = sim.body("column")
    rest = np.array(body.rest_positions)
    end = np.flatnonzero(rest[:, 0] > length - 1e-9)
    y, z = np.round(rest[end, 1] / SIDE * 4).astype(int), np.round(rest[end, 2] / SIDE * 4).astype(int)
    share = np.where((y % 4) == 0, 0.5, 1.0) * np.where((z % 4) == 0, 0.5, 1.0)
    share /= share.sum()

    def unstable(load):
        sim.reset()
        body.external_forces[end, 0] = -load * share
        return sim.solve_static(stability="any").negative_pivots > 0

    euler = np.pi**2 * E * SIDE**4 / 12 / (4 * length**2)
    low, high = 0.5 * euler, 1.5 * euler
    while high - low > 1e-4 * euler:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return 0.5 * (low + high), euler


def run(case):
    ratios = (10, 20, 40)
    found, simple = [], []
    shear = E / (2 * (1 + NU)) * SIDE**2 * 10 * (1 + NU) / (12 + 11 * NU)
    for ratio in ratios:
        load, euler = critical(ratio)
        haringx = shear / 2 * (np.sqrt(1 + 4 * euler / shear) - 1)
        case.check(f"length {ratio} sides: buckling load", 1e3 * load, 1e3 * haringx, 0.03, unit="mN", source="Haringx")
        case.report(f"length {ratio} sides: buckling load / Euler's", load / euler, source="Euler")
        found.append(load / euler)
        simple.append(haringx / euler)
    figure, axis = plots.axes()
    axis.plot(ratios, simple, "--", color=plots.REFERENCE, label="Haringx")
    axis.plot(ratios, found, "o-", color=plots.OURS, label="Sinew")
    axis.set(xlabel="length / side", ylabel="buckling load / Euler's")
    axis.legend()
    case.figure(figure, "Buckling load of the column.")
