#!/usr/bin/env python3
"""The tip of the trunk follows a circle; prints the tracking error and the time of a step."""

from pathlib import Path

import numpy as np
import sinew

SCENE = Path(__file__).resolve().parents[1] / "trunk" / "trunk.yaml"


def main():
    sim = sinew.load(SCENE)
    circle = sinew.Circle([0.0, 0.0, 0.18], 0.03, period=5.0)
    times = []
    with sinew.InverseController(sim, targets={"tip": circle}) as ik:
        for _ in range(1000):
            ik.step()
            times.append(sim.report.times["total"])
        print(f"status            {ik.status}")
        print(f"tip error         {1e3 * ik.error:.4f} mm")
        print(f"largest tension   {ik.efforts.max():.2f} N")
    print(f"median step       {1e3 * np.median(times):.3f} ms")


if __name__ == "__main__":
    main()
