#!/usr/bin/env python3
"""A soft fluidic arm swings to points that it cannot hold at rest: reach map, planned torques and
phase plots of the tip, as figures.

    python plan.py [FOLDER]      writes reach.png and plans.png to FOLDER (default: out/fluidic_arm)
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from sinew import pcc, plan

GOALS = {"A": (-0.25, -0.45), "B": (0.15, -0.35), "C": (0.20, -0.40), "D": (-0.30, -0.30)}


def reach_map(arm, limits, paths, folder):
    held = plan.sample_reach(arm, limits, samples=2000)["tip"]
    figure, axis = plt.subplots(figsize=(6, 5), constrained_layout=True)
    axis.plot(100 * held[:, 0], 100 * held[:, 2], ".", ms=2, color="#999999", label="can be held at rest")
    for name, run in paths.items():
        line, = axis.plot(100 * run.tip[:, 0], 100 * run.tip[:, 2], lw=1)
        axis.plot(100 * GOALS[name][0], 100 * GOALS[name][1], "o", color=line.get_color(), label=f"goal {name}")
    axis.set(xlabel="x (cm)", ylabel="z (cm)", aspect="equal")
    axis.legend(frameon=False)
    figure.savefig(folder / "reach.png", dpi=100)


def torques_and_phases(plans, paths, folder):
    figure, axes = plt.subplots(2, 4, figsize=(14, 6), constrained_layout=True)
    for (upper, lower), (name, found) in zip(axes.T, plans.items()):
        for segment in range(1, 4):
            upper.plot(found.times, 1e3 * found.torque[:, segment], label=f"segment {segment + 1}")
        upper.set(title=f"goal {name}", xlabel="time (s)", ylabel="torque (mN m)")
        run = paths[name]
        for axis, word in ((0, "x"), (2, "z")):
            lower.plot(100 * run.tip[:, axis], 100 * run.tip_velocity[:, axis], label=word)
            lower.plot(100 * run.tip[-1, axis], 100 * run.tip_velocity[-1, axis], "ko", ms=4)
        lower.set(xlabel="tip (cm)", ylabel="its speed (cm/s)")
    axes[0, 0].legend(frameon=False)
    axes[1, 0].legend(frameon=False)
    figure.savefig(folder / "plans.png", dpi=100)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/fluidic_arm")
    folder.mkdir(parents=True, exist_ok=True)
    arm, limits = pcc.published_arm(), pcc.published_torque_limits()
    plans, paths = {}, {}
    print("goal  at rest (cm)  proof           iterations  time (s)  tip (cm)  speed (cm/s)")
    for name, (x, z) in GOALS.items():
        goal = [x, 0.0, z]
        task = plan.Task(arm, goal, limits, torque_rate_limits=2.0)
        plans[name] = task.solve(1)
        if not plans[name].found:
            raise SystemExit(f"no plan for {name}: {plans[name].status}")
        paths[name] = task.replay(plans[name])
        nearest = plan.nearest_reach(arm, limits, goal)["distance"]
        proof = plan.prove_out_of_reach(arm, limits, goal)["verdict"]
        print(f"{name:4}  {100 * nearest:12.1f}  {proof:14}  {plans[name].iterations:10}  {plans[name].seconds:8.2f}"
              f"  {100 * paths[name].tip_error:8.2f}  {100 * paths[name].tip_speed:12.2f}")
    reach_map(arm, limits, paths, folder)
    torques_and_phases(plans, paths, folder)


if __name__ == "__main__":
    main()
