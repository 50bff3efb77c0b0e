"""A block pushed up a wedge, and a belt on a drum: finite elements in full slip."""

import numpy as np
import sinew

from reference import shapes
from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Friction of finite elements: the wedge of CGS-4, a belt on a drum"
SETUP = """- A block of 40 x 40 x 20 mm, 1 MPa, of weight W is pushed up a wedge of slope 0.1 by a horizontal force at its centre. The
  displacement is commanded at 20 mm/s, in backward Euler steps of 1 ms: F/W = (tan a + mu)/(1 - mu tan a) (geometry and loads
  of NAFEMS CGS-4, with one deformable block on a rigid plane).
- A belt, 1 MPa, 0.1 to 0.4 mm thick, lies on a rigid drum, R = 20 mm, with a straight tail at both ends. Hexahedra in plane
  strain, one through the thickness; 60 elements around half the drum and t/R = 0.01 unless stated otherwise. One end is held,
  the other is pulled in 20 quasi-static steps until the strain is 0.2 %, so that the whole belt slips. On a thin belt T1/T2
  is e^(mu theta), with T2 the reaction. Friction acts at R and the tension at R + t/2; the balance of moments about the axis
  gives the exponent mu theta R/(R + t/2), which is compared."""
SOURCES = {"NAFEMS": "NAFEMS, Benchmark tests for contact and gap elements (CGS-4), by the closed form (tan a + mu)/(1 - mu tan a)",
           "Euler": "L. Euler 1762: T1/T2 = e^(mu theta); with the moment of friction about the axis, dT (R + t/2) = mu T R dtheta"}
COST = 20
G, RADIUS, WIDE, YOUNG, STRAIN = 9.81, 0.02, 0.01, 1e6, 2e-3


def pushed(friction, slope=0.1):
    """F / weight, after 0.6 s."""
    angle = np.arctan(slope)
    along = [np.cos(angle), 0.0, -np.sin(angle)]  # horizontal, in axes of the wedge
    sim = sinew.load({
        "sinew": 1, "integrator": "backward-euler", "time_step": 1e-3, "solver": SOLVER, "gravity": [-G * np.sin(angle), 0.0, -G * np.cos(angle)],
        "bodies": {"block": {"type": "fem", "density": 1000.0, "damping": {"stiffness": 0.002},
                             "material": {"model": "corotational", "young_modulus": 1e6, "poisson_ratio": 0.3},
                             "mesh": {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.02, "element_size": 0.01}}},
        "contacts": {"wedge": {"body": "block", "nodes": {"set": "z_min"}, "friction": friction, "surface": {"plane": {}}}},
        "actuators": {"push": {"type": "force", "body": "block", "point": [0.02, 0.02, 0.01], "direction": along,
                               "command": {"displacement": {"ramp": {"to": 0.02, "duration": 1.0}}}}}})
    sim.step(600)
    return sim.actuator("push").force / (sim.body("block").mass * G)


class Belt:
    """A belt pulled at its end; each tail has an eighth as many elements as the wrap."""

    def __init__(self, case, friction, degrees, count=60, slender=0.01, tail=None):
        self.wrap, self.friction, self.thick = np.radians(degrees), friction, slender * RADIUS
        tail = count // 8 if tail is None else tail
        length = self.wrap * RADIUS / count
        points = []
        for i in range(-tail, count + tail + 1):
            turn, out = self.wrap * np.clip(i / count, 0.0, 1.0), length * (min(i, 0) + max(i - count, 0))
            for radius in (RADIUS, RADIUS + self.thick):
                points += [(radius * np.sin(turn) + out * np.cos(turn), y, radius * np.cos(turn) - out * np.sin(turn)) for y in (0.0, WIDE)]
        cells = [[b, b + 4, b + 5, b + 1, b + 2, b + 6, b + 7, b + 3] for b in range(0, len(points) - 4, 4)]
        number = np.arange(len(points))
        path = shapes.write_hexahedra(case.scratch / "belt.vtu", points, cells,
                                      {"held": number < 4, "inner": (number % 4 < 2) & (number >= 4)})
        self.sim = sinew.load({
            "sinew": 1, "time_step": 1.0, "solver": SOLVER,
            "bodies": {"belt": {"type": "fem", "mesh": {"file": str(path), "unit": "m"},
                                "fixed": [{"set": "held"}, {"box": [-1, -1, -1, 1, 1, 1], "axes": "y"}],
                                "material": {"model": "neo-hookean", "young_modulus": YOUNG, "poisson_ratio": 0.3}}},
            "contacts": {"drum": {"body": "belt", "nodes": {"set": "inner"}, "friction": friction,
                                  "surface": {"capsule": {"ends": [[0, -1, 0], [0, 1, 0]], "radius": RADIUS}}}}})

    def ratio(self, steps=20):
        """T1/T2."""
        body, pull = self.sim.body("belt"), STRAIN * YOUNG * self.thick * WIDE
        forces = np.zeros_like(body.positions)
        for k in range(1, steps + 1):
            forces[-4:] = 0.25 * pull * k / steps * np.array([np.cos(self.wrap), 0.0, -np.sin(self.wrap)])
            body.external_forces = forces
            self.sim.step()
        return pull / np.linalg.norm(body.reactions[:4].sum(axis=0))

    def euler(self):
        return np.exp(self.friction * self.wrap / (1.0 + 0.5 * self.thick / RADIUS))

    def profile(self):
        """Angles (rad) and the tension T / T1 behind each, by summing the friction along the belt."""
        drum = self.sim.contact("drum")
        at, force = np.asarray(drum.positions), np.asarray(drum.friction_forces)
        angle = np.arctan2(at[:, 0], at[:, 2]) % (2.0 * np.pi)
        along = force[:, 0] * np.cos(angle) - force[:, 2] * np.sin(angle)
        order = np.argsort(angle)
        touching = order[np.abs(along[order]) > 0.0]
        tension = 1.0 + np.cumsum(along[touching][::-1])[::-1] / (STRAIN * YOUNG * self.thick * WIDE)
        return angle[touching], tension


def wedges(case):
    for friction in (0.0, 0.1, 0.2, 0.3):
        case.check(f"wedge, mu = {friction:g}: F/W", pushed(friction), (0.1 + friction) / (1.0 - 0.1 * friction), 1e-4, source="NAFEMS")


def belts(case, left):
    for friction, degrees, color in ((0.2, 180, plots.THIRD), (0.3, 90, plots.QUIET), (0.3, 180, plots.OURS), (0.3, 270, plots.SECOND),
                                     (0.5, 180, plots.REFERENCE)):
        belt = Belt(case, friction, degrees)
        ratio = belt.ratio()
        case.check(f"belt, mu = {friction:g}, {degrees} degrees: T1/T2", ratio, belt.euler(), 0.01, source="Euler")
        angle, tension = belt.profile()
        left.semilogy(np.degrees(belt.wrap - angle), tension, ".", ms=3, color=color, label=f"mu = {friction:g}, {degrees} degrees")
        left.semilogy([0, degrees], [1.0, 1.0 / belt.euler()], color=color, lw=1)
    left.set(xlabel="angle behind the pull (degrees)", ylabel="T / T1")
    left.legend(fontsize=7)


def converge(case, axis):
    sizes = (15, 30, 60, 80)
    for slender, color in ((0.02, plots.SECOND), (0.01, plots.OURS), (0.005, plots.THIRD)):
        errors = []
        for count in sizes:
            belt = Belt(case, 0.3, 180, count, slender)
            errors.append(abs(belt.ratio() / belt.euler() - 1.0))
        axis.loglog(sizes, errors, "o-", color=color, label=f"t/R = {slender:g}")
        if slender == 0.01:
            case.report("belt, t/R = 0.01: order in the element", observed_order([1.0 / n for n in sizes], errors), source="Euler")
    axis.set(xlabel="elements around half the drum, mu = 0.3", ylabel="relative error of T1/T2")
    axis.legend()


def without_tails(case):
    """A belt that is clamped at the start of the drum."""
    belt = Belt(case, 0.3, 342, tail=0)
    case.check("belt, mu = 0.3, 342 degrees, without tails: T1/T2", belt.ratio(), belt.euler(), 0.02, source="Euler")


def run(case):
    wedges(case)
    figure, (left, right) = plots.axes(2)
    belts(case, left)
    converge(case, right)
    without_tails(case)
    case.figure(figure, "Left: tension along the belt, from the friction of its nodes; lines: e^(-mu theta R/(R + t/2)). Right: errors "
                        "over elements.")
