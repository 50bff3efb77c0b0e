#!/usr/bin/python3
"""Efficiency of sweeps: time of all samples in a plain loop in one process, divided by processes x wall time.

    /usr/bin/python3 benchmarks/sweep.py [--workers N] [--seconds S]

Samples of 1 ms and 50 ms of processor time without a scene (sleeping would hide contention), then runs of the trunk.
The start of the cluster is measured separately. Prints a table. Its last columns are a control: the plain loop in as many
processes at once, each with an equal share of the samples, without a scheduler. Its loss relative to 100 % is due to the machine.
"""

import argparse
import multiprocessing
import os
import pathlib
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "build" / "release" / "python"))

import sinew  # noqa: E402
import sinew.sweep  # noqa: E402
from sinew.sweep import samples, worker  # noqa: E402


def busy(seconds):
    """Computes for about this time on an idle core; the work depends on the argument only."""
    value = 0
    for k in range(int(seconds * 2e7)):
        value += k & 3
    return float(value)


busy.rate = 2e7  # iterations per second, measured in main()


def work(sample):
    return {"y": busy(sample["cost"])}


def plain(vary, sample, scene, options, share=(0, 1), ready=None):
    """Seconds that the samples take in a loop in this process; with share=(k, n), samples k, k + n, ... only."""
    design = samples.design(vary, sample)
    if scene is None:
        job = worker.Job(scene="", axes=tuple(design.axes), function=work)
    else:
        sim = sinew.load(scene)
        job = worker.Job(scene=sim.to_yaml(), axes=tuple(design.axes), measures=("tip.position",),
                         shapes=worker.check_measures(sim, ["tip.position"], False), **options)
    runner = worker.Runner(job)
    if ready is not None:
        ready.wait()
    begin = time.perf_counter()
    for k in range(share[0], design.size, share[1]):
        runner.row(k, design.values(k))
    return time.perf_counter() - begin


def _plain_apart(taken, *words):
    taken.put(plain(*words))


def at_once(workers, *words):
    """Seconds until the last of several processes has run its share of the samples in a plain loop; all start together."""
    context = multiprocessing.get_context("spawn")
    ready, taken = context.Barrier(workers), context.Queue()
    processes = [context.Process(target=_plain_apart, args=(taken, *words, (k, workers), ready)) for k in range(workers)]
    for process in processes:
        process.start()
    seconds = max(taken.get() for _ in processes)
    for process in processes:
        process.join()
    return seconds


def measure(name, client, workers, vary, sample=None, scene=None, **options):
    alone = plain(vary, sample, scene, options)
    control = at_once(workers, vary, sample, scene, options)
    if scene is None:
        options = {"function": work}
    else:
        options["measure"] = ["tip.position"]
    with tempfile.TemporaryDirectory() as folder:
        begin = time.perf_counter()
        table = sinew.sweep.run(scene, vary=vary, sample=sample, scheduler=client, out=folder, progress=False, **options)
        wall = time.perf_counter() - begin
    print(f"{name:<16}{len(table):>8}{1e3 * alone / len(table):>12.2f}{alone:>10.2f}{wall:>10.2f}{100 * alone / (workers * wall):>14.1f}"
          f"{control:>14.2f}{100 * alone / (workers * control):>12.1f}{100 * control / wall:>14.1f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=float, default=20.0, help="of samples for each case, about")
    options = parser.parse_args()
    import distributed

    begin = time.perf_counter()
    busy(0.1)
    busy.rate *= 0.1 / (time.perf_counter() - begin)
    begin = time.perf_counter()
    with distributed.LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address="127.0.0.1:0",
                                  silence_logs=50) as cluster:
        with distributed.Client(cluster) as client:
            client.run(__import__, "sinew.sweep")
            print(f"{options.workers} processes, started in {time.perf_counter() - begin:.2f} s; load {os.getloadavg()[0]:.2f}\n")
            print(f"{'sample':<16}{'count':>8}{'mean (ms)':>12}{'loop (s)':>10}{'wall (s)':>10}{'efficiency %':>14}"
                  f"{'control (s)':>14}{'ceiling %':>12}{'of ceiling %':>14}")
            for cost in (0.001, 0.050):
                count = max(8, int(options.seconds / cost))
                # The cost is converted to iterations with the rate of this process, which workers do not know.
                measure(f"{1e3 * cost:g} ms", client, options.workers, {"cost": (cost * busy.rate / 2e7, cost * busy.rate / 2e7 * 1.0001)},
                        f"random:{count}")
            vary = {"bodies.trunk.material.young_modulus": f"400kPa:500kPa:{int(options.seconds * 4)}"}
            measure("trunk, 50 steps", client, options.workers, vary, scene=ROOT / "examples" / "trunk" / "trunk.yaml",
                    duration=0.5)


if __name__ == "__main__":
    main()
