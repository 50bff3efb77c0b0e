#!/usr/bin/python3
"""Runs every scene and script of examples/ as written, and checks the figures that their comments and pages claim.

    validation/examples.py [EXAMPLE...]      all by default; --list names them, e.g. arm/curl.yaml
    make examples [PRESET=portable]          builds first

Each runs in an empty folder of its own, with a time limit. A line tells its time, and each figure that is not as claimed.
Nothing under examples/ may change. Exit code: 0 if all is as claimed, 1 if not, 2 for wrong arguments.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(variable, "1")  # examples run in parallel
sys.path.insert(0, str(HERE))

from suite import examples  # noqa: E402
from suite.example_table import EXAMPLES  # noqa: E402


def run_one(example: examples.Example, options: argparse.Namespace) -> tuple[str, list[str] | None]:
    """The line of an example, and what is wrong with it; None if it is skipped."""
    with tempfile.TemporaryDirectory(prefix="sinew-example-") as folder:
        ran = examples.run(example, options.build, pathlib.Path(folder), options.patience)
        if ran is None:
            return f"{example.path}: skipped, {example.needs} is missing", None
        wrong = [ran.problem] if ran.problem else []
        told = []
        for figure in example.figures if not ran.problem else ():
            value = figure.read(ran)
            text = f"{figure.quantity}: {value:.5g} {figure.unit}".rstrip()
            told.append(text)
            if not abs(value - figure.claim) <= figure.tolerance:
                wrong.append(f"{text}, but {figure.where} says {figure.claim:g} (within {figure.tolerance:g})")
        if options.output:
            told.append(ran.output)
    line = f"{example.path} ({ran.seconds:.1f} s): {'FAILED' if wrong else 'ok'}"
    return "\n    ".join([line, *(told if options.verbose else [])]), wrong


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("examples", nargs="*", metavar="EXAMPLE", help="paths below examples/ (default: all)")
    parser.add_argument("--list", action="store_true", help="list the examples and exit")
    parser.add_argument("--build", type=pathlib.Path, default=HERE.parent / "build" / "release",
                        help="build tree (default: build/release)")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="examples to run at once")
    parser.add_argument("--patience", type=float, default=1.0, help="factor on the time limits")
    parser.add_argument("--verbose", action="store_true", help="print all figures")
    parser.add_argument("--output", action="store_true", help="print what the examples print (with --verbose)")
    options = parser.parse_args()
    unknown = sorted(set(options.examples) - {one.path for one in EXAMPLES})
    if unknown:
        parser.error(f"EXAMPLE: there is no example {', '.join(unknown)}; see --list [unknown-name]")
    if options.jobs < 1 or not options.patience > 0.0:
        parser.error("--jobs and --patience are positive [out-of-range]")
    options.build = options.build.resolve()
    if not (options.build / "bin" / "sinew").exists():
        parser.error(f"--build: {options.build} has no bin/sinew; run `make build` first [file-not-found]")
    return options


def main() -> int:
    options = arguments()
    chosen = [one for one in EXAMPLES if not options.examples or one.path in options.examples]
    if options.list:
        print("\n".join(one.path for one in chosen))
        return 0
    before = examples.source_state()
    failed, skipped = [], 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        pending = {pool.submit(run_one, one, options): one for one in sorted(chosen, key=lambda one: -one.limit)}
        for done in concurrent.futures.as_completed(pending):
            line, wrong = done.result()
            print(f"[{sum(future.done() for future in pending)}/{len(chosen)}] " + "\n    ".join([line, *(wrong or [])]), flush=True)
            skipped += wrong is None
            if wrong:
                failed.append(pending[done].path)
    changed = examples.changed_sources(before)
    if changed:
        print("files under examples/ have changed: " + ", ".join(changed))
    print(f"{len(chosen) - len(failed) - skipped} of {len(chosen)} as claimed" + (f", {skipped} skipped" if skipped else "")
          + (f"; not: {', '.join(sorted(failed))}" if failed else ""))
    return 1 if failed or changed else 0


if __name__ == "__main__":
    sys.exit(main())
