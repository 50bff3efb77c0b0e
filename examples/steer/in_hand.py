#!/usr/bin/env python3
"""Two soft fingers roll a cylinder between them by 90 degrees: inverse control of what the robot holds.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/in_hand.py [--out FOLDER]

Two trunks with four cables each hang side by side and take a standing rigid cylinder between their tips. The controller
is asked for a normal force of 1 N of each finger and for the cylinder's rotation about its axis, and finds the eight
tensions through the sticking contacts. The hand lifts the cylinder by 5 mm first. FOLDER gets in_hand.png.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import sinew

RADIUS, HEIGHT, MASS = 12e-3, 50e-3, 20e-3  # m, m, kg
APART, ABOVE, HELD = 23e-3, 215e-3, 20e-3  # m: feet from the middle and above the table; how much of a finger is held
LIFT, FORCE, TURN, FRICTION = 5e-3, 1.0, 0.5 * np.pi, 0.8
GRIPPED, LIFTED, TURNED, END, STEP = 0.6, 1.0, 4.0, 4.5, 0.01  # s


def scene():
    bodies = {"roll": {"type": "rigid", "shape": {"cylinder": {"radius": RADIUS, "height": HEIGHT}}, "mass": MASS,
                       "pose": {"position": [0.0, 0.0, 0.5 * HEIGHT]}}}  # fmt: skip
    contacts = {"table": {"body": "roll", "surface": {"plane": {}}, "friction": 0.3}}
    cables = {}
    depth = np.append(0.0, np.linspace(21e-3, 190e-3, 20))  # of a cable's points below the foot
    across = np.interp(depth, depth[[1, -1]], [10e-3, 3.5e-3])  # from the finger's axis to the cable
    for name, side in (("left", -1.0), ("right", 1.0)):
        foot = np.array([side * APART, 0.0, ABOVE])
        bodies[name] = {
            "type": "fem", "mesh": {"shape": "trunk"}, "element": "tet4-patch", "mass": "42 g",
            "material": {"model": "neo-hookean", "young_modulus": "600 kPa", "poisson_ratio": 0.45},
            "position": foot.tolist(), "rotation": [np.pi, 0.0, 0.0],
            "fixed": {"box": [-0.2, -0.2, ABOVE - HELD - 1e-6, 0.2, 0.2, ABOVE + 1e-6]},
            "base": {"z": {"ramp": {"to": LIFT, "start": GRIPPED, "duration": LIFTED - GRIPPED}}},
        }  # fmt: skip
        for k, angle in enumerate(0.5 * np.pi * np.arange(4)):
            outwards = np.array([np.cos(angle), np.sin(angle), 0.0])
            route = foot + across[:, None] * outwards - depth[:, None] * [0.0, 0.0, 1.0]
            cables[f"{name}_{k}"] = {
                "type": "cable", "body": name, "pull": "body", "points": route.tolist(),
                "limits": {"tension": {"min": 0.0, "max": 20.0}, "displacement": {"rate": "20 mm/s"}},
            }  # fmt: skip
        contacts[name] = {"between": [name, "roll"], "friction": FRICTION}
    return {"sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": STEP,
            "bodies": bodies, "actuators": cables, "contacts": contacts,
            "effectors": {"turn": {"body": "roll", "orientation": [[0.0, 0.0, 0.025], [0.01, 0.0, 0.025], [0.0, 0.01, 0.025]]}}}  # fmt: skip


def angle(sim):
    """About its axis, rad."""
    return sim.effector("turn").rotation[2]


def roll():
    sim = sinew.load(scene(), threads=1)
    asked = {name: {"normal_force": FORCE} for name in ("left", "right")}
    ik = sinew.InverseController(sim, targets={"turn": [0.0, 0.0, 0.0]}, weights={"turn": [0.0, 0.0, 1e-4]}, contacts=asked)
    rows = []
    while sim.time < END - 1e-9:
        share = np.clip((sim.time + STEP - LIFTED) / (TURNED - LIFTED), 0.0, 1.0)
        wanted = TURN * (10 * share**3 - 15 * share**4 + 6 * share**5)
        ik.targets["turn"] = [0.0, 0.0, wanted]
        start = time.process_time()
        ik.step()
        taken = time.process_time() - start
        rows.append((sim.time, wanted, angle(sim), *(sim.contact(n).normal_force for n in asked),
                     sim.body("roll").centre_of_mass[2], taken))  # fmt: skip
    return np.array(rows), sim


if __name__ == "__main__":
    rows, sim = roll()
    for r in rows[::20]: print(np.round(r,4))
