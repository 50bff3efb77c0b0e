#!/usr/bin/env python3
"""Three soft trunks carry a soft cup along a circle without turning it: the pose of a grasped object as the target of twelve cables.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/manipulation.py [--radius 5] [--out FOLDER]

The gripper of the learning environment `grasp`, with four cables in each finger in place of one. The fingers close on the
standing cup and lift it. Then an inverse controller takes the cables. It is asked for the place and the rotation of the cup,
and for at least 0.25 N of normal force of each finger. Nothing but contact connects the cup with the fingers.
FOLDER gets manipulation.png.
"""

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
import sinew
from sinew.gym.scenes import gripper, hexahedra

FRICTION, LEAST = 0.6, 0.25  # coefficient; normal force of each finger, N
PULL, LIFT = 7e-3, 30e-3  # m
CLOSED, LIFTS, LIFTED, HELD, END = 0.8, 1.0, 1.5, 1.7, 3.9  # s
TURNS = 2.0  # s: time of the circle
STEP = 0.01  # s
ARM = 30e-3  # m: a rotation of 1 rad counts as much as a way of this length


def cables(finger):
    """Four cables of a finger (in, one side, out, the other side), the first of which closes it."""
    turn = 2.0 * np.pi * finger / gripper.FINGERS
    outwards, aside = np.array([np.cos(turn), np.sin(turn), 0.0]), np.array([-np.sin(turn), np.cos(turn), 0.0])
    depth = np.append(0.0, np.linspace(21e-3, 190e-3, 20))  # of a cable's points below the foot
    away = np.interp(depth, depth[[1, -1]], [10e-3, 3.5e-3])  # from the finger's axis
    made = {}
    for side, direction in enumerate((-outwards, aside, outwards, -aside)):
        points = gripper.APART * outwards + away[:, None] * direction + (gripper.ABOVE - depth)[:, None] * [0.0, 0.0, 1.0]
        close = {"displacement": {"ramp": {"to": PULL, "duration": CLOSED}}}
        made[f"cable_{finger}_{side}"] = {
            "type": "cable", "body": f"finger_{finger}", "pull": "body", "points": points.tolist(),
            "limits": {"tension": {"min": 0.0, "max": 20.0}, "displacement": {"rate": "200 mm/s"}},
            "command": close if side == 0 else {"tension": 0.2},
        }  # fmt: skip
    return made


def scene(folder):
    made = gripper.scene(folder, FRICTION)
    made["time_step"] = STEP
    made["solver"] = {"tolerance": 1e-4}  # with 1e-8 a step takes nine iterations and not two, for the same path
    made["actuators"] = {}
    for finger in range(gripper.FINGERS):
        made["actuators"] |= cables(finger)
        ramp = {"to": LIFT, "start": LIFTS, "duration": LIFTED - LIFTS}
        made["bodies"][f"finger_{finger}"]["base"] = {"z": {"ramp": ramp}}
    nodes, _ = hexahedra.cup(gripper.QUARTER, gripper.LAYERS, gripper.CUP_RADII, gripper.CUP_HEIGHT, gripper.CUP_WALL, gripper.CUP_FLOOR)
    rim = nodes[nodes[:, 2] > gripper.CUP_HEIGHT - 1e-6]
    frame = [[0.0, 0.0, 0.0], *(rim[np.argmax(rim[:, axis])].tolist() for axis in (0, 1))]
    made["effectors"] = {"cup": {"body": "cup", "points": nodes.tolist()}, "turn": {"body": "cup", "orientation": frame}}
    return made


def circle(time, radius):
    """Way from the start (3,) m: once around, without jerk at the ends (Flash & Hogan, J. Neurosci. 5, 1985)."""
    share = np.clip((time - HELD) / TURNS, 0.0, 1.0)
    angle = 2.0 * np.pi * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return radius * np.array([1.0 - np.cos(angle), np.sin(angle), 0.0])


def carry(radius):
    """One row a step from when the controller takes over, the way of the cup (steps, 3) m, and the simulation at its end.

    Columns: time (s), distance of the cup from its place (m), its rotation (rad), three normal forces (N), points that take part,
    that stick and that slip, smallest gap (m), seconds taken.
    """
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(scene(Path(folder)), threads=1)
    sim.step(round(HELD / STEP))
    cup, turn = sim.effector("cup"), sim.effector("turn")
    grips = [sim.contact(f"grip_{finger}") for finger in range(gripper.FINGERS)]
    start, rotation = cup.position.copy(), turn.value.copy()
    ik = sinew.InverseController(sim, targets={"cup": start, "turn": rotation}, weights={"turn": ARM**2},
                                 contacts={grip.name: {"normal_force": {"min": LEAST}} for grip in grips})  # fmt: skip
    rows, way = [], []
    while sim.time < END - 0.5 * STEP:
        asked = start + circle(sim.time + STEP, radius)
        ik.targets["cup"] = asked
        began = time.process_time()
        sim.step()
        taken = time.process_time() - began
        states = np.concatenate([np.array(grip.states) for grip in grips])
        rows.append((sim.time, np.linalg.norm(cup.position - asked), np.linalg.norm(turn.value - rotation),
                     *(grip.normal_force for grip in grips), len(sim.contact_problem().friction), np.sum(states == "stick"),
                     np.sum(states == "slip"), min(grip.gap for grip in grips), taken))  # fmt: skip
        way.append(cup.position - start)
    return np.array(rows), np.array(way), sim


def report(rows):
    print(f"the cup is off its path by {1e3 * np.median(rows[:, 1]):.5f} mm (median), {1e3 * np.quantile(rows[:, 1], 0.95):.4f} mm (95 %), "
          f"{1e3 * rows[:, 1].max():.3f} mm (largest), turned by {np.degrees(np.median(rows[:, 2])):.5f} degrees (largest "
          f"{np.degrees(rows[:, 2].max()):.3f}); normal forces {rows[:, 3:6].min():.3f} to {rows[:, 3:6].max():.3f} N; "
          f"{np.median(rows[:, 6]):.0f} points take part ({rows[:, 6].max():.0f} at most), {np.median(rows[:, 7]):.0f} stick and "
          f"{np.median(rows[:, 8]):.0f} slip; gap >= {1e6 * rows[:, 9].min():.3f} um; "
          f"{1e3 * np.median(rows[:, 10]):.1f} ms a step (95 %: {1e3 * np.quantile(rows[:, 10], 0.95):.1f})")  # fmt: skip


def draw(rows, way, radius, sim, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 4, figsize=(15, 4), width_ratios=[1.2, 1, 1, 1])
    axes[0].imshow(sinew.render(sim, size=(800, 760)))
    axes[0].set_axis_off()
    asked = np.array([circle(moment, radius) for moment in np.linspace(HELD, HELD + TURNS, 200)])
    axes[1].plot(1e3 * asked[:, 0], 1e3 * asked[:, 1], color="0.75", lw=5, label="asked")
    axes[1].plot(1e3 * way[:, 0], 1e3 * way[:, 1], label="cup")
    axes[1].set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    axes[1].legend(loc="center")
    axes[2].semilogy(rows[:, 0], 1e3 * np.maximum(rows[:, 1], 1e-9), label="distance [mm]")
    axes[2].semilogy(rows[:, 0], np.degrees(np.maximum(rows[:, 2], 1e-9)), label="rotation [degrees]")
    axes[2].set(xlabel="time [s]", ylabel="error of the cup's pose")
    axes[2].legend()
    axes[3].plot(rows[:, 0], rows[:, 3:6], label=[f"finger {k}" for k in range(gripper.FINGERS)])
    axes[3].axhline(LEAST, color="0.6", lw=0.8)
    axes[3].set(xlabel="time [s]", ylabel="normal force [N]", ylim=(0.0, None))
    axes[3].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--radius", type=float, default=5.0, help="of the circle, mm")
    parser.add_argument("--out", type=Path, help="folder for manipulation.png")
    given = parser.parse_args()
    radius = 1e-3 * given.radius
    rows, way, sim = carry(radius)
    report(rows)
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(rows, way, radius, sim, given.out / "manipulation.png")


if __name__ == "__main__":
    main()
