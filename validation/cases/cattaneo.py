"""A ball pressed on a half space and then pushed sideways: partial slip."""

import numpy as np
import sinew

from reference import shapes
from suite import plots

from .hertz import E, SPOT, core_cells, in_plane

TITLE = "Cattaneo and Mindlin: a ball in partial slip"
SETUP = """The rigid ball of the case hertz, a/R = 0.01, is pressed on rubber with nu = 0.49 and mu = 0.5 and then pushed
along x. A half ball of radius 400 a, y >= 0, is meshed. The theory neglects the interaction of normal and tangential
tractions, which vanishes at nu = 0.5. With x = Q/(mu P), a disc of radius c = a (1 - x)^(1/3) sticks, and the ball moves by
d_t = 3 mu P S/(16 a) (1 - (1 - x)^(2/3)), S = (2 - nu)/G.

P, Q and a are taken from the simulation, a from the second moment of the normal forces, 2/5 P a^2. The remaining capacity of
friction, mu p - |q|, is that of a smaller ball on the stick disc, so c follows from its second moment in the same way. The
disc with the area of the sticking nodes is reported. Then the ball moves to and fro between +-d_t, and the area of the loop
of Q over d_t, by Simpson's rule, is compared with the theoretical loss per cycle. The boundary of the half ball reduces d_t
by about 0.25 %, which is not corrected."""
SOURCES = {"Mindlin": "C. Cattaneo, Rend. Accad. Naz. Lincei 27 (1938) 342; R. D. Mindlin, Compliance of elastic bodies in contact, J. Appl. Mech. "
                      "16 (1949) 259-268; K. L. Johnson, Contact Mechanics, 1985, sec. 7.2",
           "Deresiewicz": "R. D. Mindlin, H. Deresiewicz, Elastic spheres in contact under varying oblique forces, J. Appl. Mech. 20 (1953) "
                          "327-344; Johnson sec. 7.4: 9 mu^2 P^2 S/(10 a) (1 - (1-x)^(5/3) - 5x/6 (1 + (1-x)^(2/3)))"}
COST = 60
POISSON, FRICTION, RADIUS = 0.49, 0.5, SPOT / 0.01
SHEAR = (2.0 - POISSON) * 2.0 * (1.0 + POISSON) / E  # S
MOST = 3.0 / 16.0 * FRICTION / SPOT * SHEAR * 4.0 / 3.0 * E / (1.0 - POISSON**2) * SPOT**3 / RADIUS  # d_t at full slip
PRESS = 3  # number of 1 s steps that press the ball down


def moved(fraction):
    """d_t / d_t at full slip, for a fraction of the friction limit."""
    return 1.0 - (1.0 - fraction)**(2.0 / 3.0)


class Push:
    """A ball that is pressed down and then displaced by `ways`, in units of MOST, one per step."""

    def __init__(self, case, cells, ways):
        spacing = SPOT / cells
        path = shapes.half_ball(case.scratch / "half.vtu", core_cells(cells) * spacing, core_cells(cells), 400.0 * SPOT, whole=True)
        table = case.scratch / "ways.csv"
        times = [0, *range(PRESS, PRESS + len(ways) + 1)]
        table.write_text("".join(f"{t},{way * MOST:.17g}\n" for t, way in zip(times, [0.0, 0.0, *ways])))
        self.sim = sinew.load({
            "sinew": 1, "time_step": 1.0, "solver": {"ordering": "metis"},
            "bodies": {"block": {"type": "fem", "mesh": {"file": str(path), "unit": "m"}, "fixed": [{"set": "far"}, in_plane("y")],
                                 "material": {"model": "neo-hookean", "young_modulus": E, "poisson_ratio": POISSON}}},
            "contacts": {"ball": {"body": "block", "nodes": {"set": "core"}, "friction": FRICTION,
                                  "surface": {"sphere": {"centre": [0, 0, RADIUS], "radius": RADIUS}},
                                  "motion": {"z": {"ramp": {"to": -SPOT**2 / RADIUS, "duration": PRESS}}, "x": {"file": str(table)}}}}})
        self.contact = self.sim.contact("ball")
        self.sim.step(PRESS)
        at = np.asarray(self.contact.positions)
        self.distance = np.hypot(at[:, 0], at[:, 1])
        self.share = spacing**2 / 2.0**(np.abs(at[:, 1]) < 0.25 * spacing)
        self.ways = ways

    def radius(self, forces):
        """Radius (m) of a disc whose Hertzian pressure has the second moment of these forces."""
        return np.sqrt(2.5 * forces @ self.distance**2 / forces.sum())

    def steps(self):
        """(k, 6): d_t (m), P (N), Q (N), a (m), c (m) from tractions, c (m) from the nodes' states."""
        seen = []
        for way in self.ways:
            self.sim.step()
            normal, along = np.asarray(self.contact.normal_forces), np.asarray(self.contact.friction_forces)
            left = FRICTION * normal - np.linalg.norm(along, axis=1)
            sticks = np.array(self.contact.states) == "stick"
            seen.append([way * MOST, 2.0 * normal.sum(), 2.0 * along[:, 0].sum(), self.radius(normal), self.radius(left),
                         np.sqrt(2.0 * self.share[sticks].sum() / np.pi)])
        return np.array(seen)


def pushes(case, convergence, stick):
    fractions, sizes, errors = np.array([0.2, 0.5, 0.8]), (2, 4, 8), []
    for cells in sizes:
        way, normal, tangential, spot, disc, nodes = Push(case, cells, moved(fractions)).steps().T
        x = tangential / (FRICTION * normal)
        theory = 3.0 / 16.0 * FRICTION * normal / spot * SHEAR * moved(x)
        errors.append([abs(way[1] / theory[1] - 1.0), abs(disc[1] / spot[1] / np.cbrt(1.0 - x[1]) - 1.0)])
        stick.plot(x, disc / spot, "o", ms=2 + cells // 2, mfc="none", color=plots.OURS, label="a/h = 8, tractions" if cells == 8 else None)
    for k in range(3):
        case.check(f"x = {x[k]:.3f}: displacement d_t", 1e3 * way[k], 1e3 * theory[k], 0.02, source="Mindlin", unit="mm")
        case.check(f"x = {x[k]:.3f}: stick radius c/a, from tractions", disc[k] / spot[k], np.cbrt(1.0 - x[k]), 0.03, source="Mindlin")
        case.report(f"x = {x[k]:.3f}: c/a from the area of sticking nodes", nodes[k] / spot[k], reference=np.cbrt(1.0 - x[k]), source="Mindlin")
    stick.plot(x, nodes / spot, "x", color=plots.SECOND, label="a/h = 8, sticking nodes")
    fine = np.linspace(0.0, 1.0, 200)
    stick.plot(fine, np.cbrt(1.0 - fine), color=plots.REFERENCE, lw=1, label="Cattaneo, Mindlin")
    stick.set(xlabel="Q / (mu P)", ylabel="c / a")
    stick.legend()
    for k, (name, color) in enumerate((("d_t", plots.OURS), ("c / a", plots.SECOND))):
        convergence.loglog([1.0 / n for n in sizes], np.array(errors)[:, k], "o-", color=color, label=f"{name}, x = 0.5")
    convergence.set(xlabel="h / a", ylabel="relative error")
    convergence.legend()


def simpson(values, spacing):
    return spacing / 3.0 * (values[0] + 4.0 * values[1:-1:2].sum() + 2.0 * values[2:-1:2].sum() + values[-1])


def cycles(case, axis):
    count, top = 8, moved(0.7)
    there = np.linspace(0.0, top, 4)[1:]
    back = np.linspace(top, -top, count + 1)[1:]
    way, normal, tangential, spot, _, _ = Push(case, 6, np.concatenate([there, back, -back])).steps().T
    first, last = len(there) - 1, len(way) - 1
    spacing = 2.0 * top * MOST / count
    loss = simpson(tangential[first + count:], spacing) - simpson(tangential[first:first + count + 1][::-1], spacing)
    limit = FRICTION * normal[last]
    x, factor = tangential[last] / limit, 9.0 / 10.0 * limit**2 / spot[last] * SHEAR
    theory = factor * (1.0 - (1.0 - x)**(5.0 / 3.0) - 5.0 * x / 6.0 * (1.0 + (1.0 - x)**(2.0 / 3.0)))
    case.check(f"loss of a cycle between +-Q, x = {x:.3f}, a/h = 6", 1e9 * loss, 1e9 * theory, 0.03, source="Deresiewicz", unit="nJ")
    case.check("Q after a cycle / Q before", tangential[last] / tangential[first], 1.0, 2e-3, source="Deresiewicz")
    full = 3.0 / 16.0 * limit / spot[last] * SHEAR
    fall = np.linspace(x, -x, 100)
    back = full * (2.0 * moved((x - fall) / 2.0) - moved(x))
    for sign in (1.0, -1.0):
        axis.plot(-1e3 * sign * back, sign * fall, color=plots.REFERENCE, lw=1, label="Mindlin, Deresiewicz" if sign > 0 else None)
    axis.plot(1e3 * way, tangential / limit, "o", ms=3, color=plots.OURS, label="Sinew")
    axis.set(xlabel="d_t (mm)", ylabel="Q / (mu P)")
    axis.legend()


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    pushes(case, left, middle)
    cycles(case, right)
    case.figure(figure, "Left: errors of displacement and stick radius, 2 to 8 cells over a. Middle: stick radius; larger circles: finer meshes. Right: "
                        "a cycle between +-Q.")
