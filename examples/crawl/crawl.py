#!/usr/bin/env python3
"""A strip of silicone with three air chambers crawls over a floor: distance versus the coefficient of friction.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/crawl/crawl.py [--out FOLDER] [--friction MU ...]

The chambers are rows of bellows on a sole that fabric keeps from stretching, so pressure bends the middle of the strip
upwards, and it stands on its two ends. The chambers fill one after the other, front, centre, rear, and empty in the same
order. The strip then moves towards its front, by 15 mm per cycle at a length of 115 mm; the opposite order moves it as far
in the other direction (docs/locomotion.md explains why). Writes crawl.png to FOLDER, and crawl.yaml for `sinew run` and
`sinew view`.
"""

import argparse
import tempfile
from pathlib import Path

import meshio
import numpy as np
import sinew
from sinew.gym.scenes import hexahedra

CELL = np.array([2.5, 5.0, 3.0]) * 1e-3  # m, edges of a hexahedron
BELLOWS, PITCH = 3, 5  # bellows per chamber; cells from one bellow to the next
SILICONE = {"model": "neo-hookean", "young_modulus": "264 kPa", "poisson_ratio": 0.49,  # Dragon Skin 10; its viscosity
            "viscosity": [{"relative_modulus": 0.2, "relaxation_time": "50 ms"}]}  # is assumed
FABRIC = {"thickness": "0.1 mm", "young_modulus": "100 MPa", "poisson_ratio": 0.3}  # on the lower side of the sole
CHAMBERS = ("front", "centre", "rear")  # in the order of the gait
PRESSURE, PERIOD, STEP = 25e3, 4.0, 0.02  # Pa, s, s
RISE, HOLD, LAG = 0.2, 0.4, 0.1  # fractions of the period: filling or emptying, full, lag between chambers
SHOWN = 0.5  # coefficient of friction of the cycle in the picture
FRICTION = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


def cells():
    """(nx, 6, 6) bool: whether a cell is silicone."""
    solid = np.zeros((len(CHAMBERS) * BELLOWS * PITCH + 1, 6, 6), bool)
    solid[:, :, :3] = True  # the sole
    for first in range(1, len(solid), PITCH):
        solid[first : first + 4, :, 3:] = True  # a bellow: wall, two cells of air, wall
        solid[first + 1 : first + 3, 1:5, 1:5] = False
    for chamber in range(1, len(solid), BELLOWS * PITCH):
        solid[chamber + 1 : chamber + BELLOWS * PITCH - 2, 2:4, 1] = False  # the channel that connects the bellows
    return solid


def write_mesh(path):
    solid = cells()
    nodes, cubes, _ = hexahedra.voxels(solid, [np.arange(count + 1) * edge for count, edge in zip(solid.shape, CELL)])
    meshio.write(path, meshio.Mesh(nodes, [("hexahedron", cubes)]))


def inside(chamber):
    """A point (m) in the first bellow of a chamber, numbered from the rear."""
    return ((chamber * BELLOWS * PITCH + 3) * CELL[0], 3 * CELL[1], 2 * CELL[2])


def scene(mesh, friction):
    """The scene as a dict, without commands."""
    sole = [[2 * i * CELL[0], 2 * j * CELL[1], 0.0] for i in range(len(cells()) // 2 + 1) for j in range(4)]
    chambers = {name: {"type": "chamber", "body": "strip", "surface": {"inside": inside(2 - k)}}
                for k, name in enumerate(CHAMBERS)}  # fmt: skip
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": "backward-euler", "time_step": STEP, "duration": 3 * PERIOD,
        "bodies": {"strip": {"type": "fem", "mesh": {"file": str(mesh)}, "material": SILICONE, "density": "1070 kg/m^3"}},
        "contacts": {"floor": {"body": "strip", "surface": {"plane": {}}, "points": sole, "friction": friction}},
        "membranes": {"fabric": {"body": "strip", "surface": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}, **FABRIC}},
        "actuators": chambers,
    }  # fmt: skip


def pressure(chamber, cycles, lag=LAG, period=PERIOD, full=PRESSURE):
    """(n, 2): times (s) and pressures (Pa) of the chamber with index `chamber` in the gait."""
    starts = (np.arange(cycles) + lag * chamber) * period
    phases = np.array([[0.0, 0.0], [RISE, 1.0], [RISE + HOLD, 1.0], [2 * RISE + HOLD, 0.0]])
    table = np.vstack([phases * [period, full] + [start, 0.0] for start in starts])
    return table if chamber == 0 else np.vstack([[[0.0, 0.0]], table])  # a table starts at 0 s


def make(friction, cycles=3, order=CHAMBERS, **changes):
    """The simulation, with commands for its chambers."""
    with tempfile.TemporaryDirectory() as folder:
        write_mesh(Path(folder) / "crawl.vtu")
        sim = sinew.load(scene(Path(folder) / "crawl.vtu", friction), **changes)
    for k, name in enumerate(order):
        sim.actuator(name).pressure = pressure(k, cycles)
    return sim


def ends(strip):
    """Mean x (m) of the rear and of the front edge of the sole."""
    x, _, z = strip.rest_positions.T
    sole = z < 0.1 * CELL[2]
    return [strip.positions[sole & (np.abs(x - at) < 0.1 * CELL[0]), 0].mean() for at in (x.min(), x.max())]


def crawl(friction, **more):
    """One cycle: the distance (m), and per step the time (s), the two ends (m) and the positions of the nodes (m)."""
    sim = make(friction, cycles=1, **more)
    strip = sim.body("strip")
    start = strip.positions[:, 0].mean()
    times, both, frames = [0.0], [ends(strip)], [strip.positions.copy()]
    while sim.time < PERIOD - 0.5 * sim.time_step:
        sim.step()
        if sim.report.flagged:
            raise RuntimeError(f"the step to {sim.time:.3f} s is {sim.report.status}")
        times.append(sim.time)
        both.append(ends(strip))
        frames.append(strip.positions.copy())
    return strip.positions[:, 0].mean() - start, np.array(times), np.array(both), frames


def write_scene(folder):
    """crawl.yaml with its mesh and the tables of its pressures."""
    write_mesh(folder / "crawl.vtu")
    described = scene(folder / "crawl.vtu", SHOWN)
    for k, name in enumerate(CHAMBERS):
        table = np.vstack([pressure(k, 3), [[4 * PERIOD, 0.0]]])
        np.savetxt(folder / f"{name}.csv", table, delimiter=",")
        described["actuators"][name]["command"] = {"pressure": {"file": str(folder / f"{name}.csv"), "unit": "Pa"}}
    (folder / "crawl.yaml").write_text(sinew.load(described).to_yaml(), encoding="utf-8")


def draw(path, times, both, frames, friction, distances):
    import matplotlib.pyplot as plt

    figure, (side, motion, figures) = plt.subplots(
        1, 3, figsize=(12, 3.6), layout="constrained", width_ratios=[1.1, 1, 1]
    )
    moments = np.linspace(0.0, 1.0, 7)
    for shown, share in enumerate(moments):
        nodes = 1e3 * frames[round(share * (len(frames) - 1))]
        side.plot(nodes[:, 0], nodes[:, 2] + 38 * (len(moments) - 1 - shown), ".", markersize=0.7, color="tab:blue")
        side.text(-42, 38 * (len(moments) - 1 - shown), f"{share * PERIOD:.1f} s", fontsize=7)
    side.set(xlabel="x (mm)", yticks=[], title="one cycle", xlim=(-44, 140))
    for end, name in enumerate(("rear", "front")):
        motion.plot(times, 1e3 * (both[:, end] - both[0, end]), label=f"{name} end")
    motion.set(xlabel="time (s)", ylabel="moved (mm)", title="the ends take turns")
    motion.legend(frameon=False)
    figures.plot(friction, 1e3 * np.array(distances), "o-", color="tab:green")
    figures.set(xlabel="coefficient of friction", ylabel="distance per cycle (mm)", ylim=(0, None), title="one cycle of 4 s")
    figure.savefig(path, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/crawl"))
    parser.add_argument("--friction", type=float, nargs="+", default=FRICTION)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    write_scene(arguments.out.resolve())
    distances = []
    print("friction  distance per cycle (mm)")
    for friction in arguments.friction:
        distance, *run = crawl(friction)
        distances.append(distance)
        shown = run if friction == SHOWN or len(distances) == 1 else shown
        print(f"{friction:8.2f}  {1e3 * distance:6.2f}", flush=True)
    draw(arguments.out / "crawl.png", *shown, arguments.friction, distances)
    print(arguments.out)


if __name__ == "__main__":
    main()
