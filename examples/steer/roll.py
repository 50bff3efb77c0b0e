#!/usr/bin/env python3
"""A wheel of silicone rolls to commanded positions: tendon lengths by the angle of its oval, the angle by feedback.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/roll.py [--to 140 60] [--out FOLDER]

The wheel of examples/roll. Four tendons press it into an oval, and sines of one angle, a quarter of a turn apart, turn the oval
within the wheel. The wheel is a weakly damped pendulum that follows this angle: x'' + 2 z w x' + w^2 (x - k angle) = 0, with k
metres per radian. The angle is the integral of a speed in proportion to the distance that is left, and a part in proportion to
the wheel's velocity that damps the pendulum. This is feedback around the simulation and no inverse controller: that looks one
step ahead, in which inertia decides and not the floor. FOLDER gets roll.png.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import sinew
import yaml

HERE = Path(__file__).resolve().parent
TENDONS = [f"tendon_{k}" for k in range(4)]
AMPLITUDE, PER_TURN = 6e-3, 91.5e-3  # m: of a tendon's length; way for a period of the tendons (docs/locomotion.md)
GROWS = 0.5  # s: the oval forms
GAIN, DAMPING = 2.0, 0.07  # 1/s: speed over distance; s: way of the angle over velocity
FASTEST, HARDEST = 50e-3, 120e-3  # m/s, m/s^2
STEP, STAYS = 0.01, 6.0  # s; s for each position


def scene():
    tree = yaml.safe_load((HERE.parent / "roll" / "roll.yaml").read_text())
    tree["time_step"] = STEP
    for name in TENDONS:
        tree["actuators"][name]["limits"] = {"displacement": {"rate": "60 mm/s"}}
        tree["actuators"][name]["command"] = {"displacement": 0.0}
    return tree


class Roller:
    """Commands the tendons of a wheel so that it goes to a position."""

    def __init__(self, sim):
        self.sim, self.body = sim, sim.body("wheel")
        self.shares = self.body.node_masses / self.body.mass
        self.start = self.shares @ self.body.positions[:, 0]
        self.led = self.speed = 0.0  # way of the angle without damping (m), its speed (m/s)

    @property
    def position(self):
        """Of the centre of mass along x, since the start (m)."""
        return self.shares @ self.body.positions[:, 0] - self.start

    def step(self, target):
        """One step towards a position (m)."""
        velocity = self.shares @ self.body.velocities[:, 0]
        wanted = np.clip(GAIN * (target - self.position), -FASTEST, FASTEST)
        self.speed += np.clip(wanted - self.speed, -HARDEST * STEP, HARDEST * STEP)
        formed = min(1.0, self.sim.time / GROWS)
        if formed == 1.0:
            self.led += self.speed * STEP
        angle = 2.0 * np.pi / PER_TURN * (self.led - (DAMPING * velocity if formed == 1.0 else 0.0))
        for k, name in enumerate(TENDONS):
            self.sim.actuator(name).displacement = AMPLITUDE * formed * np.sin(angle + 0.5 * np.pi * (3 - k))
        self.sim.step()


def roll(targets):
    """One row a step: time (s), position asked (m), position (m), normal force (N), points that slip, smallest gap (m), seconds taken."""
    sim = sinew.load(scene(), threads=1)
    roller, floor, rows = Roller(sim), sim.contact("floor"), []
    for target in targets:
        for _ in range(round(STAYS / STEP)):
            began = time.process_time()
            roller.step(target)
            taken = time.process_time() - began
            slipping = np.sum(np.array(floor.states) == "slip")
            rows.append((sim.time, target, roller.position, floor.normal_force, slipping, floor.gap, taken))
    return np.array(rows), sim


def report(rows):
    """Prints how far the wheel is from each position after its time."""
    ends = rows[round(STAYS / STEP) - 1 :: round(STAYS / STEP)]
    missed = ends[:, 2] - ends[:, 1]
    for row, off in zip(ends, missed):
        last = rows[(rows[:, 0] <= row[0]) & (rows[:, 0] > row[0] - 0.5)]
        print(f"asked {1e3 * row[1]:.1f} mm: off by {1e3 * off:+.3f} mm after {STAYS:g} s, "
              f"by {1e3 * np.abs(last[:, 2] - last[:, 1]).max():.3f} mm at most in the last half second")  # fmt: skip
    print(f"{np.mean(rows[:, 4] > 0) * 100:.0f} % of the steps have points that slip; gap >= {1e6 * rows[:, 5].min():.3f} um; "
          f"{1e3 * np.median(rows[:, 6]):.0f} ms a step")  # fmt: skip


def draw(rows, sim, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(13, 4), width_ratios=[1, 1.2, 1.2])
    axes[0].imshow(sinew.render(sim, size=(700, 640)))
    axes[0].set_axis_off()
    axes[1].plot(rows[:, 0], 1e3 * rows[:, 1], color="0.75", lw=4, label="asked")
    axes[1].plot(rows[:, 0], 1e3 * rows[:, 2], label="wheel")
    axes[1].set(xlabel="time [s]", ylabel="position [mm]")
    axes[1].legend()
    axes[2].semilogy(rows[:, 0], 1e3 * np.maximum(np.abs(rows[:, 2] - rows[:, 1]), 1e-7))
    axes[2].set(xlabel="time [s]", ylabel="distance from the position asked for [mm]")
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--to", type=float, nargs="+", default=[140.0, 60.0], help="positions, mm")
    parser.add_argument("--out", type=Path, help="folder for roll.png")
    given = parser.parse_args()
    rows, sim = roll([1e-3 * target for target in given.to])
    report(rows)
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(rows, sim, given.out / "roll.png")


if __name__ == "__main__":
    main()
