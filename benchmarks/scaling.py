#!/usr/bin/python3
"""Time and memory of a step as functions of mesh size: writes docs/images/scaling.png and prints the table and the fitted
exponents of docs/performance.md.

    /usr/bin/python3 benchmarks/scaling.py [--nodes N] [--threads N]

A block of 4 : 1 : 1, clamped at one end and swinging under its weight, of neo-Hookean rubber in linear tetrahedra,
quadratic tetrahedra and hexahedra; backward Euler, one linearisation a step, nested dissection. Each size runs in a
separate process; its memory is the peak reported by the system (resource.getrusage) minus that of Python and the library
before the scene is loaded. On one thread, times are processor times (the wall time of an idle machine), which are split
among the stages in proportion to their wall times. Exponents are slopes of log-log fits over the meshes of more than 2000 nodes.
"""

import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "build" / "release" / "python"))

import numpy as np  # noqa: E402
import sinew  # noqa: E402

NODES = (500, 1000, 2000, 5000, 10000, 20000, 50000, 100000)
COLOURS = {"tet4": "#c8501e", "tet10": "#3a8a4d", "hex8": "#1f5fa8"}
QUANTITIES = {"step": "step (ms)", "factorisation": "factorisation (ms)", "assembly": "assembly (ms)",
              "memory": "peak memory (MB)"}
SIDE, ENOUGH = 0.02, 2000


def peak():
    """Peak memory of this process so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def cells_across(element, nodes):
    """Cells n along the short side for about `nodes` nodes: there are 4 n^3 cells, with one node per cell, or eight if quadratic."""
    return max(1, round((nodes / (32 if element == "tet10" else 4)) ** (1 / 3)))


def measure(element, nodes, threads):
    """Measures one mesh in this process."""
    before = peak()
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.81], "time_step": 0.002, "integrator": "backward-euler",
        "solver": {"ordering": "metis", "threads": threads},
        "bodies": {"block": {"type": "fem", "element": element, "density": 1000.0, "fixed": [{"set": "x_min"}],
                             "material": {"model": "neo-hookean", "shear_modulus": 1e5, "poisson_ratio": 0.45},
                             "damping": {"stiffness": 0.005},
                             "mesh": {"shape": "block", "length": 4 * SIDE, "width": SIDE, "height": SIDE,
                                      "element_size": SIDE / cells_across(element, nodes)}}}})
    times = {"step": [], "factorisation": [], "assembly": []}
    begin = time.monotonic()
    while not times["step"] or (len(times["step"]) < 30 and time.monotonic() - begin < 10):
        start = time.process_time()
        sim.step()
        used, walls = time.process_time() - start, sim.report.times
        whole = used if threads == 1 else walls["total"]
        for kind, values in times.items():
            values.append(1e3 * whole * walls["total" if kind == "step" else kind] / walls["total"])
    found = {kind: statistics.median(values[1:] or values) for kind, values in times.items()}
    body = sim.body("block")
    elements = len(body.hexahedra) if element == "hex8" else len(body.tetrahedra)
    return {**found, "memory": peak() - before, "nodes": len(body.rest_positions), "elements": elements}


def exponent(rows, quantity):
    large = [row for row in rows if row["nodes"] > ENOUGH]
    if len(large) < 2:
        return float("nan")
    return np.polyfit(np.log([r["nodes"] for r in large]), np.log([r[quantity] for r in large]), 1)[0]


def report(results):
    print("| element | nodes | elements | " + " | ".join(QUANTITIES.values()) + " |\n" + "|---" * 7 + "|")
    for element, rows in results.items():
        for row in rows:
            print(f"| {element} | {row['nodes']} | {row['elements']} | "
                  + " | ".join(f"{row[quantity]:.3g}" for quantity in QUANTITIES) + " |")
    print(f"\nExponents of the number of nodes, meshes of more than {ENOUGH} nodes:\n\n| element | "
          + " | ".join(QUANTITIES) + " |\n" + "|---" * 5 + "|")
    for element, rows in results.items():
        print(f"| {element} | " + " | ".join(f"{exponent(rows, quantity):.2f}" for quantity in QUANTITIES) + " |")


def draw(results, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(13.8, 4.0), constrained_layout=True)
    for axis, quantity in zip(axes, ("step", "factorisation", "memory")):
        for element, rows in results.items():
            axis.loglog([r["nodes"] for r in rows], [r[quantity] for r in rows], "o-", color=COLOURS[element], ms=4,
                        label=f"{element}, slope {exponent(rows, quantity):.2f}")
        axis.set(xlabel="nodes", ylabel=QUANTITIES[quantity])
        axis.grid(color="#e4e4e4")
        axis.legend(frameon=False)
    figure.savefig(path, dpi=100, metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nodes", type=int, default=NODES[-1], help="the largest mesh, about (default: 100000)")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--image", type=pathlib.Path, default=ROOT / "docs" / "images" / "scaling.png")
    parser.add_argument("--one", nargs=2, metavar=("ELEMENT", "NODES"), help="measures one mesh and prints JSON")
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measure(options.one[0], int(options.one[1]), options.threads)))
        return
    print(f"{sinew._core.compiler}, {sinew._core.instruction_set}; {options.threads} threads; load average "
          + ", ".join(f"{x:.1f}" for x in os.getloadavg()) + "\n")
    results = {}
    for element in COLOURS:
        results[element] = []
        for nodes in (n for n in NODES if n <= options.nodes):
            done = subprocess.run([sys.executable, __file__, "--threads", str(options.threads), "--one", element, str(nodes)],
                                  capture_output=True, text=True, check=True)
            results[element].append(json.loads(done.stdout))
            print(f"done: {element}, {nodes} nodes", file=sys.stderr)
    report(results)
    draw(results, options.image)
    print("\nload average at the end " + ", ".join(f"{x:.1f}" for x in os.getloadavg()))


if __name__ == "__main__":
    main()
