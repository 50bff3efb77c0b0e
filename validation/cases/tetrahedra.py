"""Tetrahedra near incompressibility: shared dilatations (tet4-patch) and quadratic ones (tet10)."""

import numpy as np
import sinew

from cases import cook_membrane, locking
from suite import plots
from suite.robots import SOLVER

TITLE = "Tetrahedra near incompressibility"
SETUP = """Three problems in which linear tetrahedra lock.

- Cook's membrane of the case cook_membrane in plane strain, at nu = 0.49 and 0.4999, with each cell split into six, under a
  thousandth of the load, scaled up. Loads of quadratic elements are consistent.
- The hanging beam of the case locking.
- A pneumatic module: a cylinder of 12.5 mm radius and 65 mm length with an eccentric chamber of 3.7 mm radius, neo-Hookean, E
  = 72 kPa, nu = 0.49, clamped at one end and inflated by 10 Pa. The quantity is the lateral displacement at the middle of its
  free end, relative to that of hexahedra, extrapolated from cells of 1.6 and 0.8 mm."""
SOURCES = {
    "fine quadratic": "plane-strain meshes of very many quadratic elements converge to about 28.0 mm (R. D. Cook, "
                      "J. Struct. Div. ASCE 100 (1974) 1851-1863 for the problem)",
    "hexahedra": "the same problem in hexahedra: membrane in 64 x 64 cells, beam in cells of 2.5 mm",
    "converged": "benchmarks/pareto.py: 0.0007298 mm",
}
COST = 60
SCALE = 1e-3
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))


def edge_shares(body, rest):
    """(n,) fractions of a traction on the right edge, per node."""
    shares = np.zeros(len(rest))
    right = rest[:, 0] > 0.048 - 1e-9
    cells = body.quadratic_tetrahedra if len(body.quadratic_tetrahedra) else body.tetrahedra
    for cell in cells:
        corners = [k for k in range(4) if right[cell[k]]]
        if len(corners) != 3:
            continue
        a, b, c = rest[cell[corners]]
        area = np.linalg.norm(np.cross(b - a, c - a))
        middles = [4 + k for k, ends in enumerate(EDGES) if set(ends) <= set(corners)]
        shares[cell[middles] if len(cell) == 10 else cell[corners]] += area
    if not len(cells):
        y = rest[:, 1]
        shares[right] = np.where(np.isclose(y[right], 0.044) | np.isclose(y[right], 0.060), 0.5, 1.0)
    return shares / shares.sum()


def corner(folder, n, element, poisson_ratio):
    """Vertical displacement (mm) of the membrane's corner under a fraction of the load, divided by it."""
    cells = "hex8" if element == "hex8" else "tet4"
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, 0], "solver": SOLVER,
        "bodies": {"panel": {
            "type": "fem", "density": 1000.0, "element": element,
            "mesh": {"file": str(cook_membrane.panel(folder, n, cells)), "unit": "mm"},
            "material": {"model": "neo-hookean", "young_modulus": 70e6, "poisson_ratio": poisson_ratio},
            "fixed": [{"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}},
                      {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "axes": "z"},
                      {"plane": {"point": [0, 0, 0.001], "normal": [0, 0, 1]}, "axes": "z"}]}}})
    body = sim.body("panel")
    rest = np.array(body.rest_positions)
    force = SCALE * cook_membrane.TRACTION * 0.016 * 0.001
    body.external_forces[:, 1] = force * edge_shares(body, rest)
    sim.solve_static(tolerance=1e-5)  # the volumetric forces nearly cancel, so rounding is larger
    at = np.isclose(rest[:, 0], 0.048) & np.isclose(rest[:, 1], 0.060)
    return 1e3 * float(np.mean((np.array(body.positions) - rest)[at, 1])) / SCALE


def module(element, size):
    """Tip displacement (mm), as in benchmarks/pareto.py."""
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, 0], "solver": {"ordering": "metis"},
        "bodies": {"module": {
            "type": "fem", "element": element, "density": 1070.0, "fixed": [{"set": "bottom"}],
            "mesh": {"shape": "chambered-cylinder", "radius": 0.0125, "height": 0.065, "chamber_radius": 0.0037,
                     "chamber_offset": 0.0073, "chamber_top": 0.06, "element_size": 1e-3 * size},
            "material": {"model": "neo-hookean", "young_modulus": 72e3, "poisson_ratio": 0.49}}},
        "actuators": {"air": {"body": "module", "type": "chamber", "surface": {"set": "chamber"}, "cap": True}},
        "effectors": {"tip": {"body": "module", "point": [0, 0, 0.065], "outside": "nearest"}}})
    start = sim.effector("tip").position[0]
    sim.actuator("air").pressure = 10.0
    sim.solve_static()
    return 1e3 * abs(sim.effector("tip").position[0] - start)


def run(case):
    figure, axis = plots.axes()
    cells = {"tet4": (4, 8, 16, 32), "tet4-patch": (4, 8, 16, 32), "tet10": (2, 4, 8, 16)}
    for poisson_ratio, style in ((0.49, "-"), (0.4999, "--")):
        fine = 28.0 if poisson_ratio == 0.49 else corner(case.scratch, 64, "hex8", poisson_ratio)
        source = "fine quadratic" if poisson_ratio == 0.49 else "hexahedra"
        for (element, sizes), colour in zip(cells.items(), (plots.SECOND, plots.OURS, plots.REFERENCE), strict=True):
            found = [corner(case.scratch, n, element, poisson_ratio) for n in sizes]
            axis.semilogx(sizes, found, "o" + style, color=colour, label=f"{element}, nu = {poisson_ratio}")
            name = f"membrane, nu = {poisson_ratio}, {element}, {sizes[-1]} x {sizes[-1]} cells"
            if element == "tet4":
                case.report(name, found[-1], unit="mm", source=source)
            else:
                case.check(name, found[-1], fine, 0.04 if element == "tet4-patch" else 0.01, unit="mm", source=source)
    axis.axhline(28.0, color="#222222", lw=1, ls=":")
    axis.set(xlabel="cells along an edge", ylabel="displacement of the corner (mm)")
    axis.legend(fontsize=7)
    case.figure(figure, "Cook's membrane.")

    fine = locking.sinks("hex8", 2.5)
    case.check("beam, tet4-patch, 5 mm", locking.sinks("tet4-patch", 5.0), fine, 0.10, unit="mm", source="hexahedra")
    case.check("beam, tet4-patch, 2.5 mm", locking.sinks("tet4-patch", 2.5), fine, 0.04, unit="mm",
               source="hexahedra")
    case.check("beam, tet10, 10 mm", locking.sinks("tet10", 10.0), fine, 0.02, unit="mm", source="hexahedra")

    for element, size, tolerance in (("tet4-patch", 2.5, 0.1), ("tet4-patch", 1.5, 0.05), ("tet10", 6.0, 0.1),
                                     ("tet10", 4.0, 0.1), ("tet10", 3.0, 0.05)):
        case.check(f"module, {element}, {size:g} mm", 1e4 * module(element, size), 7.298, tolerance, unit="1e-4 mm",
                   source="converged")
    for size in (4.0, 2.5):
        case.report(f"module, tet4, {size:g} mm", 1e4 * module("tet4", size), unit="1e-4 mm", source="converged")
