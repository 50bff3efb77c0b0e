"""Default steps of cables with friction: how many random robots stop, and the iterations that their steps take.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/cable_friction.py [--robots 100]

The robots are those of validation/cases/default_steps.py, with a coefficient of friction of 0.05 to 0.3 in every cable.
"""

import pathlib
import sys

import numpy as np
from hard_steps import main

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "validation"))

from cases.default_steps import random_robot  # noqa: E402


def rough(seed):
    """A random robot whose cables have friction, and how long it lasts."""
    scene, lasts = random_robot(np.random.default_rng(seed))
    random = np.random.default_rng(10000 + seed)
    for cable in scene["actuators"].values():
        cable["friction"] = float(random.uniform(0.05, 0.3))
    return scene, lasts


if __name__ == "__main__":
    main(__doc__, robots=100, name="robots", make=rough)
