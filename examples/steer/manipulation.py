#!/usr/bin/env python3
"""Three soft fingers carry a soft cup along a circle without turning it: the pose of a grasped object as the target of twelve cables.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/manipulation.py [--radius 5] [--out FOLDER]

Each finger is a tapered body with four cables. A neck joins it to a concave pad, which fits the wall of the cup and tilts with it.
The fingers close on the standing cup and lift it. Then an inverse controller takes over the cables. Its targets are the position
and the rotation of the cup, and a normal force of at least 0.3 N at each finger. Only contact between soft bodies connects the cup
to the fingers. The picture is written to FOLDER/manipulation.png.
"""

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
import sinew
from sinew.gym.scenes import hexahedra

FINGERS = 3
FRICTION, LEAST = 0.9, 0.3  # coefficient; normal force of each finger, N
PULL, LIFT = 9e-3, 30e-3  # m
CLOSED, LIFTS, LIFTED, HELD, END = 0.8, 1.0, 1.5, 1.7, 3.9  # s
TURNS = 2.0  # s: duration of the circle
STEP = 0.01  # s
TOLERANCE = 1e-2  # relative: one iteration per step; the controller corrects its error in the next step
ARM = 30e-3  # m: a rotation of 1 rad weighs as much as this distance
CUP_RADII, CUP_HEIGHT, CUP_WALL, CUP_FLOOR = (20e-3, 34e-3), 70e-3, 3e-3, 5e-3  # m; outer radii at floor and rim
QUARTER, LAYERS = 6, 6  # cells of the cup along a quarter of its circumference, and layers between floor and rim
APART, ABOVE, LENGTH, FIXED = 54e-3, 225e-3, 200e-3, 20e-3  # m: distance of a finger's axis from the middle, height of its foot above the table
WIDE, DEEP = (24e-3, 18e-3), (22e-3, 14e-3)  # m: width and depth of a finger at its foot and tip
PAD, NECK, SLIT = (36e-3, 24e-3, 5e-3), 8e-3, 6e-3  # m: height, width and thickness; the neck's height and length
SOFT = {"density": "1070 kg/m^3", "material": {"model": "neo-hookean", "poisson_ratio": 0.45}}


def finger():
    """Nodes (m) and hexahedra of a finger with the axis x = 0, y = 0 and the cup at negative x, and its length without the pad (m).

    There are four layers of cells along x: the pad, the neck, and two in the finger.
    """
    middle = LENGTH - 0.5 * PAD[0]  # of the pad, below the foot; the neck and the end of the finger are there
    upper, lower = np.linspace(LENGTH - PAD[0], middle - 0.5 * NECK, 3), np.linspace(middle + 0.5 * NECK, LENGTH, 3)
    below = np.concatenate([np.linspace(0.0, upper[0], 11), upper[1:], lower])
    cell = 0.5 * (below[1:] + below[:-1])
    solid = np.stack([cell > upper[0], np.abs(cell - middle) < 0.5 * NECK, cell < lower[0], cell < lower[0]])
    planes = [np.arange(size + 1.0) for size in (4, 3, len(cell))]
    nodes, hexahedra_, places = hexahedra.voxels(np.repeat(solid[:, None, :], 3, axis=1), planes)
    layer, depth = places[:, 0], below[places[:, 2]]
    half_wide, half_deep = (0.5 * np.interp(depth, [0.0, LENGTH], size) for size in (WIDE, DEEP))
    y = np.where(layer < 2, 0.5 * PAD[1], half_wide) * (2.0 * places[:, 1] / 3.0 - 1.0)
    radius = np.interp(ABOVE - depth, [0.0, CUP_HEIGHT], CUP_RADII)
    back = -0.5 * np.interp(middle, [0.0, LENGTH], DEEP) - SLIT - (radius - np.sqrt(radius**2 - y**2))
    x = np.choose(layer, [back - PAD[2], back, -half_deep, np.zeros_like(y), half_deep])
    # Depth points down, so the bottom and top layers of a hexahedron are swapped.
    return np.column_stack([x, y, ABOVE - depth]), hexahedra_[:, [4, 5, 6, 7, 0, 1, 2, 3]], lower[0]


def cables(finger, end):
    """Four cables of a finger (in, one side, out, the other side), the first of which closes it."""
    turn = 2.0 * np.pi * finger / FINGERS
    outwards, aside = np.array([np.cos(turn), np.sin(turn), 0.0]), np.array([-np.sin(turn), np.cos(turn), 0.0])
    depth = np.append(0.0, np.linspace(FIXED + 1e-3, end - 4e-3, 18))  # of a cable's points below the foot
    away = {side: np.interp(depth, [0.0, LENGTH], size) for side, size in (("deep", [9e-3, 4.5e-3]), ("wide", [11e-3, 8e-3]))}
    made = {}
    for number, (direction, side) in enumerate(((-outwards, "deep"), (aside, "wide"), (outwards, "deep"), (-aside, "wide"))):
        points = APART * outwards + away[side][:, None] * direction + (ABOVE - depth)[:, None] * [0.0, 0.0, 1.0]
        close = {"displacement": {"ramp": {"to": PULL, "duration": CLOSED}}}
        made[f"cable_{finger}_{number}"] = {
            "type": "cable", "body": f"finger_{finger}", "pull": "body", "points": points.tolist(),
            "limits": {"tension": {"min": 0.0, "max": 20.0}, "displacement": {"rate": "200 mm/s"}},
            "command": close if number == 0 else {"tension": 0.2},
        }  # fmt: skip
    return made


def soft(file, modulus):
    return {"type": "fem", "mesh": {"file": str(file)}, **SOFT, "material": {**SOFT["material"], "young_modulus": modulus}}


def scene(folder):
    """The scene. Its meshes are written to the folder, which must exist until the scene is loaded."""
    cup, cells = hexahedra.cup(QUARTER, LAYERS, CUP_RADII, CUP_HEIGHT, CUP_WALL, CUP_FLOOR)
    hexahedra.write(folder / "cup.vtk", cup, cells)
    bodies = {"cup": soft(folder / "cup.vtk", "500 kPa")}
    contacts = {"table": {"body": "cup", "surface": {"plane": {}}, "friction": FRICTION}}
    actuators = {}
    nodes, cells, end = finger()
    lift = {"to": LIFT, "start": LIFTS, "duration": LIFTED - LIFTS}
    for k in range(FINGERS):
        turn = 2.0 * np.pi * k / FINGERS
        about_z = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
        hexahedra.write(folder / f"finger_{k}.vtk", (nodes + [APART, 0.0, 0.0]) @ about_z.T, cells)
        bodies[f"finger_{k}"] = soft(folder / f"finger_{k}.vtk", "600 kPa") | {
            "fixed": {"box": [-0.2, -0.2, ABOVE - FIXED - 1e-6, 0.2, 0.2, ABOVE + 1e-6]}, "motion": {"z": {"ramp": lift}},
        }  # fmt: skip
        contacts[f"grip_{k}"] = {"between": [f"finger_{k}", "cup"], "friction": FRICTION}
        actuators |= cables(k, end)
    rim = cup[cup[:, 2] > CUP_HEIGHT - 1e-6]
    frame = [[0.0, 0.0, 0.0], *(rim[np.argmax(rim[:, axis])].tolist() for axis in (0, 1))]
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": STEP,
        "solver": {"tolerance": TOLERANCE},
        "bodies": bodies, "actuators": actuators, "contacts": contacts,
        "effectors": {"cup": {"body": "cup", "points": cup.tolist()}, "turn": {"body": "cup", "orientation": frame}},
    }  # fmt: skip


def circle(time, radius):
    """Way from the start (3,) m: once around, without jerk at the ends (Flash & Hogan, J. Neurosci. 5, 1985)."""
    share = np.clip((time - HELD) / TURNS, 0.0, 1.0)
    angle = 2.0 * np.pi * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return radius * np.array([1.0 - np.cos(angle), np.sin(angle), 0.0])


def hold():
    """The simulation after the fingers have lifted the cup."""
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(scene(Path(folder)), threads=1)
    sim.step(round(HELD / STEP))
    return sim


def carry(sim, radius):
    """Lets the controller carry the cup. Returns one row per step, and the displacement of the cup, (steps, 3) m.

    Columns: time (s), distance of the cup from its target (m), its rotation (rad), three normal forces (N), numbers of points in the
    contact law, of sticking and of slipping ones, smallest gap (m), processor time (s).
    """
    cup, turn = sim.effector("cup"), sim.effector("turn")
    grips = [sim.contact(f"grip_{finger}") for finger in range(FINGERS)]
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
                     np.sum(states == "slip"), np.fmin.reduce([grip.gap for grip in grips]), taken))  # fmt: skip
        way.append(cup.position - start)
    return np.array(rows), np.array(way)


def report(rows):
    print(f"the cup is off its path by {1e3 * np.median(rows[:, 1]):.5f} mm (median), {1e3 * np.quantile(rows[:, 1], 0.95):.4f} mm (95 %), "
          f"{1e3 * rows[:, 1].max():.3f} mm (largest), turned by {np.degrees(np.median(rows[:, 2])):.5f} degrees (largest "
          f"{np.degrees(rows[:, 2].max()):.3f}); normal forces {rows[:, 3:6].min():.3f} to {rows[:, 3:6].max():.3f} N; "
          f"{np.median(rows[:, 6]):.0f} points in the law ({rows[:, 6].min():.0f} to {rows[:, 6].max():.0f}), "
          f"{np.median(rows[:, 7] + rows[:, 8]):.0f} with a force, of which {np.median(rows[:, 7]):.0f} stick; "
          f"gap >= {1e6 * np.nanmin(rows[:, 9]):.3f} um; "
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
    axes[3].plot(rows[:, 0], rows[:, 3:6], label=[f"finger {k}" for k in range(FINGERS)])
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
    sim = hold()
    rows, way = carry(sim, radius)
    report(rows)
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(rows, way, radius, sim, given.out / "manipulation.png")


if __name__ == "__main__":
    main()
