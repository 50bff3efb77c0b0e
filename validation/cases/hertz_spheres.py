"""Two elastic balls pressed on each other."""

import numpy as np
import sinew
from scipy.interpolate import LinearNDInterpolator

from reference import shapes
from suite import plots
from suite.case import observed_order

from .hertz import core_cells, in_plane, stretched

TITLE = "Hertz: two elastic balls pressed on each other"
SETUP = """The lower half of one ball and the upper half of another are held in z at their mid-planes, and one mid-plane moves
towards the other: contact of two deformable bodies without friction. Geometry and material are those of SSNV104, R = 50 mm, E
= 20 GPa, nu = 0.3, hexahedra of neo-Hookean material.

- A quarter of both balls, d = 10 um, a/R = 0.01: 2 to 6 cells over the contact radius on both balls.
- The same depth with balls of 50 and 100 mm, of 20 and 60 GPa, nu = 0.45 and 0.3, with 5 and 4 cells over the radius, which
  do not match anywhere.
- SSNV104 itself, d = 4 mm, a/R = 0.2, and a quarter of that depth, with whole half balls and 4 cells. Here the theory (half
  spaces, small strain) is off by about (a/R)^2 = 4 % at the same force. At the same depth, half balls whose mid-planes stay
  plane are stiffer.

The nodal forces are the internal forces that the contact has to balance; unlike the forces of single contact points they are
unique. The contact radius follows from their second moment, 2/5 F a^2, the peak pressure from the force at the pole and the
deformed area that belongs to it. Surfaces in contact rest at a separation of 1e-7 of the size, and the balls start there.
Their final overlap, node against surface, is measured as well."""
SOURCES = {"Hertz": "H. Hertz 1882; K. L. Johnson, Contact Mechanics, 1985, sec. 4.2: F = 4/3 E* sqrt(R) d^1.5, a = sqrt(R d), p0 = 2 E*/pi "
                    "sqrt(d/R), 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2, 1/R = 1/R_1 + 1/R_2",
           "SSNV104": "Code_Aster V6.04.104, SSNV104, two elastic spheres under 4 mm: p0 = E/(pi (1 - nu^2)) sqrt(2 d/R) = 2798.3 MPa"}
COST = 30
RADIUS, YOUNG, POISSON = 0.05, 20e9, 0.3


def centre_of(height):
    """The central node of a ball's mid-plane; a base motion requires a node that is held in all directions."""
    small = 1e-4 * RADIUS
    return {"box": [-small, -small, height - small, small, small, height + small]}


class Balls:
    """Force and peak pressure relative to Hertz's at the same depth, contact radius relative to Hertz's at the same force."""

    def __init__(self, case, cells, slender=0.01, radii=(RADIUS, RADIUS), young=(YOUNG, YOUNG), poisson=(POISSON, POISSON), whole=False):
        spot = slender * RADIUS
        self.radius = 1.0 / sum(1.0 / radius for radius in radii)
        self.modulus = 1.0 / sum((1.0 - nu**2) / stiff for nu, stiff in zip(poisson, young))
        self.depth, self.whole, self.radii = spot**2 / self.radius, whole, radii
        self.apart = 2e-7 * max(radii)
        bodies = {}
        for name, count, radius, stiff, nu in zip(("low", "up"), cells, radii, young, poisson):
            core = core_cells(count) * 0.5 * spot / count  # rounded() doubles lengths at the pole
            path = shapes.half_ball(case.scratch / "flat.vtu", core, core_cells(count), radius)
            path = shapes.rounded(case.scratch / f"{name}.vtu", path, radius, turned=name == "up")
            if whole:
                path = shapes.completed(path, path)
            bodies[name] = {"type": "fem", "mesh": {"file": str(path), "unit": "m"},
                            "fixed": [{"set": "far", "axes": "z"}, in_plane("x"), in_plane("y"), centre_of(radius if name == "up" else -radius)],
                            "material": {"model": "neo-hookean", "young_modulus": stiff, "poisson_ratio": nu}}
        steps = 4 if whole else 2
        bodies["up"] |= {"pose": {"position": [0, 0, self.apart]}, "motion": {"z": {"ramp": {"to": -self.depth, "duration": 1.0}}}}
        self.sim = sinew.load({"sinew": 1, "time_step": 1.0 / steps, "solver": {"ordering": "metis", "tolerance": 1e-9}, "bodies": bodies,
                               "contacts": {"press": {"between": ["low", "up"]}}})
        self.sim.step(steps)
        self.measure(spot)

    def nodes(self, name, reach):
        """Positions and forces (N) of the round face's nodes within the radius `reach` (m)."""
        body, side = self.sim.body(name), 1.0 if name == "up" else -1.0
        radius = self.radii[name == "up"]
        rest = body.rest_positions - [0.0, 0.0, (self.apart if side > 0.0 else 0.0) + side * radius]
        round_face = np.abs(np.linalg.norm(rest, axis=1) / radius - 1.0) < 1e-9
        at, force = body.positions, side * body.internal_forces()[:, 2]
        seen = round_face & (np.hypot(at[:, 0], at[:, 1]) < reach)
        return at[seen], np.abs(force[seen])

    def measure(self, spot):
        force = np.abs(self.sim.contact("press").force[2]) * (1.0 if self.whole else 4.0)
        self.force = force / (4.0 / 3.0 * self.modulus * np.sqrt(self.radius) * self.depth**1.5)
        wanted = np.cbrt(0.75 * force * self.radius / self.modulus)
        highest = 2.0 * self.modulus / np.pi * np.sqrt(self.depth / self.radius)
        self.spots, self.peaks, self.profiles = [], [], []
        for name in ("low", "up"):
            at, forces = self.nodes(name, 1.3 * spot)
            distance = np.hypot(at[:, 0], at[:, 1])
            self.spots.append(np.sqrt(2.5 * forces @ distance**2 / forces.sum()) / wanted)
            close = 0.01 * spot
            axis = at[(np.abs(at[:, 1]) < close) & (at[:, 0] > close), 0]
            share = axis.min()**2 * (1.0 if self.whole else 0.25)
            self.peaks.append(forces[np.argmin(distance)] / share / highest)
            self.profiles.append((distance, forces))
        self.highest = highest
        low, up = self.nodes("low", 1.3 * spot)[0], self.nodes("up", 1.3 * spot)[0]
        low = low[np.hypot(low[:, 0], low[:, 1]) < 0.9 * spot]  # nearly flat region, where the diagonal of a face does not matter
        over = low[:, 2] - LinearNDInterpolator(up[:, :2], up[:, 2])(low[:, 0], low[:, 1])
        self.overlap = max(0.0, np.nanmax(over))

    @property
    def spot(self):
        return np.mean(self.spots)

    @property
    def peak(self):
        return np.mean(self.peaks)


def convergence(case, axis):
    sizes = (2, 3, 4, 6)
    seen = [Balls(case, (cells, cells)) for cells in sizes]
    finest = seen[-1]
    case.check("equal balls, 6 cells over a: force / Hertz's", finest.force, 1.0, 0.01, source="Hertz")
    case.check("equal balls, 6 cells over a: peak pressure / Hertz's", finest.peak, 1.0, 0.02, source="Hertz")
    case.check("equal balls, 6 cells over a: contact radius / Hertz's at the same force", finest.spot, 1.0, 0.01, source="Hertz")
    case.check("equal balls: order of the contact radius in h", observed_order([1.0 / n for n in sizes], [ball.spot - 1.0 for ball in seen]), 2.0, 0.5,
               source="Hertz", relative=False)
    case.bound("equal balls: overlap of the surfaces / d, largest of all meshes", max(ball.overlap / ball.depth for ball in seen), 1e-4, source="Hertz")
    for name, mark, color in (("force", "o-", plots.OURS), ("peak", "s--", plots.SECOND), ("spot", "^:", plots.THIRD)):
        axis.loglog([1.0 / n for n in sizes], [abs(getattr(ball, name) - 1.0) for ball in seen], mark, color=color, label=name)
    return finest


def unequal(case):
    balls = Balls(case, (5, 4), radii=(RADIUS, 2.0 * RADIUS), young=(YOUNG, 3.0 * YOUNG), poisson=(0.45, 0.3))
    case.check("unequal balls, 5 and 4 cells over a: force / Hertz's", balls.force, 1.0, 0.02, source="Hertz")
    case.check("unequal balls, 5 and 4 cells over a: contact radius / Hertz's at the same force", balls.spot, 1.0, 0.02, source="Hertz")
    case.bound("unequal balls: overlap of the surfaces / d", balls.overlap / balls.depth, 1e-3, source="Hertz")


def deep(case):
    for slender, known in ((0.1, ""), (0.2, "plane mid-planes and the neo-Hookean law make the balls stiffer than half spaces at small strain")):
        balls, name = Balls(case, (4, 4), slender=slender, whole=True), f"SSNV104's balls, d = {100.0 * slender**2:g} mm, a/R = {slender:g}"
        case.check(f"{name}: peak pressure", 1e-6 * balls.peak * balls.highest, 2798.3 * slender / 0.2, 0.05, source="SSNV104", unit="MPa",
                   known_miss=known)
        case.check(f"{name}: peak pressure / Hertz's at the same force", balls.peak / np.cbrt(balls.force), 1.0, 0.04, source="Hertz")
        case.check(f"{name}: contact radius / Hertz's at the same force", balls.spot, 1.0, 0.04, source="Hertz")
        case.report(f"{name}: force / Hertz's at the same depth", balls.force, reference=1.0, source="Hertz")
        case.bound(f"{name}: overlap of the surfaces / d", balls.overlap / balls.depth, 1e-4, source="SSNV104")
    quarter = Balls(case, (4, 4), slender=0.2)
    case.bound("SSNV104 as a quarter: overlap of the surfaces / d", quarter.overlap / quarter.depth, 1e-4, source="SSNV104")


def run(case):
    figure, (left, right) = plots.axes(2)
    finest = convergence(case, left)
    unequal(case)
    deep(case)
    left.set(xlabel="h / a, balls of equal meshes", ylabel="relative error")
    left.legend()
    at, forces = finest.nodes("low", 1.3e-2 * RADIUS)
    spacing = 0.01 * RADIUS / 6
    inside = np.maximum(at[:, 0], at[:, 1]) < 1.2e-2 * RADIUS
    pressure = forces[inside] / (stretched(at[inside, 0], spacing) * stretched(at[inside, 1], spacing)) / finest.highest
    right.plot(np.hypot(*at[inside, :2].T) / (0.01 * RADIUS), pressure, ".", color=plots.OURS, label="6 cells over a")
    fine = np.linspace(0.0, 1.0, 200)
    right.plot(fine, np.sqrt(1.0 - fine**2), color=plots.REFERENCE, lw=1, label="Hertz")
    right.set(xlabel="r / a", ylabel="p / p0", xlim=(0.0, 1.4))
    right.legend()
    case.figure(figure, "Left: errors of force, peak pressure and contact radius. Right: pressure on the lower ball.")
