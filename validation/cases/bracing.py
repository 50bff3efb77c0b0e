"""An arm that leans on a bar, and how much steadier its tip is."""

import numpy as np
from sinew import pcc, plan

from suite import plots

TITLE = "Bracing of a fluidic arm against a bar"
SETUP = """The identified four-segment arm (lengths of 0.14 m assumed), tip at (10, -50) cm, a rigid bar of radius 5 cm across its
plane at (-7.2, -28) cm with the friction of silicone on steel, 0.6 to 0.9. The arm moves to contact, presses, plans the
rest anew with the braced segments' angles as measured, moves to the goal, and its torques then stay as they are for 4 s
while random forces (sums of four sines of 0.2 to 2 Hz, 0.01 N root mean square along each axis) disturb its tip; the
same without the bar, ten seeds. The simulation has mu = 0.6, steps of 1 ms and contact points on the whole skin. Spread:
root mean square of the tip about its mean; error: mean distance from the goal."""
SOURCES = {
    "statics": "K q + G = B tau + J'f and Coulomb's cone, docs/bracing.md",
    "unbraced": "the same arm, goal and forces without the bar",
    "none": "no published number: reported alone",
}
COST = 200
GOAL = [0.10, 0.0, -0.50]
SEEDS = range(1, 11)


def run(case):
    arm, limits = pcc.published_arm(), pcc.published_torque_limits()
    bar = plan.BraceObject.capsule([-0.072, -0.1, -0.28], [-0.072, 0.1, -0.28], 0.05)
    brace = plan.brace(arm, GOAL, limits, [bar], least_force=0.15)
    case.report("status", brace.status, source="none")
    case.report("status without an object", plan.brace(arm, GOAL, limits, []).status, source="none")
    case.report("braced segment", brace.segments, source="none")
    case.bound("residual of the equilibrium", 1e3 * brace.balance, 1e-6, unit="mN m", source="statics")
    case.bound("gap of the braced point", 1e3 * abs(brace.gap), 1e-5, unit="mm", source="statics")
    case.bound("friction over its limit", brace.friction_force / (0.6 * brace.normal_force), 1.0, source="statics")
    case.report("normal force", brace.normal_force, unit="N", source="none")
    case.report("tip's compliance, braced", brace.tip_compliance, unit="m/N", source="none")
    braced = [brace.run(seed=seed) for seed in SEEDS]
    bare = [brace.run(braced=False, seed=seed) for seed in SEEDS]
    case.bound("friction beyond the cone, any step", max(r.cone_residual for r in braced), 1e-9, unit="N", source="statics")
    for word, runs in (("braced", braced), ("not braced", bare)):
        for name, values in (("spread", [1e3 * r.spread for r in runs]), ("error", [1e3 * r.mean_error for r in runs])):
            case.report(f"{word}: {name} of the tip, mean of ten seeds", float(np.mean(values)), unit="mm", source="none")
            case.report(f"{word}: {name}, standard deviation over seeds", float(np.std(values, ddof=1)), unit="mm", source="none")
    case.report("runs in which the braced point stuck all the while", f"{sum(r.status == 'held' for r in braced)} of {len(braced)}",
                source="none")
    mean = np.mean([r.spread for r in braced]) / np.mean([r.spread for r in bare])
    case.bound("mean spread braced over mean spread not braced", float(mean), 1.0, source="unbraced")
    worst = max(a.spread / b.spread for a, b in zip(braced, bare))
    case.bound("spread braced over spread not braced, worst seed", worst, 1.0, source="unbraced",
               known_miss="two of the ten disturbances hardly swing the free arm, and the braced point slips at times")
    figure, (left, right) = plots.axes(2)
    left.plot([1e3 * r.spread for r in bare], [1e3 * r.spread for r in braced], "o", color=plots.OURS)
    left.set(xlabel="spread, not braced (mm)", ylabel="spread, braced (mm)")
    for label, of, colour in (("not braced", bare[0], plots.SECOND), ("braced", braced[0], plots.OURS)):
        shown = of.times >= of.disturbed_from
        error = 1e3 * np.linalg.norm(of.tip - GOAL, axis=1)
        right.plot(of.times[shown] - of.disturbed_from, error[shown], color=colour, label=label)
    right.set(xlabel="time disturbed (s)", ylabel="tip from goal (mm)")
    right.legend()
    case.figure(figure, "Spread of the tip over seeds, and the first seed's error in time.")
