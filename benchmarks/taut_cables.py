"""Soft columns behind cables that are reeled in: how many random ones stop, and the iterations that their steps take.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/taut_cables.py [--robots 40]

Upright columns with one to three cables of commanded length, inside them or to the world. Many droop until a cable
is taut, and would fall further without it.
"""

import numpy as np
from hard_steps import main

HEIGHT = 0.1


def random_column(seed):
    """A scene, in six steps of which the cables are reeled in."""
    random = np.random.default_rng(seed)
    side = random.uniform(0.010, 0.022)
    material = str(random.choice(["ecoflex-00-30", "dragon-skin-10"]))
    cables = {}
    for k in range(random.integers(1, 4)):
        angle = random.uniform(0, 2 * np.pi)
        direction = np.array([np.cos(angle), np.sin(angle)])
        cable = {"type": "cable", "body": "column", "outside": "nearest"}
        if random.random() < 0.5:
            far = random.uniform(0.05, 0.2)
            at = [*(0.45 * side * direction), HEIGHT * random.uniform(0.6, 1.0)]
            cable |= {"pull": "world", "points": [at, [*(far * direction), random.uniform(-0.02, 0.05)]]}
        else:
            cable["points"] = [[*(0.4 * side * direction), z] for z in np.linspace(0.002, HEIGHT - 0.002, 6)]
        cable["command"] = {"displacement": {"ramp": {"to": random.uniform(0.001, 0.03), "duration": 0.1}}}
        cables[f"cable_{k}"] = cable
    return {
        "sinew": 1, "gravity": [0, 0, -9.81], "time_step": 0.02,
        "bodies": {"column": {"type": "fem", "material": material, "density": 1050.0, "fixed": {"set": "z_min"},
                              "pose": {"position": [-side / 2, -side / 2, 0]},
                              "mesh": {"shape": "block", "length": side, "width": side, "height": HEIGHT, "element_size": side / 2}}},
        "masses": {"tip": {"body": "column", "point": [0, 0, HEIGHT], "mass": float(random.uniform(0, 0.02)), "outside": "nearest"}},
        "actuators": cables,
    }


if __name__ == "__main__":
    main(__doc__, robots=40, name="columns", make=lambda seed: (random_column(seed), 0.12))
