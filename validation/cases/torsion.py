"""Torsion of a rubber cylinder: torque, axial force and elongation."""

import numpy as np
import sinew

from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Torsion of a rubber cylinder (Rivlin, Poynting)"
SETUP = """A cylinder whose radius and length are both A = 10 mm, nu_0 = 0.4999, neo-Hookean (C1 = 50 kPa) and Mooney-Rivlin
(C1 = 37.5 kPa, C2 = 12.5 kPa). Three force rows with commanded motions prescribe the position of every node of its top, which
turns rigidly by psi A radians. n is the number of rings of cells around the axis and of layers: mean-dilatation hexahedra,
and quadratic tetrahedra with straight edges (P2P0).

- **Fixed length**: the bottom is fixed, and torque and axial force are read from its reactions.
- **Stretched**: both ends are brought to the height lambda L and the radius A/sqrt(lambda).
- **Free length**: the secant method finds the lambda at which the axial force vanishes.

The references, with psi per stretched length, are derived independently from sigma = -p 1 + 2 C1 B - 2 C2 B^-1 with a free
side. The torque is exact up to the polygonal mesh; the axial force depends on the pressure, which is one number per element."""
SOURCES = {
    "Rivlin": "R. S. Rivlin, Phil. Trans. R. Soc. A 242 (1949) 173-195: M = pi psi A^4 (C1 + C2/lambda), "
              "N = 2 pi A^2 (lambda - 1/lambda^2)(C1 + C2/lambda) - pi psi^2 A^4 (C1 + 2 C2/lambda)/2; at lambda = 1 the "
              "Poynting effect, J. H. Poynting, Proc. R. Soc. A 82 (1909) 546-559",
    "equilibrium": "the moments on both ends of a body at rest",
}
COST = 150
A = 0.01
LAWS = {"neo-Hookean": (50e3, 0.0), "Mooney-Rivlin": (37.5e3, 12.5e3)}
TURNS = (0.25, 0.5, 0.75, 1.0)  # psi A
RINGS = {"hex8": (3, 4, 6, 8), "tet10": (2, 3, 4)}


def exact(law, twist, stretch=1.0):
    """Torque (N m) and axial force (N) at twist psi per stretched length (rad/m)."""
    c1, c2 = LAWS[law]
    torque = np.pi * twist * A**4 * (c1 + c2 / stretch)
    pull = 2 * np.pi * A**2 * (stretch - stretch**-2) * (c1 + c2 / stretch)
    return torque, pull - np.pi * twist**2 * A**4 * (c1 + 2 * c2 / stretch) / 2


class Rod:
    """A cylinder whose top, and with `both` also its bottom, has prescribed nodes."""

    def __init__(self, case, element, rings, law, both=False):
        c1, c2 = LAWS[law]
        mesh = {"shape": "cylinder", "radius": A, "height": A, "element_size": A / rings}
        if element == "tet10":  # the shape's own middle nodes lie on the circle, where rows cannot have points
            path = case.scratch / f"cylinder_{rings}.vtu"
            sinew.mesh.cylinder(radius=A, height=A, rings=rings, layers=rings).write(str(path))
            mesh = {"file": str(path), "unit": "m"}
        scene = {"sinew": 1, "solver": SOLVER, "bodies": {"rod": {
            "type": "fem", "element": element, "mesh": mesh,
            "material": {"model": "mooney-rivlin", "c10": c1, "c01": c2, "poisson_ratio": 0.4999},
            "fixed": [{"set": "bottom"}]}}}
        self.rest = np.array(sinew.load(scene).body("rod").rest_positions)
        self.top = np.flatnonzero(self.rest[:, 2] > A * (1 - 1e-9))
        self.bottom = np.flatnonzero(self.rest[:, 2] < 1e-9 * A)
        led = {(n, c) for n in self.top for c in range(3)}
        if both:
            scene["bodies"]["rod"]["fixed"] = [{"set": "bottom", "axes": "z"}]
            # fixes the bottom's stationary x axis, so the matrix without rows is regular
            still = {(n, c) for n in self.bottom for c in range(2) if abs(self.rest[n, c]) < 1e-9 * A
                     and abs(self.rest[n, 1]) < 1e-9 * A}
            scene["bodies"]["rod"]["fixed"] += [
                {"sphere": {"centre": self.rest[n].tolist(), "radius": 1e-6 * A}, "axes": "xy"[c]} for n, c in sorted(still)]
            led |= {(n, c) for n in self.bottom for c in range(2)} - still
        scene["actuators"] = {
            f"n{n}_{c}": {"type": "force", "body": "rod", "point": self.rest[n].tolist(), "outside": "nearest",
                          "direction": np.eye(3)[c].tolist(), "command": {"displacement": 0.0}}
            for n, c in sorted(led)}
        self.sim = sinew.load(scene)
        self.body = self.sim.body("rod")
        self.rows = {key: self.sim.actuator(f"n{key[0]}_{key[1]}") for key in led}

    def lead(self, angle, stretch=1.0):
        """Rotates the top by an angle and extends the cylinder to a stretch."""
        c, s = np.cos(angle), np.sin(angle)
        goal = self.rest / np.sqrt(stretch)
        goal[:, 2] = self.rest[:, 2] * stretch
        goal[self.top] = goal[self.top] @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        for (n, k), row in self.rows.items():
            row.displacement = float(goal[n, k] - self.rest[n, k])
        self.sim.solve_static()
        return self.driven()

    def driven(self):
        """Torque and axial force on the top."""
        torque = pull = 0.0
        at = np.array(self.body.positions)
        for n in self.top:
            fx, fy, fz = (self.rows[n, c].force for c in range(3))
            torque += at[n, 0] * fy - at[n, 1] * fx
            pull += fz
        return torque, pull

    def borne(self):
        """Torque and axial force on the fixed bottom, with the signs of the top."""
        at, force = np.array(self.body.positions)[self.bottom], np.array(self.body.reactions)[self.bottom]
        return -np.sum(at[:, 0] * force[:, 1] - at[:, 1] * force[:, 0]), -force[:, 2].sum()


def fixed_length(case, element, law):
    """Torque and axial force against twist on the finest mesh, and the errors at the last twist of all meshes."""
    errors = []
    for rings in RINGS[element]:
        rod = Rod(case, element, rings, law)
        found = []
        for turn in TURNS:
            driven = np.array(rod.lead(turn))
            found.append(rod.borne())
        expected = exact(law, TURNS[-1] / A)
        errors.append([abs(f / e - 1) for f, e in zip(found[-1], expected)])
    case.identity(f"{element}, {law}: torque and force on the top compared with the bottom, psi A = {TURNS[-1]:g}",
                  float(np.max(np.abs(driven / np.array(found[-1]) - 1))), 1e-6, source="equilibrium")
    for turn, pair in zip(TURNS, found):
        torque, force = exact(law, turn / A)
        if turn in (0.25, 1.0):
            name = f"{element}, n = {rings}, {law}, psi A = {turn:g}"
            case.check(f"{name}: torque", 1e3 * pair[0], 1e3 * torque, 0.01, unit="mN m", source="Rivlin")
            case.check(f"{name}: axial force", pair[1], force, 0.03, unit="N", source="Rivlin")
    return np.array(found), np.array(errors)


def stretched(case):
    rod, law, stretch = Rod(case, "hex8", 8, "Mooney-Rivlin", both=True), "Mooney-Rivlin", 1.25
    rod.lead(0.0, stretch)
    turn = 0.75
    rod.lead(turn / 2, stretch)
    found = rod.lead(turn, stretch)
    torque, force = exact(law, turn / (A * stretch), stretch)
    case.check(f"hex8, n = 8, {law}, stretch {stretch:g}, turn {turn:g}: torque", 1e3 * found[0], 1e3 * torque, 0.01,
               unit="mN m", source="Rivlin")
    case.check(f"hex8, n = 8, {law}, stretch {stretch:g}, turn {turn:g}: axial force", found[1], force, 0.01, unit="N",
               source="Rivlin")


def root(function, low, high):
    """Root of a smooth function by the secant method, to six digits."""
    a, b = low, high
    fa, fb = function(a), function(b)
    while abs(b - a) > 1e-6:
        a, b, fa = b, b - fb * (b - a) / (fb - fa), fb
        fb = function(b)
    return b


def free_length(case, element, rings):
    """Elongation at zero axial force, neo-Hookean."""
    rod, stretch = Rod(case, element, rings, "neo-Hookean", both=True), 1.0
    for turn in (0.5, 1.0):
        expected = root(lambda x: exact("neo-Hookean", turn / (A * x), x)[1], 1.0, 1.1)
        stretch = root(lambda x: rod.lead(turn, x)[1], stretch, expected)
    case.check(f"{element}, n = {rings}, neo-Hookean, free length, top turned by {turn:g}: elongation",
               100 * (stretch - 1), 100 * (expected - 1), 0.03, unit="%", source="Rivlin")


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    fine = np.linspace(0, 1, 50)
    for law, colour in zip(LAWS, (plots.OURS, plots.SECOND)):
        curve = np.array([exact(law, t / A) for t in fine])
        left.plot(fine, 1e3 * curve[:, 0], color=plots.REFERENCE, lw=1)
        middle.plot(fine, curve[:, 1], color=plots.REFERENCE, lw=1)
        for element, mark in (("hex8", "o"), ("tet10", "^")):
            found, errors = fixed_length(case, element, law)
            left.plot(TURNS, 1e3 * found[:, 0], mark, color=colour, label=f"{law}, {element}")
            middle.plot(TURNS, found[:, 1], mark, color=colour)
            if law != "neo-Hookean":
                continue
            sizes = [1 / n for n in RINGS[element]]
            for name, column, line in (("torque", 0, "-"), ("force", 1, "--")):
                right.loglog(sizes, errors[:, column], line + mark, color=colour if element == "hex8" else plots.THIRD,
                             label=f"{element}, {name}")
                order = observed_order(sizes, errors[:, column])
                if element == "hex8":
                    case.check(f"hex8: order of convergence, {name}", order, 2.0, 0.3, source="Rivlin", relative=False)
                else:
                    case.report(f"tet10: order of convergence, {name}", order, source="Rivlin")
    stretched(case)
    for element, rings in (("hex8", 8), ("tet10", 4)):
        free_length(case, element, rings)
    left.set(xlabel="psi A", ylabel="torque (mN m)")
    middle.set(xlabel="psi A", ylabel="axial force (N)")
    right.set(xlabel="1 / n", ylabel="relative error at psi A = 1")
    left.legend(fontsize=7)
    right.legend(fontsize=7)
    case.figure(figure, "Torque and axial force against twist at fixed length (lines: Rivlin), and convergence.")
