"""NAFEMS LE1: stress concentration in an elliptic membrane."""

import numpy as np
import sinew

from reference import shapes
from suite import plots
from suite.robots import SOLVER

TITLE = "NAFEMS LE1, elliptic membrane"
SETUP = """A quarter of a membrane between the ellipses x^2/2^2 + y^2 = 1 and x^2/3.25^2 + y^2/2.75^2 = 1 (m), 0.1 m thick, E
= 210 GPa, nu = 0.3, plane stress (its faces are free), with rollers on both planes of symmetry and an outward pressure of 10
MPa on the outer edge. The quantity is sigma_yy at (2, 0). n x n x 1 hexahedra (Saint Venant-Kirchhoff at a thousandth of the
load). The stress is extrapolated linearly from the two innermost elements next to the point."""
SOURCES = {"NAFEMS": "The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, test LE1: 92.7 MPa"}
COST = 10
CELLS = (8, 16, 32, 64)


def stress(case, n):
    """Stress sigma_yy (MPa) at (2, 0)."""
    angle = np.linspace(0, np.pi / 2, n + 1)
    part = np.linspace(0, 1, n + 1)
    inner = np.column_stack([2 * np.cos(angle), np.sin(angle)])
    outer = np.column_stack([3.25 * np.cos(angle), 2.75 * np.sin(angle)])
    layer = np.concatenate([(1 - p) * inner + p * outer for p in part])
    points = np.vstack([np.column_stack([layer, np.full(len(layer), z)]) for z in (0.0, 0.1)])
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    low = (i * (n + 1) + j).ravel()
    face = np.column_stack([low, low + n + 1, low + n + 2, low + 1])
    path = shapes.write_hexahedra(case.scratch / f"le1_{n}.vtu", points, np.hstack([face, face + len(layer)]))
    sim = sinew.load({
        "sinew": 1, "solver": SOLVER,
        "bodies": {"plate": {
            "type": "fem", "mesh": {"file": str(path), "unit": "m"},
            "material": {"model": "saint-venant-kirchhoff", "young_modulus": 210e9, "poisson_ratio": 0.3},
            "fixed": [{"plane": {"point": [0, 0, 0], "normal": normal, "within": 1e-9}, "axes": axis}
                      for normal, axis in (([1, 0, 0], "x"), ([0, 1, 0], "y"), ([0, 0, 1], "z"))]}}})
    body = sim.body("plate")
    loads = np.zeros_like(points)
    edge = n * (n + 1) + np.arange(n + 1)
    for a, b in zip(edge, edge[1:]):
        step = points[b] - points[a]
        force = 10e3 * 0.1 * np.array([step[1], -step[0], 0.0])
        for node in (a, b, a + len(layer), b + len(layer)):
            loads[node] += force / 4
    body.external_forces[:] = loads
    sim.solve_static()
    sigma = np.array(body.cauchy_stresses)[:, 1, 1] * 1e-3
    # The four elements at the end of the hole: radial index i = 0, 1 and angular index j = 0, 1.
    place = {(a, b): k for k, (a, b) in enumerate(zip(i.ravel(), j.ravel()))}
    along = [1.5 * sigma[place[0, k]] - 0.5 * sigma[place[1, k]] for k in (0, 1)]
    return 1.5 * along[0] - 0.5 * along[1]


def run(case):
    found = [stress(case, n) for n in CELLS]
    case.check(f"sigma_yy at (2, 0), {CELLS[-1]} x {CELLS[-1]} cells", found[-1], 92.7, 0.02, unit="MPa", source="NAFEMS")
    figure, axis = plots.axes()
    axis.semilogx(CELLS, found, "o-", color=plots.OURS, label="Sinew")
    axis.axhline(92.7, color=plots.REFERENCE, lw=1, label="NAFEMS")
    axis.set(xlabel="cells along an edge", ylabel="stress at the hole (MPa)")
    axis.legend()
    case.figure(figure, "Convergence of the stress concentration.")
