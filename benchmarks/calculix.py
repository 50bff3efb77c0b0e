#!/usr/bin/python3
"""Speed against CalculiX on the same meshes in the same run: prints the tables of docs/performance.md.

    /usr/bin/python3 benchmarks/calculix.py [--small] [--threads N]

A cantilever of neo-Hookean rubber under its own weight: equilibrium, and the first steps after it is released, with
hexahedra and quadratic tetrahedra of several sizes. Total times are those of the whole process for CalculiX, from deck
to results, and of loading and solving for Sinew; there are also times per Newton iteration or step. They are processor
times on one thread (the wall time of an idle machine) and wall times on several. In both codes, statics take one load
increment and dynamics equal steps. The discretisations differ where the elements do (mean dilatation in Sinew), so the
tables contain the deflections. CalculiX is Debian's ccx with SPOOLES. The load average shows the other load of the
machine.
"""

import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "build" / "release" / "python"))
sys.path.insert(0, str(ROOT / "validation"))

import numpy as np  # noqa: E402
import sinew  # noqa: E402
from reference import calculix  # noqa: E402

LAW = {"model": "neo-hookean", "shear_modulus": 100e3, "bulk_modulus": 300e3}
DENSITY, GRAVITY, STEP, STEPS = 1000.0, 9.81, 2e-3, 20
SIZES = {"hex8": (5.0, 10 / 3, 2.5), "tet10": (10.0, 20 / 3, 5.0)}  # mm
SMALL = {"hex8": (10.0, 5.0), "tet10": (10.0,)}


def scene(element, size, threads):
    return {"sinew": 1, "gravity": [0, 0, -GRAVITY], "time_step": STEP,
            "solver": {"method": "newton", "threads": threads, "ordering": "metis", "tolerance": 1e-6},
            "integrator": {"type": "generalized-alpha", "spectral_radius": 1.0},
            "bodies": {"beam": {"type": "fem", "element": element, "density": DENSITY, "mass_matrix": "consistent",
                                "material": LAW, "fixed": [{"set": "x_min"}],
                                "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02,
                                         "element_size": 1e-3 * size}}}}


def clock(threads):
    """Processor time of this process and of its finished children, s; wall time for several threads."""
    if threads > 1:
        return time.perf_counter()
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def timed(action, threads):
    start = clock(threads)
    result = action()
    return result, clock(threads) - start


def iterations_of(folder):
    """Newton iterations of all increments, from the .sta file."""
    rows = [line.split() for line in (folder / "body.sta").read_text().splitlines()]
    return sum(int(row[3]) for row in rows if len(row) == 7 and row[0].isdigit())


def theirs(folder, body, cells, lines, threads):
    """CalculiX: mean last displacement of the end, seconds of the process, and Newton iterations."""
    folder.mkdir()
    deck = [*calculix.body_cards(np.array(body.rest_positions), cells, np.array(body.fixed), LAW, DENSITY),
            "*NSET, NSET=END", *[str(n + 1) for n in body.node_sets["x_max"]],
            "*AMPLITUDE, NAME=AT_ONCE", "0., 1., 1000., 1.", *lines, "*CONTROLS, PARAMETERS=FIELD", "1e-6, 1e-5",
            "*DLOAD, AMPLITUDE=AT_ONCE", f"BODY, GRAV, {GRAVITY}, 0., 0., -1.",
            "*NODE PRINT, NSET=END, FREQUENCY=1", "U", "*END STEP"]
    prints, seconds = timed(lambda: calculix.solve(folder, deck, threads), threads)
    return prints[-1][1][:, 2].mean(), seconds, iterations_of(folder)


def compare(element, size, threads, folder):
    """One row of each table."""
    sim, loading = timed(lambda: sinew.load(scene(element, size, threads)), threads)
    body = sim.body("beam")
    cells = body.hexahedra if element == "hex8" else body.quadratic_tetrahedra
    end = body.node_sets["x_max"]
    rest = np.array(body.rest_positions)

    def deflection():
        return (np.array(body.positions)[end, 2] - rest[end, 2]).mean()

    report, seconds = timed(sim.solve_static, threads)
    label = f"{element} | {len(rest)} | {threads}"
    deflected, process, count = theirs(folder / "static", body, cells, ["*STEP, NLGEOM, INC=100", "*STATIC", "1., 1."], threads)
    static = (f"| {label} | {1e3 * deflection():.2f} | {1e3 * deflected:.2f} | {loading + seconds:.3f} | {process:.2f} | "
              f"{report.iterations} | {count} | {1e3 * seconds / report.iterations:.1f} | {1e3 * process / count:.1f} | "
              f"{process / count / (seconds / report.iterations):.0f} |")
    sim.reset()
    iterations = 0
    start = clock(threads)
    for _ in range(STEPS):
        sim.step()
        iterations += sim.report.iterations
    seconds = clock(threads) - start
    lines = ["*STEP, NLGEOM, INC=100000", "*DYNAMIC, DIRECT, ALPHA=0.", f"{STEP}, {STEP * STEPS}"]
    deflected, process, count = theirs(folder / "dynamic", body, cells, lines, threads)
    dynamic = (f"| {label} | {1e3 * deflection():.2f} | {1e3 * deflected:.2f} | {iterations} | {count} | "
               f"{1e3 * seconds / STEPS:.1f} | {1e3 * process / STEPS:.1f} | {process / seconds:.0f} |")
    return static, dynamic


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--small", action="store_true", help="coarse meshes only, to see that it runs")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)), help="beside one (default: all)")
    options = parser.parse_args()
    version = re.search(r"Version (\S+)", subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout)
    print(f"{sinew._core.compiler}, {sinew._core.instruction_set}; ccx {version.group(1)}; load average "
          + ", ".join(f"{x:.1f}" for x in os.getloadavg()))
    static, dynamic = [], []
    for threads in sorted({1, options.threads}):
        for element, sizes in (SMALL if options.small else SIZES).items():
            for size in sizes:
                with tempfile.TemporaryDirectory() as folder:
                    rows = compare(element, size, threads, pathlib.Path(folder))
                static.append(rows[0])
                dynamic.append(rows[1])
                print(f"done: {element}, {size:.3g} mm, {threads} threads", file=sys.stderr)
    print("\n**Equilibrium under the weight**\n\n| element | nodes | threads | deflection, mm: Sinew | CalculiX "
          "| total, s: Sinew | CalculiX | iterations: Sinew | CalculiX | per iteration, ms: Sinew | CalculiX | ratio |\n" + "|---" * 12 + "|")
    print("\n".join(static))
    print(f"\n**{STEPS} steps of {1e3 * STEP:g} ms after the release**\n\n| element | nodes | threads | deflection, mm: Sinew "
          "| CalculiX | iterations: Sinew | CalculiX | per step, ms: Sinew | CalculiX | ratio |\n" + "|---" * 10 + "|")
    print("\n".join(dynamic))
    print("\nload average at the end " + ", ".join(f"{x:.1f}" for x in os.getloadavg()))


if __name__ == "__main__":
    main()
