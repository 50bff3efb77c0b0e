"""The elastica, with hexahedra."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Elastica under a load at its tip"
SETUP = """A slender bar, 100 x 1 x 1 mm, clamped at one end, of a neo-Hookean material with E = 1 MPa and nu_0 = 0.3, meshed
with cubes: two, then four across the width. Strains are small: at most half the width times the largest curvature, 5 %. A
dead load P on its end face, distributed by bilinear shape functions, bends it; p = P L^2/(E I) = 1, 2, 5, 10. Deflection w
and shortening u of the middle of the end face, relative to L, are extrapolated by Richardson's method with order 2. Full
integration of the deviator makes bending too stiff by shear; the table also reports the error of the finer mesh alone."""
SOURCES = {"Mattiasson 1981": "K. Mattiasson, Numerical results from large deflection beam and frame problems "
                              "analysed by means of elliptic integrals, Int. J. Numer. Meth. Eng. 17 (1981) "
                              "145-153, table I"}
COST = 40
LENGTH, WIDTH, YOUNG, POISSON = 0.1, 0.001, 1e6, 0.3
# w/L and u/L by elliptic integrals.
REFERENCE = {1: (0.30172, 0.05643), 2: (0.49346, 0.16064), 5: (0.71379, 0.38763), 10: (0.81061, 0.55500)}
TOLERANCE = 0.01  # the theory has no clamp in three dimensions and no finite strain


def end_shares(rest):
    """(n,) fraction of a uniform traction on the face x = L per node: a quarter of each adjacent cell's."""
    shares = np.zeros(len(rest))
    end = np.flatnonzero(rest[:, 0] > LENGTH - 1e-9)
    inside = [(rest[end, c] > 1e-9) & (rest[end, c] < WIDTH - 1e-9) for c in (1, 2)]
    shares[end] = (1.0 + inside[0]) * (1.0 + inside[1])
    return shares / shares.sum()


def bent(cells):
    """w/L and u/L for each load."""
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, 0], "solver": SOLVER,
        "bodies": {"body": {
            "type": "fem", "element": "hex8", "density": 1000.0, "fixed": [{"set": "x_min"}],
            "material": {"model": "neo-hookean", "young_modulus": YOUNG, "poisson_ratio": POISSON},
            "mesh": {"shape": "block", "length": LENGTH, "width": WIDTH, "height": WIDTH,
                     "element_size": WIDTH / cells}}}})
    body = sim.body("body")
    rest = np.array(body.rest_positions)
    shares = end_shares(rest)
    result = []
    for load in REFERENCE:
        force = load * YOUNG * WIDTH**4 / 12 / LENGTH**2
        body.external_forces[:] = np.outer(shares, (0.0, 0.0, force))
        sim.solve_static(max_iterations=200)
        moved = shares @ (np.array(body.positions) - rest)
        result.append((moved[2] / LENGTH, -moved[0] / LENGTH))
    return np.array(result)


def run(case):
    coarse, fine = bent(2), bent(4)
    limit = fine + (fine - coarse) / 3
    for k, (load, (w, u)) in enumerate(REFERENCE.items()):
        case.check(f"w/L at p = {load}", limit[k, 0], w, TOLERANCE, source="Mattiasson 1981")
        case.check(f"u/L at p = {load}", limit[k, 1], u, TOLERANCE, source="Mattiasson 1981")
        case.report(f"w/L at p = {load}, four cells across", fine[k, 0], source="Mattiasson 1981")
    loads = list(REFERENCE)
    figure, axis = plots.axes()
    for c, (name, marker) in enumerate((("w/L", "o"), ("u/L", "s"))):
        axis.plot(loads, [REFERENCE[p][c] for p in loads], "-", color=plots.REFERENCE,
                  label=f"{name}, elliptic integrals")
        axis.plot(loads, fine[:, c], marker, mfc="none", color=plots.OURS, label=f"{name}, four across")
        axis.plot(loads, limit[:, c], marker, color=plots.OURS, label=f"{name}, extrapolated")
    axis.set(xlabel="P L^2 / (E I)", ylabel="displacement of the end / L")
    axis.legend()
    case.figure(figure, "Deflection and shortening against the load.")
