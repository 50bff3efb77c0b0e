#!/usr/bin/env python3
"""Sobol indices of the tip of a hanging trunk for the modulus, the density and the placement of a cable.

    examples/sweep/sensitivity.py [--base N] [--workers N] [--out DIR]

A base of N requires 5 N samples. The trunk hangs (gravity along its axis) and one cable pulls with 1 N. Placement is the
distance of the cable from the axis, as a factor of that in the scene.
"""

import argparse
from pathlib import Path

import numpy as np
import sinew.sweep

TRUNK = Path(__file__).resolve().parents[1] / "trunk"
VARY = {"modulus": "360kPa:540kPa", "density": "900kg/m^3:1300kg/m^3", "placement": "0.9:1.1"}


def tip(sample):
    points = 1e-3 * np.loadtxt(TRUNK / "long_0.csv", delimiter=",", skiprows=1)
    points[:, :2] *= sample["placement"]
    sim = sample.load(set={
        "gravity": [0.0, 0.0, 9.81],
        "bodies.trunk.material.young_modulus": sample["modulus"],
        "bodies.trunk.density": sample["density"],
        "actuators.long_0.points": points,
        "actuators.long_0.command.tension": 1.0,
    })
    sim.solve_static()
    return {"tip": sim.effector("tip").position}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--base", type=int, default=64)
    parser.add_argument("--workers", type=int)
    parser.add_argument("--out", default="out/sensitivity")
    options = parser.parse_args()
    table = sinew.sweep.run(TRUNK / "trunk.yaml", function=tip, vary=VARY, sample=f"saltelli:{options.base}", out=options.out,
                            workers=options.workers, timeout=60.0, resume=True)
    print(table["status"].value_counts().to_string())
    for axis in "xz":
        print(f"\nSobol indices of the tip's {axis}, with 95 % intervals")
        print(sinew.sweep.indices(options.out, f"tip.{axis}").to_string(float_format="%.3f"))


if __name__ == "__main__":
    main()
