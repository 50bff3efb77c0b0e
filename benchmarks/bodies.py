"""Time of a step and of loading as a function of the number of bodies and contact points.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/bodies.py [--points 1000] [--bodies 40] [--threads 1 2]

- boxes: separate rigid boxes of 30 x 30 x 20 mm on a table, with one contact between each box and the table;
- boxes, all: the same with `between: all`, which makes every pair a contact, although no two boxes come close;
- balls, all: rigid balls of 20 mm that settle in layers between four walls, `between: all`;
- soft blocks: 40 x 40 x 20 mm, each with 100 points on a plane, dragged by an inclined gravity.
Backward Euler, 2 ms, mu = 0.5. Times are medians over the second half of the steps: processor time with one thread, wall time with
more. Points are those in the contact problem of the last step. `--points 5000 --bodies 100` is the whole table (gigabytes, minutes).
"""

import argparse
import time
import warnings

import numpy as np
import sinew

STEPS, MAX_SECONDS = 20, 20.0
BALLS_A_LAYER = 25


def rigid(shape, position, **more):
    return {"type": "rigid", "shape": shape, "density": 1000.0, "pose": {"position": [float(x) for x in position]}, **more}


def on_a_grid(count, spacing):
    across = int(np.ceil(np.sqrt(count)))
    return [(spacing * (k % across - across / 2), spacing * (k // across - across / 2)) for k in range(count)]


def boxes(count, every_pair):
    bodies = {"table": rigid({"box": [3.0, 3.0, 0.02]}, [0, 0, -0.01], fixed=True)}
    bodies |= {f"box{k}": rigid({"box": [0.03, 0.03, 0.02]}, [*p, 0.0101]) for k, p in enumerate(on_a_grid(count, 0.05))}
    if every_pair:
        return bodies, {"all": {"between": "all", "friction": 0.5}}
    return bodies, {f"floor{k}": {"between": ["table", f"box{k}"], "friction": 0.5} for k in range(count)}


def balls(count):
    rng = np.random.default_rng(1)
    bodies = {"table": rigid({"box": [3.0, 3.0, 0.02]}, [0, 0, -0.01], fixed=True)}
    for k, (x, y) in enumerate(((1, 0), (-1, 0), (0, 1), (0, -1))):
        wall = {"box": [0.02 if x else 0.3, 0.02 if y else 0.3, 1.0]}
        bodies[f"wall{k}"] = rigid(wall, [0.0665 * x, 0.0665 * y, 0.5], fixed=True)
    layer = [(0.022 * (i % 5 - 2), 0.022 * (i // 5 - 2)) for i in range(BALLS_A_LAYER)]
    for k in range(count):
        place = np.array(layer[k % BALLS_A_LAYER]) + rng.uniform(-5e-4, 5e-4, 2)
        bodies[f"ball{k}"] = rigid({"sphere": {"radius": 0.01}}, [*place, 0.0105 + 0.021 * (k // BALLS_A_LAYER)])
    return bodies, {"all": {"between": "all", "friction": 0.5}}


def soft_blocks(count):
    block = {"type": "fem", "element": "tet4", "density": 1070.0, "damping": {"stiffness": "2 ms"},
             "material": {"model": "corotational", "young_modulus": 3e5, "poisson_ratio": 0.4},
             "mesh": {"shape": "block", "length": "40 mm", "width": "40 mm", "height": "20 mm", "element_size": "4.4 mm"}}  # fmt: skip
    bodies = {f"block{k}": {**block, "pose": {"position": [*p, 0.0]}} for k, p in enumerate(on_a_grid(count, 0.05))}
    floor = {"surface": {"plane": {"point": [0, 0, -1e-4], "normal": [0, 0, 1]}}, "nodes": {"set": "z_min"}, "friction": 0.5}
    return bodies, {f"floor{k}": {"body": f"block{k}", **floor} for k in range(count)}


def measure(name, parts, gravity, threads):
    bodies, contacts = parts
    begin = time.process_time()
    sim = sinew.load({"sinew": 1, "integrator": "backward-euler", "time_step": 2e-3, "gravity": gravity, "bodies": bodies,
                      "contacts": contacts}, threads=threads)  # fmt: skip
    load = time.process_time() - begin
    clock = time.process_time if threads == 1 else time.perf_counter
    taken = []
    started = time.monotonic()
    while len(taken) < 4 or (len(taken) < STEPS and time.monotonic() - started < MAX_SECONDS):
        start = clock()
        sim.step()
        taken.append(1e3 * (clock() - start))
    points = len(sim.contact_problem().q) // 3  # after the timed steps, because it copies W
    moving = sum(body.get("fixed") is not True for body in bodies.values())
    print(f"| {name} | {moving} | {len(sim.contacts)} | {points} | {threads} | {load:.2f} | {taken[0]:.0f} | "
          f"{np.median(taken[len(taken) // 2 :]):.1f} | {sim.memory / 1e6:.0f} |", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1000, help="most points of boxes and of soft blocks")
    parser.add_argument("--bodies", type=int, default=40, help="most bodies with a contact for every pair")
    parser.add_argument("--threads", type=int, nargs="+", default=[1])
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| scene | bodies | pairs | points | threads | loading, s | first step, ms | a step, ms | MB |\n" + "|---" * 9 + "|")
    down, slanting = [0.0, 0.0, -9.81], [1.0, 0.0, -9.81]
    for threads in given.threads:
        for count in (n for n in (10, 30, 100, 250, 600, 1250) if 4 * n <= given.points):
            measure("boxes", boxes(count, False), down, threads)
        for count in (n for n in (10, 20, 40, 100) if n <= given.bodies):
            measure("boxes, all", boxes(count, True), down, threads)
        for count in (n for n in (25, 50, 100) if n <= given.bodies):
            measure("balls, all", balls(count), down, threads)
        for count in (n for n in (1, 3, 10, 25, 50) if 100 * n <= given.points):
            measure("soft blocks", soft_blocks(count), slanting, threads)


if __name__ == "__main__":
    main()
