"""An elastic cylinder pressed on an elastic block, with and without friction."""

import numpy as np
import sinew

from reference import shapes
from suite import plots

from .hertz import core_cells, in_plane

TITLE = "NAFEMS CB1: an elastic cylinder on an elastic block, with and without friction"
SETUP = """Plane strain. The lower half of a cylinder, R = 50 mm, 210 GPa, is pressed with 35 kN/mm on a block of 200 x 200
mm, 70 GPa, whose bottom is fixed; nu = 0.3, neo-Hookean hexahedra, one cell thick. By symmetry half of each is meshed, with 4
to 16 cells over the half width on both bodies. The mid-plane of the cylinder moves down until the force agrees with the
benchmark to 1e-4. The half width follows from the second moment of the nodal forces, 1/4 F a^2, the peak pressure from the
middle node's force and the deformed width that belongs to it. Nodal forces are the internal forces that the contact balances.

Then the cylinder is pressed down in 20 steps with mu = 0.1. The softer block spreads under the cylinder; friction resists
this and makes the contact narrower. The references are from another code, with its own mesh and at small strain. Its stress
is extrapolated to the node, so the tolerance is 5 %. The source does not say whether the bottom of its block is fixed or
slides. Both of our laws, neo-Hookean and Saint Venant-Kirchhoff, differ from the linear one in compression: one is stiffer,
the other softer. The displacement has a tolerance of 1 %, which is missed; it is reported for all combinations. Meshes with
16 and 15 cells do not match anywhere. Their nodal forces scatter about a smooth pressure, because the vertices of both
surfaces carry them; this is reported."""
SOURCES = {"Hertz": "NAFEMS, Advanced finite element contact benchmarks, 2006, no. 1; half width 6.2146 mm, 3585.4 MPa by Hertz",
           "Marc": "Marc demonstration manual, ch. 1: NAFEMS CB1 with mu = 0.1, y displacement -1.30264 mm and stress -3542.7 MPa of the block in the "
                   "middle of the contact",
           "Coulomb": "|friction| <= mu normal force at every point; R. D. Mindlin 1949 for the stick in the middle"}
COST = 35
RADIUS, LOAD, WIDE, PEAK = 0.05, 35e6, 6.2146e-3, 3585.4e6  # m, N/m, m, Pa


class Press:
    """A cylinder pressed on a block; `cells` are the cells per half width on block and cylinder."""

    def __init__(self, case, cells, friction=0.0, slides=False, law="neo-hookean"):
        self.slides, self.law = slides, law
        self.prepare(case, cells, friction, 20 if friction else 4)
        depths, forces = [1.56e-3], []
        while True:
            self.press(depths[-1])
            forces.append(self.force)
            if abs(self.force / LOAD - 1.0) < 1e-4 or len(forces) == 6:
                break
            slope = np.diff(depths[-2:])[0] / np.diff(forces[-2:])[0] if len(forces) > 1 else 0.9 * depths[-1] / self.force
            depths.append(depths[-1] + slope * (LOAD - self.force))
        self.measure()

    def prepare(self, case, cells, friction, steps):
        self.friction, self.steps = friction, steps
        self.apart = 2e-8  # m, separation of resting surfaces, 1e-7 of the size
        core = [core_cells(count) * WIDE / count for count in cells]
        self.thick = 0.5 * WIDE / cells[1]
        flat = shapes.half_disc(case.scratch / "flat.vtu", 0.5 * core[1], core_cells(cells[1]), RADIUS)  # rounded() doubles lengths at the pole
        self.paths = (shapes.graded_plate(case.scratch / "block.vtu", core[0], core_cells(cells[0]), (0.1, self.thick, 0.2)),
                      shapes.rounded(case.scratch / "cylinder.vtu", flat, RADIUS, turned=True))

    def press(self, depth):
        bodies = {}
        for name, path, young in zip(("block", "cylinder"), self.paths, (70e9, 210e9)):
            bodies[name] = {"type": "fem", "mesh": {"file": str(path), "unit": "m"}, "fixed": [
                {"set": "far", **({"axes": "z"} if self.slides and name == "block" else {})}, in_plane("x"),
                {"box": [-1, -1, -1, 1, 1, 1], "axes": "y"}],
                "material": {"model": self.law, "young_modulus": young, "poisson_ratio": 0.3}}
        bodies["cylinder"] |= {"pose": {"position": [0, 0, self.apart]}, "motion": {"z": {"ramp": {"to": -depth, "duration": 1.0}}}}
        self.sim = sinew.load({"sinew": 1, "time_step": 1.0 / self.steps, "solver": {"ordering": "metis", "tolerance": 1e-9}, "bodies": bodies,
                               "contacts": {"press": {"between": ["block", "cylinder"], "friction": self.friction}}})
        self.sim.step(self.steps)
        self.force = 2.0 * abs(self.sim.contact("press").force[2]) / self.thick

    def line(self, name):
        """Deformed x, z (n, 2) in m of the surface nodes near the contact, sorted by x, and their forces (n,) in N/m."""
        body = self.sim.body(name)
        rest = body.rest_positions
        height = rest[:, 2] if name == "block" else np.hypot(rest[:, 0], rest[:, 2] - self.apart - RADIUS) - RADIUS
        seen = np.flatnonzero((np.abs(height) < 1e-9 * RADIUS) & (body.positions[:, 0] < 1.3 * WIDE))
        seen = seen[np.lexsort((rest[seen, 1], np.rint(rest[seen, 0] / (1e-6 * WIDE))))]
        force = np.abs(body.internal_forces()[seen, 2]).reshape(-1, 2).sum(axis=1) / self.thick
        return body.positions[seen][:, [0, 2]].reshape(-1, 2, 2).mean(axis=1), force

    def measure(self):
        self.widths, self.profiles = [], []
        for name in ("block", "cylinder"):
            at, force = self.line(name)
            share = np.gradient(at[:, 0])
            share[0] *= 0.5
            self.widths.append(2.0 * np.sqrt(force @ at[:, 0]**2 / force.sum()))
            self.profiles.append((at[:, 0], force / share))
        self.width = np.mean(self.widths)
        self.peak = np.mean([pressure[0] for _, pressure in self.profiles])
        self.sunk = self.line("block")[0][0, 1]


def smooth(case, axis):
    sizes = (4, 8, 16)
    seen = [Press(case, (cells, cells)) for cells in sizes]
    finest = seen[-1]
    case.check("16 cells over a: half width", 1e3 * finest.width, 1e3 * WIDE, 0.01, source="Hertz", unit="mm")
    case.check("16 cells over a: peak pressure", 1e-6 * finest.peak, 1e-6 * PEAK, 0.02, source="Hertz", unit="MPa")
    case.report("difference of half widths between 4 and 8 cells / difference between 8 and 16",
                (seen[0].width - seen[1].width) / (seen[1].width - seen[2].width), source="Hertz")
    case.report("displacement of the block in the middle", 1e3 * finest.sunk, source="Hertz", unit="mm")
    axis.plot(1e3 * finest.profiles[0][0], 1e-6 * finest.profiles[0][1], "o", ms=3, color=plots.OURS, label="mu = 0")
    odd = Press(case, (16, 15))
    case.check("16 on 15 cells: half width", 1e3 * odd.width, 1e3 * WIDE, 0.01, source="Hertz", unit="mm")
    for name, (_, pressure) in zip(("block", "cylinder"), odd.profiles):
        case.report(f"16 on 15 cells: pressure at the middle node of the {name}", 1e-6 * pressure[0], source="Hertz", unit="MPa", reference=1e-6 * PEAK)
    return finest


def rough(case, axis, smooth_width):
    press = Press(case, (12, 12), friction=0.1)
    case.check("mu = 0.1, 12 cells over a: displacement of the block in the middle", 1e3 * press.sunk, -1.30264, 0.01, source="Marc", unit="mm",
               known_miss="it depends on the support of the bottom and on the law at strains of 5 %; see the following lines")
    for slides, law in ((True, "neo-hookean"), (False, "saint-venant-kirchhoff")):
        other = Press(case, (8, 8), friction=0.1, slides=slides, law=law)
        name = f"mu = 0.1, 8 cells, {law}, bottom {'slides' if slides else 'held'}"
        case.report(f"{name}: displacement", 1e3 * other.sunk, source="Marc", unit="mm", reference=-1.30264)
        case.report(f"{name}: peak pressure", 1e-6 * other.peak, source="Marc", unit="MPa", reference=3542.7)
    case.check("mu = 0.1, 12 cells over a: peak pressure", 1e-6 * press.peak, 3542.7, 0.05, source="Marc", unit="MPa")
    case.report("mu = 0.1: half width / that without friction", press.width / smooth_width, source="Marc")
    contact = press.sim.contact("press")
    normal, along = np.asarray(contact.normal_forces), np.linalg.norm(np.asarray(contact.friction_forces), axis=1)
    case.bound("mu = 0.1: largest friction above mu times the normal force / largest normal force",
               max(0.0, (along - 0.1 * normal).max()) / normal.max(), 1e-8, source="Coulomb")
    states = np.array(contact.states)[normal > 0.0]
    case.agree("mu = 0.1: the middle sticks, the rim slips", {"stick", "slip"} <= set(states.tolist()), True, source="Coulomb")
    axis.plot(1e3 * press.profiles[0][0], 1e-6 * press.profiles[0][1], "x", ms=4, color=plots.SECOND, label="mu = 0.1")


def run(case):
    figure, axis = plots.axes(1)
    finest = smooth(case, axis)
    rough(case, axis, finest.width)
    fine = np.linspace(0.0, WIDE, 200)
    axis.plot(1e3 * fine, 1e-6 * PEAK * np.sqrt(1.0 - (fine / WIDE)**2), color=plots.REFERENCE, lw=1, label="Hertz")
    axis.set(xlabel="x (mm)", ylabel="pressure (MPa)")
    axis.legend()
    case.figure(figure, "Pressure on the block, 16 cells over the half width.")
