#!/usr/bin/env python3
"""Locates and estimates a push on the trunk from cable lengths, tensions and three markers, with error bars."""

from pathlib import Path

import numpy as np
import sinew
from sinew import estimate

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"
CABLES = [f"{kind}_{k}" for kind in ("long", "short") for k in range(4)]
MARKERS = {"rim": ("trunk", (0.0085, 0, 0.195)), "mid": ("trunk", (-0.012, -0.007, 0.125)), "low": ("trunk", (0, 0.017, 0.06))}
SENSORS = ([estimate.Measured(f"{name}.position", 1e-4) for name in MARKERS]
           + [estimate.Measured(f"{cable}.tension", 0.05) for cable in CABLES]
           + [estimate.Measured(f"{cable}.displacement", 1e-4) for cable in CABLES])


def model(unknowns):
    return estimate.Twin(SCENE, SENSORS, unknowns, markers=MARKERS, commanded=dict.fromkeys(CABLES, "displacement"))


def robot(force, area):
    """Readings of a second model in place of the robot: two cables are pulled, and a push is distributed over an area."""
    plant = model([estimate.NodalForce("push", "trunk", area.nodes, area.weights)])
    pull = dict(zip(CABLES, [8e-3, 0, 0, 0, 0, 4e-3, 0, 0]))
    answer = plant.predict([*force, *pull.values()])
    noise = np.random.default_rng(0)
    readings = {name: y + std * noise.standard_normal() for name, y, std in zip(plant.outputs, answer, plant.noise)}
    readings.update({f"{cable}.displacement": x + 1e-4 * noise.standard_normal() for cable, x in pull.items()})
    return readings, np.array(plant.sim.body("trunk").positions)


def main():
    np.set_printoptions(precision=3, suppress=True)
    twin = model([])
    areas = estimate.patches(twin.sim, "trunk", 48)
    touched = areas[14]
    readings, shape = robot(-0.8 * touched.normal, touched)
    print("the push: 0.8 N at (mm)", 1e3 * touched.centre)

    found = estimate.locate(twin, readings, areas)
    print(f"patch {found.patch} with probability {found.probability[found.patch]:.2f}, {found.status}; at (mm)", 1e3 * found.place)
    print("patches that hold it with 99 %:", found.likely(0.99))

    hand = estimate.NodalForce("hand", "trunk", touched.nodes, touched.weights, prior=2.0)
    known = twin.with_unknowns([hand])
    estimated = estimate.solve(known, readings)
    print("where the place is known (N)", estimated.unknowns[:3], "truth", -0.8 * touched.normal)
    print("standard deviations (N)", np.sqrt(np.diag(estimated.covariance))[:3])
    print("singular values", estimated.observability.singular_values)
    error = np.sqrt(((estimated.positions["trunk"] - shape) ** 2).sum(axis=1).mean())
    print(f"RMS error of the shape {1e3 * error:.3f} mm")


if __name__ == "__main__":
    main()
