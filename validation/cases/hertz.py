"""A rigid ball, and a rigid cylinder, pressed on an elastic half space."""

import numpy as np
import sinew

from reference import shapes
from reference.half_space import lost_to_the_border
from suite import plots
from suite.case import observed_order

TITLE = "Hertz: a rigid ball and a rigid cylinder pressed on an elastic half space"
SETUP = """**Ball.** A rigid ball, R = 100 mm, is pressed d = 10 um deep without friction into hexahedra of neo-Hookean
rubber, E = 100 kPa, nu = 0.3 and 0.45. a = sqrt(R d) = 1 mm, and with a/R = 0.01 strains are small. A quarter of a half ball
of radius L = 50 a, fixed at its boundary, represents the half space. The cells are uniform, h = a/2 to a/8, out to 1.25 a and
grow beyond. Such a half ball yields less than the half space by c F/(4 pi G L), c = 2.37 and 2.58, computed from harmonic
functions (reference/half_space.py). For the same force d is 1.4 % smaller, and is corrected by this amount. The pressure at a
node is its force divided by the deformed area that belongs to it. The contact radius follows from the second moment of the
forces, 2/5 F a^2.

**Cylinder.** R = 100 mm on half a disc in plane strain, compared at equal force per length: a^2 = 4 F R/(pi E*), p0 = 2 F/(pi
a), second moment 1/4 F a^2. Its depth depends on the boundary and is not compared. The same is done with the load of NAFEMS
CB1, 35 kN/mm on R = 50 mm. There both bodies are elastic (210 and 70 GPa, nu = 0.3); here the block alone has the E* of both.
The case nafems_cb1 has both bodies.

**Tetrahedra.** Each cell of the half ball is also split into twelve tetrahedra. tet10 carries no pressure at its corners, so
only force and radius are compared. For larger a/R the theory (a parabola on a plane at small strain) deviates from a ball on
rubber; this is plotted."""
SOURCES = {"Hertz": "H. Hertz, Ueber die Beruehrung fester elastischer Koerper, J. reine angew. Math. 92 (1882) 156-171; K. L. Johnson, Contact "
                    "Mechanics, 1985, sec. 4.2: F = 4/3 E* sqrt(R) d^1.5, p0 = 2 E*/pi sqrt(d/R), a = sqrt(R d), E* = E/(1 - nu^2)",
           "NAFEMS CB1": "NAFEMS, Advanced finite element contact benchmarks, 2006, no. 1: half width 6.2146 mm, 3585.4 MPa by Hertz"}
COST = 55
E, SPOT, LARGE = 1e5, 1e-3, 50.0


def pressed(path, poisson, surface, depth, sliding, young=E, nodes=None, **more):
    """The contact after the surface has moved down by `depth`; nodes on symmetry planes slide in these."""
    sim = sinew.load({
        "sinew": 1, "time_step": 0.25, "solver": {"ordering": "metis"},
        "bodies": {"block": {"type": "fem", "mesh": {"file": str(path), "unit": "m"}, "fixed": [{"set": "far"}, *sliding],
                             "material": {"model": "neo-hookean", "young_modulus": young, "poisson_ratio": poisson}, **more}},
        "contacts": {"press": {"body": "block", "nodes": nodes or {"set": "core"}, "surface": surface,
                               "motion": {"z": {"ramp": {"to": -depth, "duration": 1.0}}}}}})
    sim.step(4)
    sim.solve_static()
    return sim.contact("press")


def in_plane(axis):
    normal = [float(axis == name) for name in "xyz"]
    return {"plane": {"point": [0, 0, 0], "normal": normal, "within": 1e-9}, "axes": axis}


def core_cells(cells):
    """Number of uniform cells that covers at least 1.25 a."""
    return -(-5 * cells // 4)


def stretched(at, spacing):
    """(n,) present spacings along one axis at the nodes of a deformed uniform grid; half a spacing at the symmetry plane."""
    index = np.rint(at / spacing).astype(int)
    first = np.bincount(index, at) / np.bincount(index)  # mean coordinate of each row of the grid
    width = np.gradient(first)
    width[0] *= 0.5
    return width[index]


class Ball:
    """Force, peak pressure and contact radius relative to Hertz's, with `cells` cells per contact radius."""

    def __init__(self, case, cells, poisson, slender=0.01, element="hex8"):
        radius, spacing = SPOT / slender, SPOT / cells
        core = core_cells(cells) * spacing
        path = shapes.half_ball(case.scratch / "half_ball.vtu", core, core_cells(cells), LARGE * SPOT)
        if element != "hex8":
            path = shapes.split_into_tetrahedra(case.scratch / "split.vtu", path)
        contact = pressed(path, poisson, {"sphere": {"centre": [0, 0, radius], "radius": radius}}, SPOT**2 / radius,
                          [in_plane("x"), in_plane("y")], element=element,
                          nodes={"box": [-1e-9, -1e-9, -1e-9, 1.001 * core, 1.001 * core, 1e-9]})
        at, normal = np.asarray(contact.positions), np.asarray(contact.normal_forces)
        force, modulus = 4.0 * normal.sum(), E / (1.0 - poisson**2)
        lost = lost_to_the_border(poisson) * force * (1.0 + poisson) / (2.0 * np.pi * E * LARGE * SPOT)
        depth = SPOT**2 / radius + lost
        self.force = force / (4.0 / 3.0 * modulus * np.sqrt(radius) * depth**1.5)
        distance = np.hypot(at[:, 0], at[:, 1])
        self.spot = np.sqrt(2.5 * normal @ distance**2 / normal.sum()) / np.sqrt(radius * depth)
        self.distances = distance / np.sqrt(radius * depth)
        if element != "hex8":
            return
        self.pressures = normal / (stretched(at[:, 0], spacing) * stretched(at[:, 1], spacing)) / (2.0 * modulus / np.pi * np.sqrt(depth / radius))
        self.peak = self.pressures[np.argmin(distance)]


class Cylinder:
    """Peak pressure and half width relative to Hertz's for the same force per length."""

    def __init__(self, case, cells, young=E, radius=0.1, pressed_by=2.2, poisson=0.3):
        spacing = SPOT / cells
        path = shapes.half_disc(case.scratch / "half_disc.vtu", core_cells(cells) * spacing, core_cells(cells), LARGE * SPOT)
        contact = pressed(path, poisson, {"capsule": {"ends": [[0, -1, radius], [0, 1, radius]], "radius": radius}}, pressed_by * SPOT**2 / radius,
                          [in_plane("x"), {"box": [-1, -1, -1, 1, 1, 1], "axes": "y"}], young)
        at, normal = np.asarray(contact.positions)[:, 0], np.asarray(contact.normal_forces)
        force, modulus = 2.0 * normal.sum() / spacing, young / (1.0 - poisson**2)
        self.force, self.spot = force, np.sqrt(4.0 * force * radius / (np.pi * modulus))
        share = 0.5 * spacing * stretched(at, spacing)  # two nodes through the thickness
        self.distances, self.pressures = at / self.spot, normal / share / (2.0 * force / (np.pi * self.spot))
        self.peak = self.pressures[np.argmin(at)]
        self.width = 2.0 * np.sqrt(normal @ at**2 / normal.sum()) / self.spot


def balls(case, convergence, profile):
    sizes = (2, 4, 6, 8)
    for poisson, color in ((0.3, plots.OURS), (0.45, plots.SECOND)):
        seen = [Ball(case, cells, poisson) for cells in sizes]
        finest = seen[-1]
        case.check(f"ball, nu = {poisson:g}, 8 cells over a: force / Hertz's", finest.force, 1.0, 0.01, source="Hertz")
        case.check(f"ball, nu = {poisson:g}, 8 cells over a: peak pressure / Hertz's", finest.peak, 1.0, 0.02, source="Hertz")
        case.check(f"ball, nu = {poisson:g}, 8 cells over a: contact radius / Hertz's", finest.spot, 1.0, 0.02, source="Hertz")
        for name, mark in (("force", "o-"), ("peak", "s--"), ("spot", "^:")):
            errors = [abs(getattr(ball, name) - 1.0) for ball in seen]
            convergence.loglog([1.0 / n for n in sizes], errors, mark, color=color, label=f"{name}, nu = {poisson:g}")
        profile.plot(finest.distances, finest.pressures, ".", color=color, label=f"nu = {poisson:g}")
    case.check("ball, nu = 0.45: order of the contact radius in h", observed_order([1.0 / n for n in sizes[1:]],
                                                                                  [ball.spot - 1.0 for ball in seen[1:]]), 2.0, 0.5,
               source="Hertz", relative=False)


def cylinders(case, convergence, profile):
    sizes = (4, 8, 16, 32)
    seen = [Cylinder(case, cells) for cells in sizes]
    case.check("cylinder, 8 cells over a: peak pressure / Hertz's", seen[1].peak, 1.0, 0.02, source="Hertz")
    case.check("cylinder, 8 cells over a: half width / Hertz's", seen[1].width, 1.0, 0.02, source="Hertz")
    case.check("cylinder, 32 cells over a: half width / Hertz's", seen[3].width, 1.0, 2e-3, source="Hertz")
    convergence.loglog([1.0 / n for n in sizes], [abs(it.width - 1.0) for it in seen], "^-", color=plots.THIRD, label="spot, cylinder")
    profile.plot(seen[2].distances, seen[2].pressures, "x", color=plots.THIRD, ms=4, label="cylinder")


def benchmark(case):
    """CB1, scaled to a half width of about SPOT, with the a/R of the benchmark."""
    scale = 6.2146e-3 / SPOT
    young = 1.0 / (1.0 / 210e9 + 1.0 / 70e9)
    wanted, depth = 35e6 / scale, 2.2
    for _ in range(4):
        found = Cylinder(case, 16, young, 0.05 / scale, depth)
        depth *= (wanted / found.force)**0.9
    case.check("cylinder of CB1, 16 cells over a: half width", 1e3 * scale * found.width * found.spot, 6.2146, 0.01, source="NAFEMS CB1", unit="mm")
    case.check("cylinder of CB1, 16 cells over a: peak pressure", 1e-6 * found.peak * 2.0 * found.force / (np.pi * found.spot), 3585.4, 0.02,
               source="NAFEMS CB1", unit="MPa")


def split(case, convergence):
    for poisson, color in ((0.3, plots.OURS), (0.45, plots.SECOND)):
        coarse, fine = (Ball(case, cells, poisson, element="tet10") for cells in (2, 4))
        case.check(f"ball, nu = {poisson:g}, tet10, 4 cells over a: force / Hertz's", fine.force, 1.0, 0.01, source="Hertz")
        case.check(f"ball, nu = {poisson:g}, tet10, 4 cells over a: contact radius / Hertz's", fine.spot, 1.0, 0.02, source="Hertz")
        convergence.loglog([1 / 2, 1 / 4], [abs(coarse.force - 1.0), abs(fine.force - 1.0)], "D-.", ms=4, color=color, mfc="none",
                           label=f"force, tet10, nu = {poisson:g}")
    for element in ("tet4", "tet4-patch"):
        case.report(f"ball, nu = {poisson:g}, {element}, 4 cells over a: force / Hertz's", Ball(case, 4, poisson, element=element).force,
                    reference=1.0, source="Hertz")


def departs(case, axis):
    slender = np.array([0.01, 0.1, 0.2, 0.3])
    seen = [Ball(case, 6, 0.45, ratio) for ratio in slender]
    axis.semilogx(slender, [ball.force for ball in seen], "o-", color=plots.OURS, label="force")
    axis.semilogx(slender, [ball.peak for ball in seen], "s--", color=plots.SECOND, label="peak pressure")
    axis.axhline(1.0, color=plots.REFERENCE, lw=1)
    axis.set(xlabel="a / R", ylabel="ratio to Hertz's, nu = 0.45")
    axis.legend()
    case.report("ball of a/R = 0.3 on neo-Hookean rubber: force / Hertz's", seen[-1].force, source="Hertz")


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    balls(case, left, middle)
    cylinders(case, left, middle)
    benchmark(case)
    split(case, left)
    departs(case, right)
    plots.slope_line(left, [1 / 4, 1 / 32], [0.02, 2.5e-4], 2)
    left.set(xlabel="h / a", ylabel="relative error")
    left.legend(fontsize=7)
    fine = np.linspace(0.0, 1.0, 200)
    middle.plot(fine, np.sqrt(1.0 - fine**2), color=plots.REFERENCE, lw=1, label="Hertz")
    middle.set(xlabel="r / a", ylabel="p / p0", xlim=(0.0, 1.4))
    middle.legend()
    case.figure(figure, "Left: errors of force, peak pressure and contact radius. Middle: pressure, 8 cells over a (cylinder: 16). Right: deviation "
                        "of a ball on rubber from the theory, 6 cells over a.")
