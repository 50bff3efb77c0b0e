#!/usr/bin/env python3
"""Two soft fingertips roll a cylinder between them by 90 degrees: its rotation and place as targets, the grip as a force.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/in_hand.py [--angle 90] [--grip 1.0] [--out FOLDER]

A fingertip is a soft pad on a bone. Two motors move each bone: one presses it on the cylinder, one moves it up and down.
When both pads hold the cylinder against gravity, an inverse controller takes the four motors. It is asked for the angle of the
cylinder, for a place of its axis that stays, and for the normal force of the left pad, which is not to slip.
FOLDER gets in_hand.png.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import sinew

RADIUS, WIDE = 10e-3, 20e-3  # m: of the cylinder
PAD = np.array([8e-3, 16e-3, 56e-3])  # m: thick, wide, tall
CELL = 4e-3  # m
BONE, CARRIAGE = 4e-3, 6e-3  # m: their thickness
FRICTION, SQUEEZE = 0.8, 0.5e-3  # the pads' motion before the controller takes over, m
HELD, TURNED, END = 0.2, 2.2, 2.5  # s
STEP = 0.01  # s
SIDES = {"left": -1.0, "right": 1.0}


def fingertip(side):
    """Bodies, joints and actuators of one fingertip, by the ends of their names."""
    face = side * RADIUS  # m: x of the pad's face
    back = face + side * PAD[0]
    bone, carriage = back + side * 0.5 * BONE, back + side * (BONE + 0.5 * CARRIAGE)
    screws = [[back, y, z] for z in np.linspace(-0.43, 0.43, 4) * PAD[2] for y in (-0.37 * PAD[1], 0.37 * PAD[1])]
    bodies = {
        "pad": {
            "type": "fem", "mesh": {"shape": "block", "length": PAD[0], "width": PAD[1], "height": PAD[2], "element_size": CELL},
            "pose": {"position": [min(face, back), -0.5 * PAD[1], -0.5 * PAD[2]]}, "element": "hex8",
            "material": {"model": "neo-hookean", "young_modulus": "150 kPa", "poisson_ratio": 0.45},
            "density": "1070 kg/m^3", "damping": {"stiffness": "5 ms"},
        },
        "bone": {"type": "rigid", "shape": {"box": [BONE, PAD[1], PAD[2]]}, "mass": "20 g", "pose": {"position": [bone, 0.0, 0.0]}},
        "carriage": {"type": "rigid", "shape": {"box": [CARRIAGE, 20e-3, 20e-3]}, "mass": "20 g",
                     "pose": {"position": [carriage, 0.0, 0.0]}},
    }  # fmt: skip
    joints = {
        "screws": {"type": "weld", "bodies": ["pad", "bone"], "points": screws},
        "press": {"type": "slider", "bodies": ["world", "carriage"], "point": [carriage, 0.0, 0.0], "axis": [-side, 0.0, 0.0]},
        "rise": {"type": "slider", "bodies": ["carriage", "bone"], "point": [bone, 0.0, 0.0], "axis": "z"},
    }
    motors = {
        "press": {"type": "linear-motor", "joint": "press", "limits": {"displacement": {"rate": "20 mm/s"}},
                  "command": {"displacement": {"ramp": {"to": SQUEEZE, "duration": 0.05}}}},
        "rise": {"type": "linear-motor", "joint": "rise", "command": {"displacement": 0.0},
                 "limits": {"displacement": {"min": "-20 mm", "max": "20 mm", "rate": "60 mm/s"}}},
    }  # fmt: skip
    return bodies, joints, motors


def scene():
    cylinder = {"type": "rigid", "shape": {"cylinder": {"radius": RADIUS, "height": WIDE}}, "mass": "15 g",
                "pose": {"rotation": {"axis": "x", "angle": "90 deg"}}}  # fmt: skip
    made = {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": STEP,
        "bodies": {"cylinder": cylinder}, "joints": {}, "actuators": {}, "contacts": {},
        "effectors": {
            "turn": {"body": "cylinder", "orientation": [[0.0, 0.0, 0.0], [5e-3, 0.0, 0.0], [0.0, 0.0, 5e-3]]},
            "axis": {"body": "cylinder", "point": [0.0, 0.0, 0.0], "directions": ["x", "z"]},
        },
    }  # fmt: skip
    for name, side in SIDES.items():
        bodies, joints, motors = fingertip(side)
        for joint in joints.values():
            joint["bodies"] = [body if body == "world" else f"{name}_{body}" for body in joint["bodies"]]
        for motor in motors.values():
            motor["joint"] = f"{name}_{motor['joint']}"
        for kind, parts in (("bodies", bodies), ("joints", joints), ("actuators", motors)):
            made[kind] |= {f"{name}_{part}": what for part, what in parts.items()}
        made["contacts"][name] = {"between": [f"{name}_pad", "cylinder"], "friction": FRICTION}
    return made


def smooth(share):
    """From 0 to 1 without jerk at its ends: 10 s^3 - 15 s^4 + 6 s^5 (Flash & Hogan, J. Neurosci. 5, 1985)."""
    share = np.clip(share, 0.0, 1.0)
    return share**3 * (10.0 - 15.0 * share + 6.0 * share**2)


def roll(angle, grip):
    """One row a step from when the controller takes over, and the simulation at its end, with places of all nodes at three times.

    Columns: time (s), angle asked (rad), found (rad), distance of the axis from its place (m), normal forces of left and right
    pad (N), points that stick and that slip, rise of left and right bone (m), seconds taken.
    """
    sim = sinew.load(scene(), threads=1)
    sim.step(round(HELD / STEP))
    turn, axis = sim.effector("turn"), sim.effector("axis")
    place, pads = axis.position.copy(), [sim.contact(name) for name in SIDES]
    # A rotation error of 1 rad counts as much as 10 mm of the axis.
    ik = sinew.InverseController(sim, targets={"turn": [0.0, 0.0, 0.0], "axis": place}, weights={"turn": [0.0, RADIUS**2, 0.0]},
                                 contacts={"left": {"normal_force": grip, "slip": False}})  # fmt: skip
    rows, frames = [], [nodes(sim)]
    while sim.time < END - 0.5 * STEP:
        asked = angle * smooth((sim.time + STEP - HELD) / (TURNED - HELD))
        ik.targets["turn"] = [0.0, asked, 0.0]
        start = time.process_time()
        sim.step()
        taken = time.process_time() - start
        states = np.concatenate([np.array(pad.states) for pad in pads])
        rows.append((sim.time, asked, turn.value[1], np.linalg.norm(axis.position - place), *(pad.normal_force for pad in pads),
                     np.sum(states == "stick"), np.sum(states == "slip"),
                     *(sim.actuator(f"{name}_rise").displacement for name in SIDES), taken))  # fmt: skip
        if len(frames) < 2 and rows[-1][2] >= 0.5 * angle:
            frames.append(nodes(sim))
    return np.array(rows), sim, frames + [nodes(sim)]


def nodes(sim):
    """What a picture needs: nodes of both pads (m), the cylinder's axis (m) and angle (rad)."""
    return ([sim.body(f"{name}_pad").positions.copy() for name in SIDES], sim.effector("axis").position.copy(),
            sim.effector("turn").value[1])  # fmt: skip


def report(rows):
    """Prints the figures of the run; `apart` is what a bone rose less the arc that the cylinder turned."""
    late = rows[rows[:, 0] > HELD + 0.1]  # the grip has its force
    arc = RADIUS * rows[:, 2]
    creep = np.abs(np.abs(rows[:, 8:10] - rows[0, 8:10]) - (arc - arc[0])[:, None]).max()
    print(f"turned {np.degrees(rows[-1, 2]):.4f} degrees of {np.degrees(rows[-1, 1]):g}, off by "
          f"{np.degrees(np.abs(late[:, 2] - late[:, 1]).max()):.5f} degrees at most "
          f"({np.degrees(np.abs(rows[:, 2] - rows[:, 1]).max()):.2f} while the grip builds up), "
          f"the axis by {1e3 * late[:, 3].max():.4f} mm; "
          f"normal forces {late[:, 4].min():.4f} to {late[:, 4].max():.4f} N left, "
          f"{late[:, 5].min():.3f} to {late[:, 5].max():.3f} N right; "
          f"{np.median(late[:, 6]):.0f} points stick, {np.median(late[:, 7]):.0f} slip (median; {late[:, 7].max():.0f} at most); "
          f"bones rose by {1e3 * rows[-1, 8]:.2f} and {1e3 * rows[-1, 9]:.2f} mm, arc {1e3 * arc[-1]:.2f} mm, "
          f"apart by {1e3 * creep:.2f} mm at most; "
          f"{1e3 * np.median(rows[:, 10]):.0f} ms a step")  # fmt: skip


def draw(rows, frames, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 5, figsize=(13, 4), width_ratios=[0.7, 0.7, 0.7, 1.2, 1.2])
    for plot, (pads, axis, angle) in zip(axes, frames):
        for pad in pads:
            plot.plot(1e3 * pad[:, 0], 1e3 * pad[:, 2], ".", color="#7fb0e6", markersize=3)
        around = np.linspace(0.0, 2.0 * np.pi, 100)
        plot.fill(1e3 * (axis[0] + RADIUS * np.cos(around)), 1e3 * (axis[2] + RADIUS * np.sin(around)), color="#ffb43c")
        spoke = axis + RADIUS * np.array([np.sin(angle), 0.0, np.cos(angle)])
        plot.plot(1e3 * np.array([axis[0], spoke[0]]), 1e3 * np.array([axis[2], spoke[2]]), color="0.2", lw=2)
        plot.set(aspect="equal", xlim=(-20, 20), ylim=(-46, 46), title=f"{np.degrees(angle):.0f} degrees", xlabel="x [mm]")
    axes[0].set_ylabel("z [mm]")
    axes[3].plot(rows[:, 0], np.degrees(rows[:, 1]), color="0.7", lw=4, label="asked")
    axes[3].plot(rows[:, 0], np.degrees(rows[:, 2]), label="cylinder")
    axes[3].set(xlabel="time [s]", ylabel="angle [degrees]")
    axes[3].legend()
    axes[4].plot(rows[:, 0], rows[:, 4:6], label=list(SIDES))
    axes[4].set(xlabel="time [s]", ylabel="normal force [N]", ylim=(0.0, 1.3 * rows[:, 4:6].max()))
    axes[4].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--angle", type=float, default=90.0, help="degrees")
    parser.add_argument("--grip", type=float, default=1.0, help="normal force of the left pad, N")
    parser.add_argument("--out", type=Path, help="folder for in_hand.png")
    given = parser.parse_args()
    rows, _, frames = roll(np.radians(given.angle), given.grip)
    report(rows)
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(rows, frames, given.out / "in_hand.png")


if __name__ == "__main__":
    main()
