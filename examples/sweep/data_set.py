#!/usr/bin/env python3
"""A data set for learning: the response of the trunk to eight random tensions, as arrays for NumPy or PyTorch.

    examples/sweep/data_set.py [--samples N] [--workers N] [--out DIR]

Writes DIR/data.npz: tensions (n, 8) N and their ramps' durations (n,) s; at the end of each run positions and velocities
of the nodes (n, nodes, 3) in m and m/s, forces of the supports (n, nodes, 3) in N, tip (n, 3) m. The runs are dynamic.
"""

import argparse
from pathlib import Path

import numpy as np
import sinew
import sinew.sweep

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"
CABLES = [f"{kind}_{k}" for kind in ("long", "short") for k in range(4)]
SETTINGS = ["integrator=backward-euler", "bodies.trunk.damping={stiffness: 20 ms}"]


def pull(sample):
    sim = sample.load(set=SETTINGS)
    for name in CABLES:
        sim.actuator(name).tension = sinew.Ramp(0.0, sample[name], duration=sample["ramp"])
    sim.step(20)
    body = sim.body("trunk")
    return {"positions": body.positions, "velocities": body.velocities, "reactions": body.reactions, "tip": sim.effector("tip").position}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=128)
    parser.add_argument("--workers", type=int)
    parser.add_argument("--out", default="out/data_set")
    options = parser.parse_args()
    vary = {**{name: "0N:1N" for name in CABLES}, "ramp": "50ms:200ms"}
    table = sinew.sweep.run(SCENE, function=pull, vary=vary, sample=f"sobol:{options.samples}", out=options.out, workers=options.workers,
                            resume=True)
    good = (table["status"] == "done").to_numpy()
    outputs = {name: sinew.sweep.arrays(options.out, name)[good] for name in ("positions", "velocities", "reactions", "tip")}
    path = Path(options.out) / "data.npz"
    np.savez_compressed(path, tensions=table.loc[good, CABLES].to_numpy(), ramp=table.loc[good, "ramp"].to_numpy(), **outputs)
    print(f"{good.sum()} of {len(table)} samples in {path}")
    for name, values in outputs.items():
        print(f"{name:<12}{values.shape}")


if __name__ == "__main__":
    main()
