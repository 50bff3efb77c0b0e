#!/usr/bin/python3
"""Compares Sinew's numbers with references and writes docs/scorecard.md and its plots.

    validation/run.py [CASE...]         all cases by default; --list names them
    make validate                       builds first

Needs the Python package: build/release/python is used unless `sinew` can already be imported.
Exit code: 0 if every check passed, apart from known misses; 1 if one was missed or a case stopped with an
error; 2 for wrong arguments. The scorecard is written in any case, unless only some cases ran.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import importlib
import importlib.util
import multiprocessing
import os
import pathlib
import sys
from typing import NoReturn
import tempfile
import time
import traceback

HERE = pathlib.Path(__file__).resolve().parent
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(variable, "1")  # cases run in parallel
sys.path.insert(0, str(HERE))
if importlib.util.find_spec("sinew") is None:
    sys.path.append(str(HERE.parent / "build" / "release" / "python"))

from suite import kept, scorecard  # noqa: E402
from suite.case import KNOWN, MISSED, Case, Result  # noqa: E402


def case_names() -> list[str]:
    """Names of all cases, in the order of the scorecard (alphabetical)."""
    return sorted(path.stem for path in (HERE / "cases").glob("*.py") if path.stem != "__init__")


def run_case(name: str, images: pathlib.Path) -> Result:
    """Runs one case. An exception is stored in the result."""
    result = Result(name, title=name)
    start = time.monotonic()
    try:
        module = importlib.import_module(f"cases.{name}")
        result.title, result.setup, result.sources = module.TITLE, module.SETUP, module.SOURCES
        with tempfile.TemporaryDirectory(prefix="sinew-validate-") as scratch:
            case = Case(name, images, pathlib.Path(scratch), module.SOURCES)
            result.checks, result.figures = case.checks, case.figures
            module.run(case)
    except Exception:
        result.failure = traceback.format_exc()
    result.seconds = time.monotonic() - start
    return result


def run_all(names: list[str], images: pathlib.Path, jobs: int, resume: bool, every_check: bool) -> list[Result]:
    """Runs cases in parallel, the longest first, and reports each when it ends. With `resume`, skips finished cases."""
    cost = {name: getattr(importlib.import_module(f"cases.{name}"), "COST", 1) for name in names}
    ended = {name: kept.find(name, images) for name in names} if resume else {}
    results = {name: result for name, result in ended.items() if result is not None}
    if resume:
        print(f"{len(results)} of {len(names)} cases had finished before", flush=True)
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(jobs, mp_context=context) as pool:
        pending = {pool.submit(run_case, name, images): name
                   for name in sorted(set(names) - set(results), key=lambda n: (-cost[n], n))}
        for done in concurrent.futures.as_completed(pending):
            result = done.result()
            results[result.name] = result
            kept.keep(result)
            tell(result, len(results), len(names), every_check)
    return [results[name] for name in names]


def tell(result: Result, done: int, count: int, every_check: bool) -> None:
    """Prints a line for a finished case, and its misses or all of its checks."""
    state = "stopped with an error" if result.failure else scorecard.totals([result])
    print(f"[{done}/{count}] {result.name} ({result.seconds:.1f} s): {state}", flush=True)
    for check in result.checks:
        if every_check or check.verdict in (MISSED, KNOWN):
            against = f", error {check.error}, tolerance {check.tolerance}" if check.tolerance else ""
            print(f"    {check.verdict.replace('*', '')}: {check.quantity}: {check.ours}, reference {check.reference}"
                  f"{against}", flush=True)
    if result.failure:
        print("    " + result.failure.strip().replace("\n", "\n    "), flush=True)


def wrong(kind: str, place: str, message: str, remedy: str) -> NoReturn:
    """Ends with an error for invalid input, in the format of the program."""
    print(f"sinew: error: {place}: {message}; {remedy} [{kind}]", file=sys.stderr)
    sys.exit(2)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="CASE", help="cases to run (default: all)")
    parser.add_argument("--list", action="store_true", help="list the cases and exit")
    parser.add_argument("--fast", action="store_true", help="run only the cases that take seconds")
    parser.add_argument("--resume", action="store_true",
                        help="continue an interrupted run: skip cases already finished with this build")
    parser.add_argument("--out", type=pathlib.Path, default=HERE.parent / "docs",
                        help="folder for scorecard.md and images/validation (default: docs)")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)),
                        help="cases to run in parallel (default: one per core)")
    chosen = parser.parse_args()
    unknown = sorted(set(chosen.cases) - set(case_names()))
    if unknown:
        wrong("unknown-name", "CASE", f"there is no case {', '.join(unknown)}",
              f"the cases are {', '.join(case_names())}")
    if chosen.jobs < 1:
        wrong("out-of-range", "--jobs", f"--jobs is {chosen.jobs}", "give 1 or more")
    return chosen


def main() -> int:
    options = arguments()
    names = [name for name in case_names() if not options.cases or name in options.cases]
    try:
        modules = {name: importlib.import_module(f"cases.{name}") for name in names}
    except ImportError as error:
        print(f"validation: {error}; build the Python package first: make build", file=sys.stderr)
        return 1
    if options.fast:
        names = [name for name in names if getattr(modules[name], "COST", 1) <= 2]
    if options.list:
        for name in names:
            print(f"{name:28} {modules[name].TITLE}")
        return 0
    images = options.out / "images" / "validation"
    complete = names == case_names()
    results = run_all(names, images, min(options.jobs, len(names)), options.resume, not complete)
    print(scorecard.totals(results))
    if complete:
        scorecard.write(results, options.out / "scorecard.md", images)
        print(f"wrote {options.out / 'scorecard.md'}")
    else:
        print(f"not all cases ran: scorecard.md is unchanged; the plots are in {images}")
    return 1 if any(result.failure or result.count(MISSED) for result in results) else 0


if __name__ == "__main__":
    sys.exit(main())
