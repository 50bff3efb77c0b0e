#!/usr/bin/env python3
"""A soft fluidic arm leans on a bar to hold its tip steadier: the sequence of poses, and the error of the tip with and
without the brace, as a figure.

    python brace.py [FOLDER]     writes bracing.png to FOLDER (default: out/fluidic_arm)
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from sinew import pcc, plan

GOAL = np.array([0.05, 0.0, -0.53])
CENTRE, RADIUS = np.array([-0.077, -0.445]), 0.05  # as in brace.yaml
STEPS = 8  # points per drawn segment


def backbone(length, theta):
    """(n, 2) cm: points along the axis, in the plane of the arm."""
    line, heading = [np.zeros(2)], 0.0
    for bend in theta:
        start = line[-1]
        for share in np.arange(1, STEPS + 1) / STEPS:
            half = 0.5 * bend * share
            chord = length * share * np.sinc(half / np.pi)
            line.append(start + chord * np.array([np.sin(heading + half), -np.cos(heading + half)]))
        heading += bend
    return 100 * np.array(line)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/fluidic_arm")
    folder.mkdir(parents=True, exist_ok=True)
    arm, limits = pcc.published_arm(), pcc.published_torque_limits()
    ends = [[CENTRE[0], y, CENTRE[1]] for y in (-0.1, 0.1)]
    bar = plan.BraceObject.capsule(*ends, RADIUS)
    brace = plan.brace(arm, GOAL, limits, [bar])
    print(f"{brace.status} with segment {brace.segments}, force {np.round(brace.force, 3)} N, sticks under up to "
          f"{brace.hold_force:.3f} N on the tip")
    for condition in brace.conditions:
        print(f"  {condition['name']}: {condition['verdict']}, {condition['value']:.3g} against {condition['limit']:.3g}")
    if not brace.found:
        raise SystemExit(1)
    braced, bare = brace.run(), brace.run(braced=False)
    print(f"{braced.status}; tip's spread {1e3 * braced.spread:.1f} mm braced, {1e3 * bare.spread:.1f} mm not")

    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.5), constrained_layout=True)
    left.add_patch(plt.Circle(100 * CENTRE, 100 * RADIUS, color="#dddddd"))
    moments = {"start": 0.0, "contact": braced.contact_time, "pressed": braced.replan_time,
               "at the goal": braced.disturbed_from}
    for label, time in moments.items():
        line = backbone(arm.length / 4, braced.theta[np.argmin(np.abs(braced.times - time))])
        left.plot(*line.T, label=label)
    left.plot(*(100 * GOAL[[0, 2]]), "k+", ms=10)
    left.set(xlabel="x (cm)", ylabel="z (cm)", aspect="equal")
    left.legend(frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    middle.plot(braced.times, braced.normal_force, label="normal")
    middle.plot(braced.times, braced.friction_force, label="friction")
    middle.set(xlabel="time (s)", ylabel="force on the braced point (N)", ylim=(0, 0.3))
    middle.legend(frameon=False)
    for label, run in (("not braced", bare), ("braced", braced)):
        shown = run.times >= run.disturbed_from - 0.5
        error = 1e3 * np.linalg.norm(run.tip - GOAL, axis=1)
        right.semilogy(run.times[shown] - run.disturbed_from, error[shown], label=label)
    right.set(xlabel="time since the disturbance began (s)", ylabel="tip from goal (mm)")
    right.legend(frameon=False)
    figure.savefig(folder / "bracing.png", dpi=100)


if __name__ == "__main__":
    main()
