#!/usr/bin/env python3
"""Plans swings of a soft fluidic arm in the commands of its drive cylinders, and for comparison in torques that are
inverted afterwards. Both are simulated through cylinders, lines, actuators and arm. Prints a table, and draws a figure.

    python drive.py [FOLDER]     writes drive.png to FOLDER (default: out/fluidic_arm)
"""

import sys
from pathlib import Path

import ilc_plant
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from sinew import plan

LEAD = ilc_plant.MODEL["lead"]
SLOWER = 0.5  # relative frequency of these cylinders, which makes the difference visible


def ways(goal, cylinders):
    """{name: (drive, its replay)}, planned in two stages and as one problem."""
    arm, actuators, _ = ilc_plant.model()
    at, limits = ilc_plant.GOALS[goal], ilc_plant.MODEL["torque_limits"]
    task = plan.Task(arm, at, limits, actuators=actuators, cylinders=cylinders, lead=LEAD)
    whole = task.solve(1).drive
    torques = plan.Task(arm, at, limits, torque_rate_limits=ilc_plant.MODEL["torque_rate_limit"]).solve(1)
    inverted = plan.invert_drive(torques, actuators, cylinders, lead=LEAD)
    return {name: (drive, task.replay_commands(drive["command"], lead=LEAD))
            for name, drive in (("two stages", inverted), ("one problem", whole))}


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/fluidic_arm")
    folder.mkdir(parents=True, exist_ok=True)
    cylinders = [ilc_plant.cylinder(frequency=SLOWER)] * 3
    print("goal  way           tip (cm)  speed (cm/s)")
    runs = {}
    for goal in ilc_plant.GOALS:
        runs[goal] = ways(goal, cylinders)
        for name, (_, run) in runs[goal].items():
            print(f"{goal:4}  {name:12}  {100 * run.tip_error:8.2f}  {100 * run.tip_speed:12.2f}")
    figure, (upper, middle, lower) = plt.subplots(3, 1, figsize=(7, 8), sharex=True, layout="constrained")
    for colour, (name, (drive, run)) in zip(("C1", "C0"), runs["A"].items()):
        upper.step(drive["times"], 1e6 * drive["command"][:, 0], where="post", color=colour, lw=1, label=name)
        middle.plot(drive["times"], 1e6 * drive["volume"][:, 0], color=colour)
        if "wanted" in drive:
            middle.plot(drive["times"], 1e6 * drive["wanted"][:, 0], ":", color=colour, label="wanted")
        lower.plot(run.times, 1e3 * run.torque[:, 0], color=colour)
    upper.set(title="the first cylinder on the way to goal A", ylabel="command (ml)")
    middle.set(ylabel="volume (ml)")
    lower.set(xlabel="time (s)", ylabel="torque (mN m)")
    upper.legend(frameon=False)
    middle.legend(frameon=False)
    figure.savefig(folder / "drive.png", dpi=100)


if __name__ == "__main__":
    main()
