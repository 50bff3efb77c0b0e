"""Inverse control at rest compared with the optimum over all equilibria, by derivative-free search."""

import warnings

import numpy as np
import sinew
from scipy.optimize import minimize

from suite import plots

TITLE = "Inverse control beside a wall: comparison with the optimum over all equilibria"
SETUP = """A finger (cylinder of 10 mm radius and 80 mm length, 400 kPa, four cables that pull with at most 6 N) stands 2 mm
beside a frictionless wall, whose normal is 30 degrees from the plane of two cables. Six targets can be reached, with or
without touching. Six more lie beyond the reach of the cables or behind the wall. An inverse controller with default settings
is stepped until it rests, with Newton's method (the default) and with one linearisation per step.

The reference solves the same problem: the tensions within the limits whose static equilibrium has its tip closest to the
target. It uses the methods of Powell (Computer J. 7, 1964) with bounds and then of Nelder and Mead (Computer J. 7, 1965),
starting from the controller's tensions and from 20 random points. Without friction an equilibrium does not depend on its
history; each one is solved from the rest shape to 1e-12."""
SOURCES = {"Powell": "M. J. D. Powell, Computer Journal 7 (1964) 155-162, as in SciPy",
           "aim": "our aim: no farther than 0.1 mm beyond the optimum found from its answer"}
COST = 120
CABLES, LIMIT, STARTS = ("east", "north", "west", "south"), 6.0, 20
RESTING = ("on-target", "out-of-reach", "local-optimum")


def scene(method):
    cables = {}
    for k, name in enumerate(CABLES):
        c, s = np.cos(0.5 * np.pi * k), np.sin(0.5 * np.pi * k)
        cables[name] = {"type": "cable", "body": "finger", "limits": {"tension": {"min": 0.0, "max": LIMIT}},
                        "points": [[0.006 * c, 0.006 * s, z] for z in (0.0, 0.02, 0.04, 0.06, 0.075)],
                        "command": {"tension": 0.0}}  # fmt: skip
    normal = [-np.cos(np.pi / 6), -np.sin(np.pi / 6), 0.0]
    return {
        "sinew": 1, "integrator": "quasi-static", "time_step": 0.01, "solver": {"method": method},
        "bodies": {"finger": {
            "type": "fem", "mesh": {"shape": "cylinder", "radius": 0.01, "height": 0.08, "element_size": 0.008},
            "material": {"model": "corotational", "young_modulus": 400e3, "poisson_ratio": 0.4}, "mass": 0.03,
            "fixed": [{"set": "bottom"}]}},
        "actuators": cables,
        "contacts": {"wall": {"body": "finger", "friction": 0.0, "surface": {
            "plane": {"point": [-0.012 * n for n in normal], "normal": normal}}}},
        "effectors": {"tip": {"body": "finger", "point": [0.0, 0.0, 0.08]}},
    }  # fmt: skip


class Equilibria:
    """Distance of the tip from a target over tensions (N), at the equilibrium that follows from the rest shape."""

    def __init__(self):
        self.sim = sinew.load(scene("newton"))
        self.start = self.sim.state()
        self.count = 0

    def tip(self, tensions):
        self.count += 1
        self.sim.restore(self.start)
        for name, tension in zip(CABLES, np.clip(tensions, 0.0, LIMIT)):
            self.sim.actuator(name).tension = float(tension)
        self.sim.solve_static()
        return self.sim.effector("tip").position

    def search(self, target, start, thorough):
        """The smallest distance found (m). Distances below 1 um count as zero."""
        distance = lambda t: np.linalg.norm(self.tip(t) - target)  # noqa: E731
        bounds = [(0.0, LIMIT)] * len(CABLES)
        found = minimize(distance, np.clip(start, 0.0, LIMIT), method="Powell", bounds=bounds,
                         options={"xtol": 1e-4, "ftol": 1e-7, "maxfev": 600 if thorough else 150})  # fmt: skip
        if thorough:
            found = minimize(distance, found.x, method="Nelder-Mead", bounds=bounds, options={"xatol": 1e-5, "fatol": 1e-9, "maxfev": 600})
        return found.fun


def targets(equilibria, rng):
    inside = []
    while len(inside) < 6:
        tip = equilibria.tip(rng.uniform(0.0, LIMIT, 4) * (rng.uniform(size=4) < 0.6))
        touches = equilibria.sim.contact("wall").normal_force > 0.01
        if touches == (len(inside) % 2 == 0):
            inside.append(tip)
    rest = np.array([0.0, 0.0, 0.08])
    outside = [tip + rng.uniform(0.5, 1.5) * 0.004 * (tip - rest) / np.linalg.norm(tip - rest) for tip in inside]
    return np.array(inside), np.array(outside)


def steered(made, target):
    """The simulation of a scene and its controller, once it is at rest as near to the target as possible."""
    sim = sinew.load(made)
    ik = sinew.InverseController(sim, targets={"tip": target})
    for _ in range(60):
        ik.step(10)
        if ik.status in RESTING and (ik.status != "on-target" or ik.error < 1e-6):
            break
    return sim, ik


def run(case):
    rng = np.random.default_rng(7)
    equilibria = Equilibria()
    inside, outside = targets(equilibria, rng)
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        for target in np.vstack([inside, outside]):
            _, ik = steered(scene("newton"), target)
            newton, efforts, status = ik.error, np.array(ik.efforts), ik.status
            once = steered(scene("one-linearisation"), target)[1].error
            near = min(newton, equilibria.search(target, efforts, True))
            starts = [equilibria.search(target, rng.uniform(0.0, LIMIT, 4), False) for _ in range(STARTS)]
            rows.append((newton, once, near, min(near, *starts), status))
    newton, once, near, best = (np.array([row[k] for row in rows]) for k in range(4))
    case.bound("targets in reach: distance at rest, largest", 1e3 * newton[:6].max(), 0.1, unit="mm", source="aim")
    case.bound("targets out of reach: largest excess over the optimum found from the controller's answer",
               1e3 * (newton - near)[6:].max(), 0.1, unit="mm", source="aim")  # fmt: skip
    case.report("largest excess over the best of 20 other starts", 1e3 * (newton - best).max(), unit="mm", source="Powell")
    case.report("one linearisation per step: largest excess over the result with Newton's method", 1e3 * (once - newton).max(), unit="mm", source="aim")
    case.report("statuses", ", ".join(row[4] for row in rows), source="aim")
    case.report("equilibria solved by the searches", equilibria.count, source="Powell")
    figure, axes = plots.axes()
    place = np.arange(len(rows))
    axes.plot(place, 1e3 * best, "_", ms=18, label="best of all searches")
    axes.plot(place, 1e3 * near, "x", label="search from the controller's answer")
    axes.plot(place, 1e3 * newton, "o", mfc="none", label="controller at rest")
    axes.set(xlabel="target (the first six in reach)", ylabel="distance of the tip [mm]")
    axes.legend()
    case.figure(figure, "Distance of the tip from its target at rest")
