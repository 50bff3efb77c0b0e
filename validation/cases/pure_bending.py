"""Pure bending, where the theoretical order of convergence must be reached."""

import numpy as np
import sinew

from reference.tetrahedra import area_vectors, boundary, gradients
from suite import plots
from suite.case import observed_order
from suite.robots import body_scene, write_block

TITLE = "Pure bending: order of convergence on a smooth solution"
SETUP = """A cube, 20 x 20 x 20 mm, E = 1 MPa, nu = 0, linear material, is bent to the curvature k = 1/m by tractions s_xx =
-E k z on its end (z from the middle). With nu = 0 the displacement u = (-k x z, 0, k x^2/2) is the exact three-dimensional
solution and vanishes on the clamped face. Unlike the clamped block under a transverse load, this problem has no singularity,
so the error of linear tetrahedra in the L2 norm and the error of the strain energy must both fall with the square of the cell
size."""
SOURCES = {
    "Timoshenko 1970": "S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed., McGraw-Hill "
                       "1970, section 102 (pure bending of prismatical bars)",
    "Ciarlet 1978": "P. G. Ciarlet, The Finite Element Method for Elliptic Problems, North-Holland "
                    "1978, section 3.2 (theorems 3.2.2 and 3.2.5)",
}
COST = 10
LENGTH, WIDTH, YOUNG, CURVATURE = 0.02, 0.02, 1e6, 1.0
# Four points of degree two (Hammer and Stroud 1956).
QUADRATURE = np.full((4, 4), (5 - np.sqrt(5)) / 20) + np.eye(4) * np.sqrt(5) / 5


def exact(points):
    """Displacement (n, 3) m."""
    x, z = points[..., 0], points[..., 2] - WIDTH / 2
    return np.stack([-CURVATURE * x * z, 0 * x, CURVATURE * x**2 / 2], axis=-1)


def end_loads(rest, faces):
    """Nodal forces (n, 3) N: the integral of N_i t over triangles with t linear between corners is
    area/12 (t_i + sum t_j)."""
    traction = -YOUNG * CURVATURE * (rest[faces][:, :, 2] - WIDTH / 2)
    areas = np.linalg.norm(area_vectors(rest, faces), axis=1)
    share = areas[:, None] / 12 * (traction + traction.sum(axis=1, keepdims=True))
    loads = np.zeros_like(rest)
    np.add.at(loads[:, 0], faces, share)
    return loads


def errors(folder, cells):
    """Relative errors in L2 and in energy, and the end's deflection (m)."""
    path = write_block(folder, (LENGTH, WIDTH, WIDTH), (cells, cells, cells))
    sim = sinew.load(body_scene(path, young=YOUNG, poisson=0.0, model="linear",
                                fixed=[{"set": "x_min"}], solver={"ordering": "metis"}))
    body = sim.body("body")
    rest, tetrahedra = np.array(body.rest_positions), np.array(body.tetrahedra)
    faces = boundary(tetrahedra)
    faces = faces[np.all(rest[faces][:, :, 0] > LENGTH - 1e-9, axis=1)]
    body.external_forces[:] = end_loads(rest, faces)
    sim.solve_static(tolerance=1e-12)
    moved = np.array(body.positions) - rest
    _, volumes = gradients(rest, tetrahedra)
    points = np.einsum("qa,eaj->eqj", QUADRATURE, rest[tetrahedra])
    ours = np.einsum("qa,eaj->eqj", QUADRATURE, moved[tetrahedra])
    square = np.einsum("e,eqj->", volumes, (ours - exact(points)) ** 2)
    norm = np.einsum("e,eqj->", volumes, exact(points) ** 2)
    energy = 0.5 * YOUNG * CURVATURE**2 * WIDTH**4 / 12 * LENGTH
    end = rest[:, 0] > LENGTH - 1e-9
    return (np.sqrt(square / norm), (energy - body.strain_energy) / energy,
            float(moved[end][:, 2].mean()))


def run(case):
    cells = [4, 8, 16, 24]
    sizes = np.array([WIDTH / c for c in cells])
    found = [errors(case.scratch, c) for c in cells]
    norm, energy, tips = (np.array(values) for values in zip(*found))
    case.check("order in L2, three finest meshes", observed_order(sizes[1:], norm[1:]), 2.0, 0.1,
               relative=False, source="Ciarlet 1978")
    case.check("order of the strain energy, three finest meshes", observed_order(sizes[1:], energy[1:]),
               2.0, 0.1, relative=False, source="Ciarlet 1978")
    limit = tips[3] + (tips[3] - tips[2]) / ((sizes[2] / sizes[3]) ** 2 - 1)
    case.check("end deflection, extrapolated with order 2", 1e3 * limit, 1e3 * CURVATURE * LENGTH**2 / 2,
               0.005, unit="mm", source="Timoshenko 1970")
    figure, axis = plots.axes()
    axis.loglog(sizes, norm, "o-", color=plots.OURS, label="displacement, L2")
    axis.loglog(sizes, energy, "s-", color=plots.SECOND, label="strain energy")
    plots.slope_line(axis, sizes, norm, 2)
    axis.set(xlabel="cell size (m)", ylabel="relative error")
    axis.legend()
    case.figure(figure, "Errors against cell size in pure bending.")
