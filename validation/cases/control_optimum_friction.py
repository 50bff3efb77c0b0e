"""Inverse control against a wall with friction, compared with the best equilibrium that a ramp of the cables reaches from its result."""

import warnings

import numpy as np
import sinew
from cases.control_optimum import CABLES, LIMIT, scene, steered
from scipy.optimize import minimize

from suite import plots

TITLE = "Inverse control against a rough wall: the best rest within a ramp of the cables"
SETUP = """The finger, the cables and the wall of control_optimum, with friction 0.3 at the wall. Eight targets: four that a ramp of
the tensions from the unloaded finger reaches, every other one by touching, and four beyond them or behind the wall. With friction a
rest depends on the way to it, so that "all equilibria" is no set to search in. What is searched here is the set of rests that the
finger comes to from where the controller left it (state, forces of contact and friction included) when the tensions go straight from
the controller's to others within the limits, in four equal quasi-static steps. The tensions whose rest is nearest to the target are
found by Powell's method with bounds and after it by that of Nelder and Mead, from the controller's tensions on; and by Powell's
method from 20 random starts each."""
SOURCES = {"Powell": "M. J. D. Powell, Computer Journal 7 (1964) 155-162, and J. A. Nelder, R. Mead, Computer Journal 7 (1965) 308-313, "
                     "as in SciPy",
           "aim": "what the project asks of itself: no farther than 0.1 mm beyond the optimum found from its answer"}
COST = 60
FRICTION, RAMP, STARTS = 0.3, 4, 20
FAR = 1.0  # m, distance assigned to a ramp without equilibrium


def rough(method="newton"):
    made = scene(method)
    made["contacts"]["wall"]["friction"] = FRICTION
    return made


class Rests:
    """Equilibria at the end of a linear ramp of the tensions (N) from a given state."""

    def __init__(self):
        self.sim = sinew.load(rough())
        self.count = 0
        self.leave_from(self.sim.state(), np.zeros(len(CABLES)))

    def leave_from(self, state, tensions):
        self.state, self.tensions = state, np.array(tensions)

    def tip(self, tensions, steps=RAMP):
        """Tip (3,) in m; None if a step finds no equilibrium."""
        self.count += 1
        self.sim.restore(self.state)
        goal = np.clip(tensions, 0.0, LIMIT)
        for k in range(1, steps + 1):
            for name, tension in zip(CABLES, self.tensions + k / steps * (goal - self.tensions)):
                self.sim.actuator(name).tension = float(tension)
            try:
                self.sim.step()
            except sinew.Error:
                return None
            if self.sim.report.flagged:
                return None
        return self.sim.effector("tip").position

    def distance(self, target, tensions, steps=RAMP):
        tip = self.tip(tensions, steps)
        return FAR if tip is None else float(np.linalg.norm(tip - target))

    def search(self, target, start, thorough):
        """The smallest distance found (m), and its tensions."""
        bounds = [(0.0, LIMIT)] * len(CABLES)
        found = minimize(lambda t: self.distance(target, t), np.clip(start, 0.0, LIMIT), method="Powell", bounds=bounds,
                         options={"xtol": 1e-4, "ftol": 1e-7, "maxfev": 400 if thorough else 100})  # fmt: skip
        if thorough:
            found = minimize(lambda t: self.distance(target, t), found.x, method="Nelder-Mead", bounds=bounds,
                             options={"xatol": 1e-5, "fatol": 1e-9, "maxfev": 300})  # fmt: skip
        return found.fun, np.clip(found.x, 0.0, LIMIT)


def targets(rests, rng, count=4):
    """(2 count, 3) in m: tips reached from the unloaded finger, and points beyond these."""
    inside = []
    while len(inside) < count:
        tip = rests.tip(rng.uniform(0.0, LIMIT, 4) * (rng.uniform(size=4) < 0.6))
        touches = rests.sim.contact("wall").normal_force > 0.01
        if tip is not None and touches == (len(inside) % 2 == 0):
            inside.append(tip)
    rest = np.array([0.0, 0.0, 0.08])
    outside = [tip + rng.uniform(0.5, 1.5) * 0.004 * (tip - rest) / np.linalg.norm(tip - rest) for tip in inside]
    return np.array(inside + outside)


def run(case):
    rng = np.random.default_rng(11)
    rests = Rests()
    unloaded = rests.state
    rows, statuses, coarse, history = [], [], 0.0, 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        for target in targets(rests, rng):
            sim, ik = steered(rough("newton"), target)
            newton, efforts, status = ik.error, np.array(ik.efforts), ik.status
            touches = sim.contact("wall").normal_force > 0.01
            once = steered(rough("one-linearisation"), target)[1].error
            rests.leave_from(unloaded, np.zeros(len(CABLES)))
            history = max(history, np.linalg.norm(rests.tip(efforts) - sim.effector("tip").position))
            rests.leave_from(sim.state(), efforts)
            stays = rests.distance(target, efforts)
            found, best = rests.search(target, efforts, True)
            near = min(newton, found)
            coarse = max(coarse, abs(rests.distance(target, best, 4 * RAMP) - found))
            others = [rests.search(target, rng.uniform(0.0, LIMIT, 4), False)[0] for _ in range(STARTS)]
            rows.append((newton, once, near, min(near, *others), abs(stays - newton)))
            statuses.append(f"{status}{' touching' if touches else ''}")
    newton, once, near, best, stays = (1e3 * np.array([row[k] for row in rows]) for k in range(5))
    half = len(rows) // 2
    case.bound("controller's tensions held for four steps: change of the distance, largest", stays.max(), 1e-3, unit="mm", source="aim")
    case.report("first four targets: distance at rest, largest", newton[:half].max(), unit="mm", source="aim")
    case.bound("first four targets: beyond the best rest found from the controller's, largest", (newton - near)[:half].max(), 0.1,
               unit="mm", source="aim")  # fmt: skip
    case.bound("other four targets: beyond the best rest found from the controller's, largest", (newton - near)[half:].max(), 0.1,
               unit="mm", source="aim")  # fmt: skip
    case.report(f"beyond the best of {STARTS} other starts, largest", (newton - best).max(), unit="mm", source="Powell")
    case.report("one linearisation a step: beyond Newton's rest, largest", (once - newton).max(), unit="mm", source="aim")
    case.report("the controller's tensions reached by a ramp from the unloaded finger: another place of the tip, largest", 1e3 * history,
                unit="mm", source="aim")  # fmt: skip
    case.report("distance at the best rest with sixteen steps instead of four: change, largest", 1e3 * coarse, unit="mm", source="Powell")
    case.report("statuses", ", ".join(statuses), source="aim")
    case.report("ramps that the searches solved", rests.count, source="Powell")
    figure, axes = plots.axes()
    place = np.arange(len(rows))
    axes.plot(place, best, "_", ms=18, label="best of all searches")
    axes.plot(place, near, "x", label="search from the controller's rest")
    axes.plot(place, newton, "o", mfc="none", label="controller at rest")
    axes.set(xlabel=f"target (the first {half} reached from the unloaded finger)", ylabel="distance of the tip [mm]")
    axes.legend()
    case.figure(figure, "Distance of the tip from its target at rest, with friction at the wall")
