"""W compared with finite differences of the nonlinear statics, reciprocity, and the corotated tangent."""

import numpy as np
import sinew

from suite import plots
from suite.robots import own_trunk, published_trunk

TITLE = "Compliance W: finite differences, reciprocity, and the corotated tangent"
SETUP = """The trunk of examples/trunk has point forces on its tip and is bent by the tension of one cable to several
deflections. Each column of W, with the exact tangent and the cables' geometric stiffness, is compared with central
differences of static equilibria whose efforts differ by a relative 1e-4. W must be symmetric (Maxwell-Betti). For comparison,
the error of the tip compliance with the corotated tangent and without geometric stiffness is reported; it is not scored."""
SOURCES = {
    "differences": "central differences of solve_static, this suite",
    "Betti 1872": "E. Betti, Teoria della elasticita, Il Nuovo Cimento 7 (1872) 5-21, "
                  "doi:10.1007/BF02824597",
    "corotated tangent": "M. Mueller, M. Gross, Interactive Virtual Materials, Graphics Interface "
                       "2004, section 3: rotation held fixed; no reference for its error",
    "published mesh": "trunk.vtk of SofaDefrost/SofaGym; compliance by Sinew's own linear "
                      "tetrahedra and an independent assembly, E = 450 kPa, nu = 0.45",
}
COST = 3
TENSIONS = (0.5, 2.0, 4.0, 7.0)  # N, of cable long_0


def settle(sim, tension):
    sim.actuator("long_0").tension = tension
    sim.solve_static(tolerance=1e-12)


def deltas(sim):
    """delta of every row at the present state."""
    return np.array(sim.linearise().delta)


def compare(sim, tension):
    """Largest relative error of a column of W, deflection (m), and W with the exact and the corotated tangent."""
    settle(sim, tension)
    rest = np.array([0.0, 0.0, 0.195])
    bend = np.linalg.norm(np.array(sim.effector("tip").position) - rest)
    lin = sim.linearise(tangent="exact", geometric_stiffness=True)
    rows, w = lin.rows, np.array(lin.W)
    rough = np.array(sim.linearise(tangent="corotated", geometric_stiffness=False).W)
    worst = 0.0
    for name in ("long_0", "tip_x", "tip_y", "tip_z"):
        actuator = sim.actuator(name)
        attribute = "tension" if name == "long_0" else "force"
        base = tension if name == "long_0" else 0.0
        step = 1e-4 * tension if name == "long_0" else 1e-5
        column = []
        for sign in (1, -1):
            setattr(actuator, attribute, base + sign * step)
            sim.solve_static(tolerance=1e-12)
            column.append(deltas(sim))
        setattr(actuator, attribute, base)
        sim.solve_static(tolerance=1e-12)
        difference = (column[0] - column[1]) / (2 * step)
        index = next(k for k, row in enumerate(rows) if row.startswith(name))
        worst = max(worst, np.linalg.norm(w[:, index] - difference) / np.linalg.norm(difference))
    return worst, bend, w, rough, rows


def tip_block(w, rows):
    at = [next(k for k, row in enumerate(rows) if row.startswith(name))
          for name in ("tip_x", "tip_y", "tip_z")]
    return w[np.ix_(at, at)]


def run(case):
    sim = sinew.load(own_trunk(tip_forces=True))
    bends, off = [], []
    for tension in TENSIONS:
        worst, bend, w, rough, rows = compare(sim, tension)
        bends.append(1e3 * bend)
        case.bound(f"W and differences, long_0 at {tension:g} N", worst, 1e-5,
                   source="differences", remark="largest column error, relative")
        case.identity(f"|W - W^T| / |W| at {tension:g} N", np.linalg.norm(w - w.T)
                      / np.linalg.norm(w), 1e-10, source="Betti 1872")
        exact, fast = tip_block(w, rows), tip_block(rough, rows)
        off.append(100 * np.linalg.norm(fast - exact) / np.linalg.norm(exact))
        case.report(f"corotated tangent: error of the tip compliance at a tip deflection of {1e3 * bend:.0f} mm",
                    off[-1], unit="%", source="corotated tangent")
    published(case)
    figure, axis = plots.axes()
    axis.plot(bends, off, "o-", color=plots.OURS)
    axis.set(xlabel="deflection of the tip (mm)", ylabel="error of the tip compliance (%)")
    case.figure(figure, "The error of the tip compliance with the corotated tangent grows with deflection.")


def published(case):
    scene = published_trunk(tip_forces=True, model="linear")
    quantity = "published trunk mesh, linear: tip deflection under 1 mN"
    if scene is None:
        case.skip(quantity, "the published mesh is not present", source="published mesh")
        return
    for row in scene["actuators"].values():
        if row["type"] == "force":
            row["outside"] = "nearest"
    scene["effectors"]["tip"]["outside"] = "nearest"
    sim = sinew.load(scene)
    sim.actuator("tip_x").force = 1e-3
    sim.solve_static()
    moved = np.array(sim.effector("tip").position)[0]
    case.check(quantity, 1e3 * moved, 6.75, 0.01, unit="mm", source="published mesh")
