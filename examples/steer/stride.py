#!/usr/bin/env python3
"""The pressures with which a soft quadruped makes commanded strides: found by a search in a copy of the simulation.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/stride.py [--strides 4 8 2] [--out FOLDER]

The robot and the gait of the learning environment `crawl`: a cycle of 2 s, in which the pressures of five chambers follow a pattern.
Before each cycle a root search (Brent) looks for the share of the full pressures after which the robot is where the stride
should end. It tries each share on the simulation itself, whose state it then takes back. A stride ends before the
robot has come to rest, and the next search begins with what is left. FOLDER gets stride.png.
"""

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
import sinew
from scipy.optimize import brentq
from sinew.gym.scenes import crawler
from sinew.gym.tasks.crawl import PERIOD, gait

FRICTION, SHARES = 0.5, (0.2, 1.0)  # coefficient; of the full pressures
NEAR = 3e-4  # of the share: where the search ends
FULL = np.array([crawler.LIMITS["trunk" if name == "trunk" else "leg"][0] for name in crawler.CHAMBERS])  # Pa


class Quadruped:
    def __init__(self):
        with tempfile.TemporaryDirectory() as folder:
            self.sim = sinew.load(crawler.scene(Path(folder), FRICTION), threads=1)
        self.sim.step(10)  # it settles on the floor
        self.body = self.sim.body("crawler")
        self.start = self.centre()

    def centre(self):
        """Centre of mass, (3,) m."""
        return self.body.node_masses @ self.body.positions / self.body.mass

    def cycle(self, share, log=None):
        """One cycle of the gait with a share of the full pressures; how far the robot has come along x since the start (m)."""
        begun = self.sim.time
        for _ in range(round(PERIOD / crawler.TIME_STEP)):
            pressures = share * FULL * gait(self.sim.time + crawler.TIME_STEP - begun)
            for name, pressure in zip(crawler.CHAMBERS, pressures):
                self.sim.actuator(name).pressure = pressure
            self.sim.step()
            if log is not None:
                log.append((self.sim.time, *(self.centre() - self.start), *pressures))
        return (self.centre() - self.start)[0]

    def find(self, goal):
        """The share of the full pressures after whose cycle the robot is at `goal` (m), and how many cycles were tried."""
        state, tried = self.sim.state(), {}

        def beyond(share):
            if share not in tried:
                self.sim.restore(state)
                tried[share] = self.cycle(share) - goal
            return tried[share]

        least, most = SHARES
        if beyond(least) * beyond(most) > 0.0:
            raise ValueError(f"no stride to {1e3 * goal:.1f} mm: the robot gets to between {1e3 * (tried[least] + goal):.1f} and "
                             f"{1e3 * (tried[most] + goal):.1f} mm; ask for one within")  # fmt: skip
        brentq(beyond, least, most, xtol=NEAR)
        self.sim.restore(state)
        return min(tried, key=lambda share: abs(tried[share])), len(tried)  # where the distance jumps, the nearer side


def walk(strides):
    """One row a stride (length asked (m), made (m), share of the full pressures, cycles tried, seconds taken); one row a step."""
    robot, rows = Quadruped(), []
    log = [(robot.sim.time, *np.zeros(8))]
    asked = reached = 0.0
    for stride in strides:
        asked += stride
        began = time.process_time()
        share, tried = robot.find(asked)
        before, reached = reached, robot.cycle(share, log)
        rows.append((stride, reached - before, share, tried, time.process_time() - began))
    return np.array(rows), np.array(log), robot.sim


def report(rows, log):
    asked, reached = rows[:, 0].cumsum(), rows[:, 1].cumsum()
    for k, (stride, made, share, tried, taken) in enumerate(rows):
        print(f"stride of {1e3 * stride:.1f} mm: {1e3 * made:.3f} mm with {1e-3 * share * FULL[0]:.2f} kPa in the legs and "
              f"{1e-3 * share * FULL[2]:.2f} kPa in the trunk; the robot is {1e6 * (reached[k] - asked[k]):+.0f} um off; "
              f"{tried:.0f} cycles tried in {taken:.1f} s")  # fmt: skip
    print(f"aside by {1e3 * np.abs(log[:, 2]).max():.3f} mm at most")


def draw(rows, log, sim, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(13, 4), width_ratios=[1.1, 1.2, 1.2])
    axes[0].imshow(sinew.render(sim, size=(700, 600)))
    axes[0].set_axis_off()
    axes[1].plot(log[:, 0], 1e3 * log[:, 1])
    ends = log[0, 0] + PERIOD * np.arange(1, len(rows) + 1)
    axes[1].plot(ends, 1e3 * rows[:, 0].cumsum(), "o", color="tab:red", label="asked")
    axes[1].set(xlabel="time [s]", ylabel="centre of mass, along x [mm]")
    axes[1].legend()
    axes[2].plot(log[:, 0], 1e-3 * log[:, 4:], label=crawler.CHAMBERS)
    axes[2].set(xlabel="time [s]", ylabel="pressure [kPa]")
    axes[2].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strides", type=float, nargs="+", default=[4.0, 8.0, 2.0], help="lengths, mm")
    parser.add_argument("--out", type=Path, help="folder for stride.png")
    given = parser.parse_args()
    rows, log, sim = walk([1e-3 * stride for stride in given.strides])
    report(rows, log)
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(rows, log, sim, given.out / "stride.png")


if __name__ == "__main__":
    main()
