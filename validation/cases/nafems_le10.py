"""NAFEMS LE10: bending of a thick plate with an elliptic hole."""

import numpy as np
import sinew

from reference import shapes
from suite import plots
from suite.robots import SOLVER

TITLE = "NAFEMS LE10, thick plate under pressure"
SETUP = """A quarter of a plate between the ellipses of LE1, 0.6 m thick, E = 210 GPa, nu = 0.3, under a pressure of 1 MPa on
its upper face, applied as consistent nodal forces. Rollers hold both planes of symmetry. The outer curved face is held in x
and y, and its middle line also in z. The quantity is sigma_yy at D = (2, 0, 0.6). n x n cells, n/4 through the thickness
(rounded to even), of hexahedra or split into six quadratic tetrahedra each (Saint Venant-Kirchhoff at a thousandth of the
load). The stress at D is that of a plane through the element means of all elements with a node within one and a half cells of
D, by least squares (similar to O. C. Zienkiewicz, J. Z. Zhu, Int. J. Numer. Methods Eng. 33 (1992) 1331-1364)."""
SOURCES = {"NAFEMS": "The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, test LE10: -5.38 MPa"}
COST = 40
CELLS = {"hex8": (8, 16, 24, 32), "tet10": (8, 12, 16, 24)}
THICKNESS, SHARE = 0.6, 1e-3
KUHN = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]


def grid(n, layers):
    """Points (p, 3) in m, hexahedra (m, 8), and node numbers indexed by (radial, around, up)."""
    angle, part = np.linspace(0, np.pi / 2, n + 1), np.linspace(0, 1, n + 1)
    inner = np.column_stack([2 * np.cos(angle), np.sin(angle)])
    outer = np.column_stack([3.25 * np.cos(angle), 2.75 * np.sin(angle)])
    flat = np.concatenate([(1 - p) * inner + p * outer for p in part])
    flat[np.abs(flat) < 1e-12] = 0.0
    points = np.vstack([np.column_stack([flat, np.full(len(flat), z)])
                        for z in np.linspace(0, THICKNESS, layers + 1)])
    number = np.arange(len(points)).reshape(layers + 1, n + 1, n + 1).transpose(1, 2, 0)
    a, b = number[:-1], number[1:]  # inner and outer side of a cell
    low = [a[:, :-1], b[:, :-1], b[:, 1:], a[:, 1:]]
    corners = [x[:, :, :-1] for x in low] + [x[:, :, 1:] for x in low]
    return points, np.column_stack([c.ravel() for c in corners]), number


def pressure(body, element, rest):
    """Nodal forces (n, 3) in N of a unit pressure on the upper face, consistent with the elements' shape functions."""
    loads = np.zeros_like(rest)
    upper = rest[:, 2] > THICKNESS - 1e-9
    cells = body.hexahedra if element == "hex8" else body.quadratic_tetrahedra
    for cell in np.asarray(cells)[upper[cells].sum(axis=1) == (4 if element == "hex8" else 6)]:
        face = cell[upper[cell]]
        if element == "hex8":  # bilinear on a quadrilateral, 2 x 2 points
            ring = face[[0, 1, 2, 3]]
            for u in (-3**-0.5, 3**-0.5):
                for v in (-3**-0.5, 3**-0.5):
                    shape = np.array([(1 - u) * (1 - v), (1 + u) * (1 - v), (1 + u) * (1 + v), (1 - u) * (1 + v)]) / 4
                    du = np.array([v - 1, 1 - v, 1 + v, -1 - v]) / 4 @ rest[ring]
                    dv = np.array([u - 1, -1 - u, 1 + u, 1 - u]) / 4 @ rest[ring]
                    loads[ring, 2] -= shape * abs(du[0] * dv[1] - du[1] * dv[0])
        else:  # straight edges: nothing at the corners, a third at each middle
            corner = [k for k in cell[:4] if upper[k]]
            sides = rest[corner[1:]] - rest[corner[0]]
            area = 0.5 * abs(sides[0, 0] * sides[1, 1] - sides[0, 1] * sides[1, 0])
            middles = [k for k in cell[4:] if upper[k]]
            loads[middles, 2] -= area / 3
    return loads


def stress(case, element, n):
    """Stress (MPa) at D, and the number of nodes."""
    layers = max(2, 2 * round(n / 8))
    points, cells, number = grid(n, layers)
    outer = np.isin(np.arange(len(points)), number[-1])
    sets = {"outer": outer, "middle_line": outer & (np.abs(points[:, 2] - THICKNESS / 2) < 1e-9)}
    path = case.scratch / f"le10_{element}_{n}.vtu"
    if element == "hex8":
        shapes.write_hexahedra(path, points, cells, sets)
    else:
        shapes.write_tetrahedra(path, points, np.vstack([cells[:, list(k)] for k in KUHN]), sets)
    rollers = [{"plane": {"point": [0, 0, 0], "normal": normal, "within": 1e-9}, "axes": axis}
               for normal, axis in (([1, 0, 0], "x"), ([0, 1, 0], "y"))]
    sim = sinew.load({"sinew": 1, "solver": SOLVER, "bodies": {"plate": {
        "type": "fem", "element": element, "mesh": {"file": str(path), "unit": "m"},
        "fixed": [*rollers, {"set": "outer", "axes": ["x", "y"]}, {"set": "middle_line", "axes": "z"}],
        "material": {"model": "saint-venant-kirchhoff", "young_modulus": 210e9, "poisson_ratio": 0.3}}}})
    body = sim.body("plate")
    rest = np.array(body.rest_positions)
    body.external_forces[:] = 1e6 * SHARE * pressure(body, element, rest)
    sim.solve_static()
    everything = np.asarray(body.hexahedra if element == "hex8" else body.tetrahedra)
    sigma = np.array(body.cauchy_stresses)[:, 1, 1] * 1e-6 / SHARE
    middle = rest[everything].mean(axis=1)
    near = np.isin(everything, number[:2, :2, -2:]).any(axis=1)
    columns = np.column_stack([np.ones(near.sum()), middle[near] - np.array([2.0, 0.0, THICKNESS])])
    return float(np.linalg.lstsq(columns, sigma[near], rcond=None)[0][0]), len(rest)


def run(case):
    figure, axis = plots.axes()
    for element, colour in (("hex8", plots.OURS), ("tet10", plots.THIRD)):
        found = [stress(case, element, n) for n in CELLS[element]]
        case.check(f"{element}, n = {CELLS[element][-1]}, {found[-1][1]} nodes: sigma_yy at D", found[-1][0], -5.38, 0.02,
                   unit="MPa", source="NAFEMS")
        axis.semilogx([nodes for _, nodes in found], [value for value, _ in found], "o-", color=colour, label=element)
    axis.axhline(-5.38, color=plots.REFERENCE, lw=1, label="NAFEMS")
    axis.set(xlabel="nodes", ylabel="sigma_yy at D (MPa)")
    axis.legend()
    case.figure(figure, "Convergence of the stress on the upper rim of the hole.")
