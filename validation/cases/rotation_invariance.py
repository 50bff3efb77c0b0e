"""Rotation invariance of the corotational force."""

import numpy as np
import scipy.spatial.transform
import sinew

from suite import plots
from suite.robots import body_scene, write_block

TITLE = "Rotation invariance of the corotational force"
SETUP = """A free block of 3 x 2 x 2 cells, E = 1 MPa, nu = 0.45, is moved by 60 random rigid motions Q. In its rest shape it
must be free of forces. Strained at random (displacements of up to 20 % of a cell), its forces must turn with it, f(Q x) = Q
f(x), and the sums of forces and moments must vanish. Errors are relative to the largest nodal force of the strained block."""
SOURCES = {
    "Truesdell 1965": "C. Truesdell, W. Noll, The Non-Linear Field Theories of Mechanics, Springer "
                      "1965, section 19 (material frame-indifference), "
                      "doi:10.1007/978-3-662-10388-3",
}
COST = 1


def run(case):
    path = write_block(case.scratch, (0.03, 0.02, 0.02), (3, 2, 2))
    sim = sinew.load(body_scene(path, young=1e6, poisson=0.45, density=1000.0,
                                integrator="backward-euler"))
    body = sim.body("body")
    rest = np.array(body.rest_positions)
    random = np.random.default_rng(2)
    rigid, turned, total, moment, angles = [], [], [], [], []
    for _ in range(60):
        rotation = scipy.spatial.transform.Rotation.random(random_state=random)
        q = rotation.as_matrix()
        shift = random.uniform(-0.1, 0.1, 3)
        strained = rest + random.uniform(-0.2, 0.2, rest.shape) * 0.01
        force = np.array(body.internal_forces(strained))
        scale = np.abs(force).max()
        angles.append(np.degrees(rotation.magnitude()))
        rigid.append(np.abs(body.internal_forces(rest @ q.T + shift)).max() / scale)
        turned.append(np.abs(body.internal_forces(strained @ q.T + shift) - force @ q.T).max()
                      / scale)
        total.append(np.abs(force.sum(axis=0)).max() / scale)
        moment.append(np.abs(np.cross(strained, force).sum(axis=0)).max() / (scale * 0.03))
    source = "Truesdell 1965"
    case.identity("force of the rigidly moved block", max(rigid), 1e-12, source=source)
    case.identity("f(Q x) - Q f(x) of the strained block", max(turned), 1e-12, source=source)
    case.identity("sum of the forces", max(total), 1e-12, source=source)
    case.identity("sum of the moments", max(moment), 1e-12, source=source)
    figure, axis = plots.axes()
    axis.semilogy(angles, rigid, "o", color=plots.OURS, label="rigid motion: |f|")
    axis.semilogy(angles, turned, "s", color=plots.SECOND, mfc="none",
                  label="strained: |f(Q x) - Q f(x)|")
    axis.axhline(1e-12, color=plots.REFERENCE, ls="--", lw=1, label="tolerance")
    axis.set(xlabel="angle of the rotation (deg)", ylabel="error / largest nodal force",
             ylim=(1e-16, 1e-11))
    axis.legend(ncol=3, loc="upper left", fontsize=9)
    case.figure(figure, "Errors against the angle of the rigid motion.")
