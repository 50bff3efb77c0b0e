#!/usr/bin/env python3
"""Compliance of the tip of the bent trunk for forces on the tip and for cable tensions."""

from pathlib import Path

import numpy as np
import sinew

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"


def main():
    np.set_printoptions(precision=3, suppress=True)
    sim = sinew.load(SCENE)
    sim.actuator("long_0").displacement = 0.01
    sim.solve_static()
    linear = sim.linearise()
    tip = [linear.rows.index(f"tip.{axis}") for axis in "xyz"]
    cables = [linear.rows.index(name) for name in sim.actuators]
    print("tip at (mm)", 1e3 * sim.effector("tip").position)
    print("compliance of the tip (mm/N)")
    print(1e3 * linear.W[np.ix_(tip, tip)])
    print("motion of the tip by tension in", ", ".join(sim.actuators), "(mm/N)")
    print(1e3 * linear.W[np.ix_(tip, cables)])


if __name__ == "__main__":
    main()
