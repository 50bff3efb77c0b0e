#!/usr/bin/python3
"""Sums up where the time of a build went, from ninja's log of it.

    scripts/build_times.py [BUILD]               build/release unless named
    scripts/build_times.py --slowest 20 BUILD    also names the slowest commands

For every output, only its last build counts. Times are wall times. They equal processor times if the
machine was otherwise idle and had as many cores as ninja ran commands at once.
"""

import argparse
import pathlib
import re
import sys

PARTS = [  # the first pattern that matches an output counts
    (r"(^|/)cmake_pch\.hxx\.gch$|sinew_precompiled", "precompiled headers"),
    (r"^src/sinew/CMakeFiles/sinew_([a-z]+)\.dir/.*\.o$", r"src/\1"),
    (r"^tests/.*\.o$", "tests"),
    (r"^apps/.*\.o$", "apps"),
    (r"^python/.*\.o$", "python"),
    (r"^viewer/.*\.o$", "viewer"),
    (r"^benchmarks/.*\.o$", "benchmarks"),
    (r"\.gz$|node_modules", "page"),
    (r"", "links and the rest"),
]


def commands(log):
    """(seconds, outputs) of the last run of each command."""
    last = {}
    for line in log.read_text().splitlines()[1:]:
        start, end, _, output, command = line.split("\t")
        last[output] = (int(start), int(end), command)
    shared = {}  # a command with several outputs has a line for each of them
    for output, key in last.items():
        shared.setdefault(key, []).append(output)
    return [((end - start) / 1e3, outputs) for (start, end, _), outputs in shared.items()]


def part_of(output):
    """The part of the project that an output belongs to."""
    for pattern, name in PARTS:
        found = re.search(pattern, output)
        if found:
            return found.expand(name)
    return "links and the rest"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=pathlib.Path("build/release"))
    parser.add_argument("--slowest", type=int, default=0, metavar="N", help="name the N slowest commands")
    arguments = parser.parse_args()
    log = arguments.build / ".ninja_log"
    if not log.exists():
        sys.exit(f"build_times: {log} does not exist; build first")
    found = commands(log)
    parts = {}
    for seconds, outputs in found:
        parts.setdefault(part_of(outputs[0]), []).append(seconds)
    print(f"{'part':<22}{'s':>8}{'commands':>10}{'slowest':>9}")
    for name, times in sorted(parts.items(), key=lambda item: -sum(item[1])):
        print(f"{name:<22}{sum(times):>8.0f}{len(times):>10}{max(times):>9.1f}")
    print(f"{'all':<22}{sum(seconds for seconds, _ in found):>8.0f}{len(found):>10}")
    for seconds, outputs in sorted(found, reverse=True)[: arguments.slowest]:
        print(f"{seconds:8.1f}  {outputs[0]}")


if __name__ == "__main__":
    main()
