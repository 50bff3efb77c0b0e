"""Cook's membrane: bending and shear of a nearly incompressible panel."""

import meshio
import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Cook's membrane, nearly incompressible"
SETUP = """A tapered panel with corners (0, 0), (48, 44), (48, 60), (0, 44) mm is clamped at the left, E = 70 N/mm^2, nu =
0.49, in plane strain (one layer of cells, 1 mm thick, on rollers along z), with a shear traction of 6.25 N/mm^2 upwards on
its right edge. The quantity is the vertical displacement of the corner (48, 60).

Small strain: a neo-Hookean panel under a ten-thousandth of the load, scaled up. The mesh has n x n cells; for tetrahedra each
cell is split into six. Finite strain: the neo-Hookean panel under the full load. Published values vary with the form of the
volumetric energy, so this is not scored."""
SOURCES = {
    "fine quadratic": "plane-strain meshes of very many quadratic elements converge to about 28.0 mm; locked "
                      "linear elements gave 11.8 (R. D. Cook, J. Struct. Div. ASCE 100 (1974) 1851-1863 for the "
                      "problem)",
    "finite strain": "about 17.0 mm by mixed elements in the literature on this variant",
}
COST = 25
YOUNG, POISSON, TRACTION = 70e6, 0.49, 6.25e6
CELLS = (4, 8, 16, 32)


def panel(folder, n, element):
    """Writes the mesh as VTU, in mm."""
    xi, eta = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n)
    x, y = 48 * xi, 44 * xi + eta * (44 - 28 * xi)
    layer = np.column_stack([x.ravel(), y.ravel()])
    points = np.vstack([np.column_stack([layer, np.full(len(layer), z)]) for z in (0.0, 1.0)])
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    low = (j * (n + 1) + i).ravel()
    face = np.column_stack([low, low + 1, low + n + 2, low + n + 1])
    cells = np.hstack([face, face + len(layer)])
    path = folder / f"{element}_{n}.vtu"
    if element == "hex8":
        blocks = [("hexahedron", cells)]
    else:  # Kuhn's division into six, around the diagonal 0-6
        ring = [1, 2, 3, 7, 4, 5, 1]
        blocks = [("tetra", np.vstack([cells[:, [0, a, b, 6]] for a, b in zip(ring, ring[1:])]))]
    meshio.Mesh(points, blocks).write(path)
    return path


def corner(folder, n, element, scale):
    """Vertical displacement (mm) of the corner under the fraction `scale` of the load, divided by it."""
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, 0], "solver": SOLVER,
        "bodies": {"panel": {
            "type": "fem", "element": element, "density": 1000.0,
            "mesh": {"file": str(panel(folder, n, element)), "unit": "mm"},
            "material": {"model": "neo-hookean", "young_modulus": YOUNG, "poisson_ratio": POISSON},
            "fixed": [{"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}},
                      {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "axes": "z"},
                      {"plane": {"point": [0, 0, 0.001], "normal": [0, 0, 1]}, "axes": "z"}]}}})
    body = sim.body("panel")
    rest = np.array(body.rest_positions)
    edge = np.flatnonzero(rest[:, 0] > 0.048 - 1e-9)
    ends = np.isclose(rest[edge, 1], 0.044) | np.isclose(rest[edge, 1], 0.060)
    shares = np.where(ends, 0.5, 1.0)
    body.external_forces[edge, 1] = scale * TRACTION * 0.016 * 0.001 * shares / shares.sum()
    sim.solve_static(max_iterations=300)
    at = np.flatnonzero(np.isclose(rest[:, 0], 0.048) & np.isclose(rest[:, 1], 0.060))
    return 1e3 * float(np.mean((np.array(body.positions) - rest)[at, 1])) / scale


def run(case):
    small = {e: [corner(case.scratch, n, e, 1e-4) for n in CELLS] for e in ("hex8", "tet4")}
    finite = [corner(case.scratch, n, "hex8", 1.0) for n in CELLS]
    case.check(f"small strain, hexahedra, {CELLS[-1]} x {CELLS[-1]} cells", small["hex8"][-1], 28.0, 0.01,
               unit="mm", source="fine quadratic")
    case.report(f"small strain, hexahedra, {CELLS[0]} x {CELLS[0]} cells", small["hex8"][0], unit="mm",
                source="fine quadratic")
    case.report(f"small strain, linear tetrahedra, {CELLS[-1]} x {CELLS[-1]} cells", small["tet4"][-1],
                unit="mm", source="fine quadratic")
    case.report(f"finite strain, hexahedra, {CELLS[-1]} x {CELLS[-1]} cells", finite[-1], unit="mm",
                source="finite strain")
    figure, axis = plots.axes()
    axis.axhline(28.0, color=plots.REFERENCE, lw=1, label="fine quadratic meshes, small strain")
    axis.semilogx(CELLS, small["hex8"], "o-", color=plots.OURS, label="hexahedra, small strain")
    axis.semilogx(CELLS, small["tet4"], "s-", color=plots.SECOND, label="tetrahedra, small strain")
    axis.semilogx(CELLS, finite, "^--", color=plots.OURS, label="hexahedra, finite strain")
    axis.set(xlabel="cells along an edge", ylabel="displacement of the corner (mm)")
    axis.legend()
    case.figure(figure, "Convergence of the corner's displacement.")
