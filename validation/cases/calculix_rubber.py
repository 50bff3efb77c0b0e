"""Hyperelastic statics against CalculiX."""

import numpy as np
import sinew

from reference import calculix
from suite import plots
from suite.robots import SOLVER

TITLE = "Rubber block compared with CalculiX"
SETUP = """A block, 60 x 20 x 20 mm, clamped at one end, of 80 linear tetrahedra of about 10 mm. A dead load of (50, 20, -400)
mN, distributed evenly over the nodes of the other end, bends it by a quarter of its length. Both codes solve for equilibrium
on the same mesh with the same energy, so they must agree to the seven digits that CalculiX prints. kappa = 200 kPa."""
SOURCES = {"CalculiX": "G. Dhondt, The Finite Element Method for Three-Dimensional Thermomechanical "
                       "Applications, Wiley 2004; program ccx of Debian's calculix-ccx"}
COST = 8
LOAD = (0.05, 0.02, -0.4)  # N
LAWS = {
    "neo-Hookean": {"model": "neo-hookean", "shear_modulus": 2e4, "bulk_modulus": 2e5},
    "Mooney-Rivlin": {"model": "mooney-rivlin", "c10": 8e3, "c01": 2e3, "bulk_modulus": 2e5},
    "Yeoh": {"model": "yeoh", "c10": 1e4, "c20": -200.0, "c30": 30.0, "bulk_modulus": 2e5},
    "Ogden, three terms": {"model": "ogden", "mu": [2e4, 100.0, 500.0], "alpha": [1.7, 7.0, -3.4],
                           "convention": "two-mu-over-alpha-squared", "bulk_modulus": 2e5},
}


def ours(law):
    """The body in equilibrium, its rest positions, and the nodal loads."""
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, 0], "solver": SOLVER,
        "bodies": {"body": {
            "type": "fem", "element": "tet4", "material": law, "density": 1000.0, "fixed": [{"set": "x_min"}],
            "mesh": {"shape": "block", "length": 0.06, "width": 0.02, "height": 0.02,
                     "element_size": 0.01}}}})
    body = sim.body("body")
    rest = np.array(body.rest_positions)
    end = np.flatnonzero(rest[:, 0] > 0.06 - 1e-9)
    loads = np.zeros_like(rest)
    loads[end] = np.array(LOAD) / len(end)
    body.external_forces[:] = loads
    sim.solve_static(tolerance=1e-12)
    return body, rest, loads


def run(case):
    if not calculix.present():
        case.skip("displacements of four laws", "ccx is not present", source="CalculiX")
        return
    tips, theirs_at_tip = [], []
    for name, law in LAWS.items():
        body, rest, loads = ours(law)
        moved = np.array(body.positions) - rest
        folder = case.scratch / law["model"]
        folder.mkdir()
        reference = calculix.displacements(folder, rest, body.tetrahedra, body.fixed, law, loads)
        largest = np.linalg.norm(reference, axis=1).max()
        apart = np.linalg.norm(moved - reference, axis=1).max()
        case.report(f"{name}: largest displacement", 1e3 * largest, unit="mm", source="CalculiX")
        case.bound(f"{name}: largest distance of a node from CalculiX's / largest displacement", apart / largest, 1e-6,
                   source="CalculiX")
        end = loads[:, 2] != 0
        tips.append(1e3 * moved[end, 2].mean())
        theirs_at_tip.append(1e3 * reference[end, 2].mean())
    figure, axis = plots.axes()
    places = np.arange(len(LAWS))
    axis.bar(places - 0.2, tips, 0.4, color=plots.OURS, label="Sinew")
    axis.bar(places + 0.2, theirs_at_tip, 0.4, color=plots.REFERENCE, label="CalculiX")
    axis.set_xticks(places, list(LAWS))
    axis.set(ylabel="mean deflection of the end (mm)")
    axis.legend()
    case.figure(figure, "Deflection of the end under the same load with four laws.")
