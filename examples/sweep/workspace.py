#!/usr/bin/env python3
"""Static workspace of the trunk's tip: equilibria at Sobol samples of the eight tensions, point cloud and hull.

    examples/sweep/workspace.py [--samples N] [--workers N] [--out DIR]
"""

import argparse
from pathlib import Path

import sinew
import sinew.sweep
from sinew import plot

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--workers", type=int)
    parser.add_argument("--out", default="out/workspace")
    options = parser.parse_args()
    vary = {f"actuators.{name}.command.tension": "0N:1N" for name in sinew.load(SCENE).actuators}
    table = sinew.sweep.run(SCENE, vary=vary, sample=f"sobol:{options.samples}", static=True, measure=["tip.position"], out=options.out,
                            workers=options.workers, resume=True)
    print(table["status"].value_counts().to_string())
    for axis in "xyz":
        tip = 1e3 * table[f"tip.position.{axis}"]
        print(f"tip {axis} from {tip.min():7.2f} to {tip.max():7.2f} mm")
    for path in plot.sweep(options.out, Path(options.out) / "workspace.png", "workspace"):
        print(f"drew {path}")


if __name__ == "__main__":
    main()
