"""Thousands of contact points: processor time of the steps of the published multigait robot on its sole of 2592 nodes, one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/sole.py ../shared/data [--steps 3] [--spacings 10 5 4 3] [--zones 10 20]

Takes the first steps of examples/crawl/multigait.py without initial contact forces: 15787 nodes, steps of 20 ms, friction 0.7. The
candidates for contact are nodes of the sole at the given spacings, or all of its nodes in zones of the given sizes. Each row of the
table is a step.
"""

import argparse
import pathlib
import sys
import tempfile
import time
import warnings

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples" / "crawl"))

import multigait  # noqa: E402
import sinew  # noqa: E402

FRICTION = 0.7


def measure(data, points, steps, zones=None):
    with tempfile.TemporaryDirectory() as folder:
        sim = sinew.load(multigait.scene(data, pathlib.Path(folder), FRICTION, zones), threads=1)
    for name, place in multigait.CHAMBERS.items():
        sim.actuator(name).pressure = multigait.pressure(place, 1, period=multigait.PERIOD, full=multigait.PRESSURE)
    for step in range(steps):
        start = time.process_time()
        sim.step()
        taken = time.process_time() - start
        report = sim.report
        floor = sim.contacts["floor"]
        print(f"| {points} | {len(floor.gaps)} | {int((floor.normal_forces > 0.0).sum())} | {step + 1} | {taken:.2f} | "
              f"{100.0 * report.times['law'] / report.times['total']:.0f} % | {report.iterations} | {report.substeps} | "
              f"{report.contact_aggregation:.1e} | {-1e6 * min(floor.gaps.min(), 0.0):.1f} |", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=3)
    parser.add_argument("--spacings", type=float, nargs="*", default=[10.0, 5.0, 4.0, 3.0], help="mm, between points")
    parser.add_argument("--zones", type=float, nargs="*", default=[10.0, 20.0], help="mm, of zones of all nodes")
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)
    print("| contact points | number | with a force | step | s | of it the law | iterations | substeps | aggregation | "
          "overlap, um |\n" + "|---" * 10 + "|")  # fmt: skip
    for spacing in given.spacings:
        multigait.SPACING = spacing
        measure(given.data / "multigait", f"{spacing:g} mm apart", given.steps)
    for size in given.zones:
        measure(given.data / "multigait", f"all nodes, `aggregate: {size:g} mm`", given.steps, size)


if __name__ == "__main__":
    main()
