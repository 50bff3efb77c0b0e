"""Affine patch test."""

import numpy as np
import sinew

from reference import corotational
from reference.tetrahedra import boundary, face_loads
from suite import plots
from suite.robots import body_scene

TITLE = "Affine patch test"
SETUP = """A block of 3 x 3 x 3 cells whose inner nodes are displaced at random by up to a quarter of a cell; E = 1 MPa, nu =
0.3. Three corners are held, and the nodal forces on the outside are those of a uniform stress, P N on every face. A
displacement u = a (n . x) leaves the three corners in place. Every node must follow it on any mesh. Nine pairs of a and n
span all strains. The corotational law is tested at 0.1 % and, since its stress is also uniform in an affine motion, at 20 %."""
SOURCES = {
    "Irons 1972": "B. M. Irons, A. Razzaque, Experience with the patch test for convergence of "
                  "finite elements, in: The Mathematical Foundations of the Finite Element Method, "
                  "Academic Press 1972, 557-587, doi:10.1016/B978-0-12-068650-6.50026-9",
}
COST = 1
YOUNG, POISSON, SIZE = 1e6, 0.3, 0.03


def irregular_block(folder):
    mesh = sinew.mesh.block((SIZE,) * 3, (3, 3, 3))
    nodes = np.array(mesh.nodes)
    inner = np.all((nodes > 1e-9) & (nodes < SIZE - 1e-9), axis=1)
    random = np.random.default_rng(1)
    nodes[inner] += random.uniform(-0.25, 0.25, (inner.sum(), 3)) * SIZE / 3
    import meshio
    path = folder / "irregular.vtu"
    meshio.Mesh(nodes, [("tetra", np.array(mesh.tetrahedra))]).write(path)
    return path


def corners(axis):
    """Three corners of the face through the origin on which x_axis = 0."""
    points = [np.zeros(3), np.zeros(3), np.zeros(3)]
    points[1][(axis + 1) % 3] = SIZE
    points[2][(axis + 2) % 3] = SIZE
    return [{"sphere": {"centre": p.tolist(), "radius": 1e-6}} for p in points]


def patch(path, model, axis, direction, strain):
    """Largest deviation from the affine motion / largest displacement."""
    sim = sinew.load(body_scene(path, young=YOUNG, poisson=POISSON, model=model,
                                fixed=corners(axis)))
    body = sim.body("body")
    rest = np.array(body.rest_positions)
    gradient = np.zeros((3, 3))
    gradient[direction, axis] = strain
    piola = corotational.stress(np.eye(3) + gradient, YOUNG, POISSON, model)
    tetrahedra = np.array(body.tetrahedra)
    body.external_forces[:] = face_loads(rest, boundary(tetrahedra), piola)
    sim.solve_static(tolerance=1e-13)
    wanted = rest @ gradient.T
    return np.abs(body.positions - rest - wanted).max() / np.abs(wanted).max()


def run(case):
    path = irregular_block(case.scratch)
    figure, axis = plots.axes()
    kinds = [("linear", 1e-3), ("corotational", 1e-3), ("corotational", 0.2)]
    colours = [plots.REFERENCE, plots.OURS, plots.SECOND]
    for (model, strain), colour in zip(kinds, colours):
        errors = [patch(path, model, n, a, strain) for n in range(3) for a in range(3)]
        case.identity(f"deviation from affine, {model}, {strain:.1%}", max(errors), 1e-10,
                      source="Irons 1972")
        axis.semilogy(range(9), errors, "o", color=colour, label=f"{model}, {strain:.1%}")
    axis.axhline(1e-10, color=plots.REFERENCE, ls="--", lw=1, label="tolerance")
    axis.set(xticks=range(9), ylim=(1e-17, 1e-8), ylabel="largest deviation / largest displacement",
             xlabel="motion: component of u, then the coordinate with which it grows")
    axis.set_xticklabels([f"{'xyz'[a]}{'xyz'[n]}" for n in range(3) for a in range(3)])
    axis.legend(ncol=2)
    case.figure(figure, "Deviation from every imposed affine motion.")
