#!/usr/bin/env python3
"""Three soft fingers hold an egg-shaped shell with 1 N each while the hand moves: contact forces as targets.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/steer/grip.py [--force 1.0] [--hold 60] [--out FOLDER]

The hand of examples/grasp (three trunks with one cable each) closes on the standing shell. From the moment at which all
fingers touch it, an inverse controller chooses the three tensions, and is asked for nothing but the normal force of each
finger. The hand then rises by 60 mm within a second and goes aside by 40 mm within another. With --hold it stays there for
so many seconds, and the creep of the shell is printed. FOLDER gets grip.png.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

import meshio
import numpy as np
import sinew

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "grasp"))
import grasp  # noqa: E402

grasp.ABOVE = 0.2  # m: the fingers reach farther down than around the cup


ACROSS, TALL, WALL = 26e-3, 34e-3, 2e-3  # m: half axes of the shell and its thickness
FLAT, CELLS = -0.8, 6  # where its lower end is cut, of the half axis; cells along a side of each of the six parts
LIFTS, LIFTED, SWUNG, END = 2.0, 3.0, 4.0, 6.0  # s
ASIDE = 40e-3  # m


def egg():
    """Nodes (m) and hexahedra, one through the wall: a cube blown up to an ellipsoid, its lower end flat."""
    side = np.tan(np.linspace(-0.25, 0.25, CELLS + 1) * np.pi)
    index, directions, quads = {}, [], []

    def node(place):
        key = tuple(np.round(place, 9))
        if key not in index:
            index[key] = len(directions)
            directions.append(np.array(place) / np.linalg.norm(place))
        return index[key]

    for axis in range(3):
        for sign in (-1.0, 1.0):
            grid = np.empty((CELLS + 1, CELLS + 1), dtype=int)
            for i, u in enumerate(side):
                for j, v in enumerate(side):
                    place = np.roll([sign, u, v], axis)
                    grid[i, j] = node(place)
            for i in range(CELLS):
                for j in range(CELLS):
                    quad = [grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]]
                    quads.append(quad if sign > 0 else quad[::-1])
    directions = np.array(directions)
    outer = directions * [ACROSS, ACROSS, TALL]
    inner = directions * [ACROSS - WALL, ACROSS - WALL, TALL - WALL]
    for shell, low in ((outer, FLAT * TALL), (inner, FLAT * TALL + WALL)):
        shell[:, 2] = np.maximum(shell[:, 2], low)
    nodes = np.vstack([inner, outer]) - [0.0, 0.0, FLAT * TALL]
    quads = np.array(quads)
    return nodes, np.hstack([quads, quads + len(directions)])


def smooth(path, start, end, length):
    """A table of a motion without jerk at its ends: 10 s^3 - 15 s^4 + 6 s^5 (Flash & Hogan, J. Neurosci. 5, 1985)."""
    share = np.linspace(0.0, 1.0, 101)
    moved = length * (10 * share**3 - 15 * share**4 + 6 * share**5)
    np.savetxt(path, np.column_stack([start + share * (end - start), moved]), delimiter=",")
    return {"file": str(path)}


def scene(folder):
    shell = folder / "egg.vtu"
    nodes, cells = egg()
    meshio.write(shell, meshio.Mesh(nodes, [("hexahedron", cells)]))
    made = grasp.scene(shell)
    made["bodies"]["cup"] |= {
        "density": "1200 kg/m^3",
        "material": {"model": "neo-hookean", "young_modulus": "20 MPa", "poisson_ratio": 0.4},
    }
    for name, body in made["bodies"].items():
        if name.startswith("finger"):
            body["motion"] = {
                "z": smooth(folder / "up.csv", LIFTS, LIFTED, grasp.LIFT),
                "x": smooth(folder / "aside.csv", LIFTED, SWUNG, ASIDE),
            }
    for cable in made["actuators"].values():
        cable["limits"] = {"tension": {"min": 0.0, "max": 20.0}, "displacement": {"rate": "40 mm/s"}}
        cable["command"] = {"displacement": {"ramp": {"to": 16e-3, "duration": 2.0}}}
    made["duration"] = END
    return made


def load():
    with tempfile.TemporaryDirectory() as folder:
        return sinew.load(scene(Path(folder)), threads=1)


def hold(force):
    """One row a step (time, three normal forces, height, smallest gap, seconds taken), and the simulation at its end."""
    sim = load()
    ik, rows, grips = None, [], grasp.grips(sim)
    while sim.time < END - 1e-9:
        if ik is None and min(grip.normal_force for grip in grips) > 0.0:
            asked = {f"grip_{k}": {"normal_force": force} for k in range(grasp.FINGERS)}
            ik = sinew.InverseController(sim, contacts=asked)
        start = time.process_time()
        sim.step()
        taken = time.process_time() - start
        rows.append((sim.time, *(grip.normal_force for grip in grips), grasp.risen(sim), np.fmin.reduce([grip.gap for grip in grips]), taken))
    return np.array(rows), sim


def creep(sim, seconds):
    """How far the shell's nodes go from where they are now, at most (m), while the simulation runs on."""
    shell, farthest = sim.body("cup"), 0.0
    start = shell.positions.copy()
    for _ in range(round(seconds / sim.time_step)):
        sim.step()
        farthest = max(farthest, np.linalg.norm(shell.positions - start, axis=1).max())
    return farthest


def report(force, rows):
    """The largest deviation of a finger's force while the hand moves and after, a part of what is asked."""
    late = rows[rows[:, 0] > LIFTS + 0.25]
    off = np.abs(late[:, 1:4] / force - 1.0).max()
    print(f"asked {force:g} N: fingers {np.round(late[-1, 1:4], 4)} N at the end, off by {100 * off:.2f} % at most, the shell is "
          f"{1e3 * late[-1, 4]:.1f} mm higher, gap >= {1e6 * np.nanmin(late[:, 5]):.3f} um, {1e3 * np.median(late[:, 6]):.1f} ms a step")  # fmt: skip
    return off


def draw(force, rows, sim, path):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(11, 4.5))
    axes[0].imshow(sinew.render(sim, size=(800, 700)))
    axes[0].set_axis_off()
    axes[1].plot(rows[:, 0], rows[:, 1:4], label=[f"finger {k}" for k in range(grasp.FINGERS)])
    axes[1].axhline(force, color="0.6", lw=0.8)
    axes[1].axvspan(LIFTS, LIFTED, color="0.93")
    axes[1].axvspan(LIFTED, SWUNG, color="0.96")
    axes[1].set(xlabel="time [s]", ylabel="normal force [N]", title="The hand rises from 2 s and goes aside from 3 s")
    axes[1].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--force", type=float, default=1.0, help="normal force of each finger, N")
    parser.add_argument("--hold", type=float, default=0.0, help="seconds to hold the shell afterwards")
    parser.add_argument("--out", type=Path, help="folder for grip.png")
    given = parser.parse_args()
    rows, sim = hold(given.force)
    report(given.force, rows)
    if given.hold > 0.0:
        print(f"within {given.hold:g} s the shell creeps by {1e9 * creep(sim, given.hold):.1f} nm, it is {1e3 * 2 * TALL:.0f} mm tall")
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
        draw(given.force, rows, sim, given.out / "grip.png")


if __name__ == "__main__":
    main()
