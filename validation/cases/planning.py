"""Swings beyond static reach: plans by direct collocation, simulated in fine steps."""

import numpy as np
from scipy import integrate
from sinew import pcc, plan

from suite import plots

TITLE = "Swings of a fluidic arm beyond its static reach"
SETUP = """The identified four-segment arm (masses, k_1 and b as published; the lengths are not, 0.14 m each are assumed) has
torque limits of 0, 0.12, 0.13 and 0.18 N m. It swings from hanging at rest to the goals A (-25, -45), B (15, -35), C (20,
-40) and D (-30, -30) cm (x, z) with minimal effort, from seven random starts each. At the end the tip has to be within 0.2 cm
and 0.5 cm/s of the goal. Radau starts with 50 knots of 32 ms, with torque rates within 2 N m/s and without this limit;
backward Euler has 30 knots of 80 ms and no correction, as published.

The torque of each plan is then applied to the arm and integrated with error control; for the best plan to each goal this is
repeated with SciPy's Radau. The aim is the accuracy that the plans promise, 0.2 cm and 0.5 cm/s. *Out of static reach* means
that no equilibrium, stable or not, has its tip within 2 cm, proven by branch and bound. The basin of a plan is tested with 40
random starts whose angles are each off by up to the given value (rad), and with arms whose masses or stiffnesses are off by
10 %. A swing succeeds if the tip comes within 2 cm."""
SOURCES = {
    "aim": "our aim",
    "published": "the fluidic arm's authors: 0.9 to 1.7 cm and 0.1 to 7.6 cm/s after re-integration",
    "proof": "branch and bound with Taylor bounds, docs/planning.md",
    "optimum": "the best of the seven starts",
    "integrator": "scipy.integrate.solve_ivp, method Radau, rtol 1e-9, on the arm's accelerations",
}
COST = 90
GOALS = {"A": (-0.25, -0.45), "B": (0.15, -0.35), "C": (0.20, -0.40), "D": (-0.30, -0.30)}
SEEDS = range(1, 8)
KINDS = {
    "Radau, torque rate limited": {"torque_rate_limits": 2.0},
    "Radau": {},
    "backward Euler, 80 ms": {"method": "backward-euler", "duration": 2.4, "intervals": 30},
}


def independent_end(arm, found):
    """Final position (3,) in m and speed in m/s of the tip under the plan's torques, by SciPy."""
    count = arm.coordinates
    state = np.zeros(2 * count)
    for begin, end in zip(found.times, found.times[1:]):  # torques have kinks at knots
        state = integrate.solve_ivp(
            lambda t, y: np.r_[y[count:], arm.acceleration(y[:count], y[count:], found.torque_at(t))], (begin, end),
            state, method="Radau", rtol=1e-9, atol=1e-11).y[:, -1]
    q, rate = state[:count], state[count:]
    return arm.endpoints(q)[-1], np.linalg.norm(arm.jacobian(q, len(arm.endpoints(q)) - 1) @ rate)


def goal(name):
    x, z = GOALS[name]
    return np.array([x, 0.0, z])


def scaled(mass=1.0, stiffness=1.0):
    """The arm with other masses and stiffnesses."""
    masses = np.array([0.190, 0.146, 0.090, 0.090])
    return pcc.Arm([0.14] * 4, mass * masses, 0.108 * stiffness, 4.2e-3)


def grabs(case, arm, limits):
    best = {}
    for kind, settings in KINDS.items():
        for name in GOALS:
            task = plan.Task(arm, goal(name), limits, **settings)
            published = "Euler" in kind
            plans = [task.solve(seed, corrections=0 if published else 6) for seed in SEEDS]
            found = [p for p in plans if p.found or (published and p.status == "not-met-on-replay")]
            case.report(f"{kind}, {name}: starts that lead to a plan", f"{len(found)} of {len(SEEDS)}", source="aim")
            if not found:
                continue
            least = min(found, key=lambda p: p.objective)
            runs = [task.replay(p) for p in found]
            error, speed = 100 * max(r.tip_error for r in runs), 100 * max(r.tip_speed for r in runs)
            if not published:
                case.bound(f"{kind}, {name}: tip error, worst start", error, 0.2, unit="cm", source="aim")
                case.bound(f"{kind}, {name}: tip speed, worst start", speed, 0.5, unit="cm/s", source="aim")
                at, left = independent_end(arm, least)
                apart = 100 * np.linalg.norm(at - runs[found.index(least)].tip[-1])
                case.bound(f"{kind}, {name}: tip by SciPy: difference", apart, 0.001, unit="cm", source="integrator")
                case.bound(f"{kind}, {name}: tip speed by SciPy", 100 * left, 0.5025, unit="cm/s", source="integrator")
                same = sum(p.objective < 1.001 * least.objective for p in found)
                case.report(f"{kind}, {name}: starts that lead to the same effort", f"{same} of {len(found)}",
                            source="optimum")
                best.setdefault(name, (task, least))
            else:
                case.report(f"{kind}, {name}: tip error, worst start", error, unit="cm", source="published")
                case.report(f"{kind}, {name}: tip speed, worst start", speed, unit="cm/s", source="published")
    return best


def reach(case, arm, limits):
    for name in GOALS:
        nearest = plan.nearest_reach(arm, limits, goal(name))
        case.report(f"{name}: nearest equilibrium of {nearest['solved']} found", 100 * nearest["distance"], unit="cm",
                    source="proof")
        proof = plan.prove_out_of_reach(arm, limits, goal(name), tolerance=0.02)
        case.agree(f"{name}: static reach, by {proof['boxes']} boxes", proof["verdict"], "out-of-reach", source="proof")


def basin(case, task, found):
    tracker = plan.Tracker(task, found)
    random = np.random.default_rng(5)
    starts = random.uniform(-1.0, 1.0, (40, 4))
    sizes, shares = (0.0, 0.02, 0.05, 0.1, 0.2), {}
    for feedback in (False, True):
        word = "closed loop" if feedback else "open loop"
        shares[word] = []
        for size in sizes:
            runs = [tracker.run(theta=size * start, feedback=feedback) for start in starts[: 1 if size == 0 else 40]]
            share = np.mean([r.tip_error < 0.02 for r in runs])
            shares[word].append(100 * share)
            case.report(f"{word}, start off by {size:g} rad: swings that succeed", 100 * share, unit="%", source="aim")
        for label, other in (("masses +10 %", scaled(mass=1.1)), ("masses -10 %", scaled(mass=0.9)),
                             ("stiffness +10 %", scaled(stiffness=1.1)), ("stiffness -10 %", scaled(stiffness=0.9))):
            run = tracker.run(other, feedback=feedback)
            case.report(f"{word}, {label}: tip error", 100 * run.tip_error, unit="cm", source="aim")
    return sizes, shares


def run(case):
    arm, limits = pcc.published_arm(), pcc.published_torque_limits()
    reach(case, arm, limits)
    best = grabs(case, arm, limits)
    figure, (left, right) = plots.axes(2)
    for (name, (task, found)), colour in zip(best.items(), (plots.OURS, plots.SECOND, plots.THIRD, plots.QUIET)):
        tip = task.replay(found).tip
        left.plot(100 * tip[:, 0], 100 * tip[:, 2], color=colour, label=name)
        left.plot(*(100 * goal(name)[[0, 2]]), "o", color=colour)
    left.set(xlabel="x (cm)", ylabel="z (cm)", aspect="equal")
    left.legend()
    sizes, shares = basin(case, *best["C"])
    for word, colour in (("open loop", plots.SECOND), ("closed loop", plots.OURS)):
        right.plot(sizes, shares[word], "o-", color=colour, label=word)
    right.set(xlabel="error of the initial angles (rad)", ylabel="successful swings to C (%)")
    right.legend()
    case.figure(figure, "Paths of the tip to the four goals, and success rates with errors of the initial angles.")
