#!/usr/bin/python3
"""A soft trunk with eight cables follows a circle with its tip: prints a table, and draws a picture.

Run by `make demo`; or, after `make build`:
    PYTHONPATH=build/release/python /usr/bin/python3 examples/trunk/demo.py [--picture FILE]
"""

import argparse
import pathlib
import time

import matplotlib.pyplot as plt
import numpy as np

import sinew

SCENE = pathlib.Path(__file__).with_name("circle.yaml")
PERIOD = 5.0  # s per turn, as in the scene


def simulate():
    """Simulates two turns of the circle. Returns the simulation and the results of each step."""
    sim = sinew.load(SCENE)
    cables = list(sim.actuators.values())
    steps = round(2 * PERIOD / sim.time_step)
    seen = {
        "time": np.arange(1, steps + 1) * sim.time_step,
        "tip": np.zeros((steps, 3)),
        "error": np.zeros(steps),
        "tension": np.zeros((steps, len(cables))),
        "milliseconds": np.zeros(steps),
        "status": [],
        "poses": [],
    }
    for k in range(steps):
        start = time.perf_counter()
        sim.step()
        seen["milliseconds"][k] = 1e3 * (time.perf_counter() - start)
        seen["tip"][k] = sim.effector("tip").position
        seen["error"][k] = sim.controller.error
        seen["tension"][k] = [cable.tension for cable in cables]
        seen["status"].append(sim.controller.status)
        if k in (round(steps * 0.625), round(steps * 0.875)):
            points = [cable.points.copy() for cable in cables]
            seen["poses"].append((sim.body("trunk").positions.copy(), points))
    return sim, seen


def surface(hexahedra):
    """(m, 3): triangles of the faces that belong to a single hexahedron."""
    sides = ([0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7])
    faces = np.concatenate([hexahedra[:, side] for side in sides])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = faces[first[count == 1]]
    return np.concatenate([outer[:, [0, 1, 2]], outer[:, [0, 2, 3]]])


def table(sim, seen):
    second = seen["time"] > PERIOD
    error = 1e3 * seen["error"][second]
    share = np.mean([status == "on-target" for status in np.array(seen["status"])[second]])
    rows = [
        ("robot", f"{len(sim.body('trunk').positions)} nodes, {len(sim.body('trunk').hexahedra)} "
                  f"hexahedra, {len(sim.actuators)} cables"),
        ("simulated", f"{sim.time:g} s in {sim.steps} steps of {1e3 * sim.time_step:g} ms"),
        ("computing time a step", f"median {np.median(seen['milliseconds']):.2f} ms, 95 % under "
                                  f"{np.percentile(seen['milliseconds'], 95):.2f} ms"),
        ("real-time factor", f"{1e3 * sim.time / seen['milliseconds'].sum():.1f}"),
        ("distance to the target", f"mean {error.mean():.4f} mm, largest {error.max():.4f} mm "
                                   "(second turn)"),
        ("on target", f"{100 * share:.0f} % of the second turn's steps"),
        ("largest tension", f"{seen['tension'].max():.2f} N"),
        ("slack cables", f"{np.mean(np.sum(seen['tension'] == 0, axis=1)):.1f} on average"),
    ]
    width = max(len(name) for name, _ in rows) + 2
    print("\n".join(f"{name:<{width}}{value}" for name, value in rows))


def draw_robot(axes, sim, seen):
    faces = surface(sim.body("trunk").hexahedra)
    for (nodes, cables), shade in zip(seen["poses"], (0.35, 1.0)):
        axes.plot_trisurf(*(1e3 * nodes.T), triangles=faces, color="#e8a87c", alpha=0.28 * shade,
                          linewidth=0, shade=True)
        for points in cables:
            axes.plot(*(1e3 * points.T), color="#30475e", linewidth=0.9, alpha=shade)
    axes.plot(*(1e3 * seen["tip"].T), color="#0072b2", linewidth=1.6, label="tip")
    turn = np.linspace(0, 2 * np.pi, 100)
    axes.plot(30 * np.cos(turn), 30 * np.sin(turn), 180, "--", color="#d55e00", linewidth=1.2,
              label="target")
    axes.set_box_aspect((1, 1, 2.2))
    axes.set(xlim=(-45, 45), ylim=(-45, 45), zlim=(0, 200), xlabel="x (mm)", ylabel="y (mm)",
             zlabel="z (mm)")
    axes.view_init(elev=16, azim=-62)
    axes.legend(loc="upper left")


def draw(sim, seen, picture):
    figure = plt.figure(figsize=(11, 6.2))
    grid = figure.add_gridspec(2, 2, width_ratios=(1.15, 1))
    draw_robot(figure.add_subplot(grid[:, 0], projection="3d"), sim, seen)
    error = figure.add_subplot(grid[0, 1])
    error.semilogy(seen["time"], 1e3 * seen["error"], color="#0072b2")
    error.set(xlabel="time (s)", ylabel="distance to target (mm)", xlim=(0, seen["time"][-1]))
    error.grid(alpha=0.3)
    tension = figure.add_subplot(grid[1, 1])
    for k, name in enumerate(sim.actuators):
        tension.plot(seen["time"], seen["tension"][:, k], label=name, linewidth=1.2,
                     linestyle="-" if k < 4 else "--")
    tension.set(xlabel="time (s)", ylabel="cable tension (N)", xlim=(0, seen["time"][-1]))
    tension.legend(ncol=2, fontsize="x-small")
    tension.grid(alpha=0.3)
    figure.tight_layout()
    picture.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(picture, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--picture", type=pathlib.Path, default=pathlib.Path("out/demo/trunk.png"))
    arguments = parser.parse_args()
    sim, seen = simulate()
    table(sim, seen)
    draw(sim, seen, arguments.picture)
    print(f"\npicture: {arguments.picture}")
    print("to see it move, and to drive it: make view")


if __name__ == "__main__":
    main()
