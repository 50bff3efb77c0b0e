"""An arm that leans on a bar, and how much this steadies its tip."""

import numpy as np
from sinew import pcc, plan

from suite import plots

TITLE = "Bracing of a fluidic arm against a bar"
SETUP = """The identified four-segment arm (lengths of 0.14 m assumed) has its tip at (5, -53) cm. A rigid bar of 5 cm radius
crosses its plane at (-7.7, -44.5) cm, with the friction of silicone on steel, 0.6 to 0.9. The example is our own; its
position was chosen so that the arm can hold the bar throughout the disturbance, and it was tuned on disturbances 101 to 110.

The arm moves to contact, presses, replans the rest with the braced point at its actual position, and moves to the goal. Then
its torques stay constant for 4 s while random forces disturb its tip: sums of four sines of 0.2 to 2 Hz, 0.01 N root mean
square along each axis, which start with a jump. The same is done without the bar, for disturbances 1 to 10. The simulation
has mu = 0.6, steps of 1 ms and contact points on the whole skin.

*Spread* is the root mean square distance of the tip from its mean, *error* its mean distance from the goal. The friction
condition includes the disturbance: it compares, relative to F_n, the friction that is needed under the worst force on the tip
up to 2 Hz whose amplitudes add up to 0.04 N."""
SOURCES = {
    "statics": "K q + G = B tau + J'f and Coulomb's cone, docs/bracing.md",
    "unbraced": "the same arm, goal and forces without the bar",
    "none": "no published number: only reported",
}
COST = 200
GOAL = [0.05, 0.0, -0.53]
SEEDS = range(1, 11)


def bar(friction):
    return plan.BraceObject.capsule([-0.077, -0.1, -0.445], [-0.077, 0.1, -0.445], 0.05, friction=friction)


def later(one):
    """Mask of the samples after the initial jump of the disturbance has decayed."""
    return one.times > one.disturbed_from + 0.02


def run(case):
    arm, limits = pcc.published_arm(), pcc.published_torque_limits()
    brace = plan.brace(arm, GOAL, limits, [bar("silicone-on-steel")])
    case.report("status", brace.status, source="none")
    case.report("status without an object", plan.brace(arm, GOAL, limits, []).status, source="none")
    coated = plan.brace(arm, GOAL, limits, [bar("coated-rigid")], segments=brace.segments)
    case.report("status with the friction of a coated rigid bar, 0.05 to 0.20", coated.status, source="none")
    for label, of in (("silicone on steel", brace), ("coated rigid", coated)):
        for condition in of.conditions[:1]:
            value = f"{condition['verdict']}, {condition['value']:.3g} against {condition['limit']:.3g}"
            case.report(f"friction condition, {label}", value, source="none")
    case.report("braced segment", brace.segments, source="none")
    case.bound("residual of the equilibrium", 1e3 * brace.balance, 1e-6, unit="mN m", source="statics")
    case.bound("gap of the braced point", 1e3 * abs(brace.gap), 1e-5, unit="mm", source="statics")
    case.bound("friction / its limit", brace.friction_force / (0.6 * brace.normal_force), 1.0, source="statics")
    case.report("normal force", brace.normal_force, unit="N", source="none")
    case.report("largest force on the tip under which the point sticks", brace.hold_force, unit="N", source="none")
    case.report("compliance of the tip, braced", brace.tip_compliance, unit="m/N", source="none")
    case.report("compliance of the tip up to 2 Hz, braced", brace.peak_compliance, unit="m/N", source="none")
    braced = [brace.run(seed=seed) for seed in SEEDS]
    bare = [brace.run(braced=False, seed=seed) for seed in SEEDS]
    case.bound("friction outside the cone, any step", max(r.cone_residual for r in braced), 1e-9, unit="N", source="statics")
    for word, runs in (("braced", braced), ("not braced", bare)):
        for name, values in (("spread", [1e3 * r.spread for r in runs]), ("error", [1e3 * r.mean_error for r in runs])):
            case.report(f"{word}: {name} of the tip, mean of ten seeds", float(np.mean(values)), unit="mm", source="none")
            case.report(f"{word}: {name}, standard deviation over seeds", float(np.std(values, ddof=1)), unit="mm", source="none")
    case.report("runs in which the braced point stuck throughout", f"{sum(r.status == 'held' for r in braced)} of {len(braced)}",
                source="none")
    used = max(float((r.friction_force[later(r)] / r.normal_force[later(r)]).max()) for r in braced)
    case.bound("friction / its limit from 20 ms after the start of the disturbance, worst seed", used / 0.6, 1.0,
               source="statics")
    case.report("longest time of slip, of 4 s", float(max(r.slips for r in braced)), unit="ms", source="none")
    for name, key in (("spread", "spread"), ("error", "mean_error")):
        mean = np.mean([getattr(r, key) for r in braced]) / np.mean([getattr(r, key) for r in bare])
        case.bound(f"mean {name} braced / not braced", float(mean), 1.0, source="unbraced")
        worst = max(getattr(a, key) / getattr(b, key) for a, b in zip(braced, bare))
        case.bound(f"{name} braced / not braced, worst seed", worst, 1.0, source="unbraced")
    figure, (left, right) = plots.axes(2)
    left.loglog([1e3 * r.spread for r in bare], [1e3 * r.spread for r in braced], "o", color=plots.OURS, label="spread")
    left.loglog([1e3 * r.mean_error for r in bare], [1e3 * r.mean_error for r in braced], "s", color=plots.SECOND, label="error")
    ends = [0.1, 30.0]
    left.loglog(ends, ends, color="#999999", lw=1, label="no difference")
    left.set(xlabel="not braced (mm)", ylabel="braced (mm)")
    left.legend()
    for label, of, colour in (("not braced", bare[0], plots.SECOND), ("braced", braced[0], plots.OURS)):
        shown = of.times >= of.disturbed_from
        error = 1e3 * np.linalg.norm(of.tip - GOAL, axis=1)
        right.semilogy(of.times[shown] - of.disturbed_from, error[shown], color=colour, label=label)
    right.set(xlabel="time since the start of the disturbance (s)", ylabel="distance of the tip from the goal (mm)")
    right.legend()
    case.figure(figure, "Spread and error of the tip for each seed, and the error over time for the first seed.")
