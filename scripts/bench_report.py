#!/usr/bin/python3
"""Prints one table of the results of `sinew bench --json`: scripts/bench_report.py FILE.json...

Times are medians in microseconds; for the whole step, the 95th percentile is given as well. The ratio
divides the time of the whole step by that of Eigen's SimplicialLDLT (AMD, one thread, without symbolic
analysis) for the numeric factorisation of the same matrix, from the same run or, for runs of the
scene with other options, from the run that measured it.
"""

import json
import pathlib
import sys

STAGES = ("assembly", "rows", "factorisation", "law", "correction")


def row(figures, eigen):
    """The cells of one run."""
    stages = figures["stages"]
    total = stages["total"]
    cells = [figures["scene"], f"{figures['threads']}", figures["tangent"]]
    cells += [f"{stages[name]['median_us']:.1f}" for name in STAGES]
    cells += [f"{total['median_us']:.1f}", f"{total['p95_us']:.1f}"]
    cells += [f"{eigen:.0f}", f"{total['median_us'] / eigen:.3f}"] if eigen else ["", ""]
    error = figures.get("max_error_m")
    cells.append("" if error is None else f"{1e3 * error:.4f}")
    cells.append(f"{figures['max_relative_residual']:.1e}")
    cells.append(f"{1e-6 * figures['bytes_per_simulation']:.2f}")
    return cells


def table(runs):
    """Formats one row per run, in the given order."""
    eigen = {r["scene"]: r["eigen_simplicial_ldlt"]["median_us"] for r in runs if "eigen_simplicial_ldlt" in r}
    rows = [["scene", "threads", "tangent", "assembly", "rows", "factor+W", "law", "correction",
             "total", "p95", "Eigen", "ratio", "error mm", "residual", "MB"]]
    rows += [row(r, eigen.get(r["scene"])) for r in runs]
    widths = [max(len(r[c]) for r in rows) for c in range(len(rows[0]))]
    lines = []
    for cells in rows:
        words = [cell.ljust(w) if c == 0 else cell.rjust(w) for c, (cell, w) in enumerate(zip(cells, widths))]
        lines.append("  ".join(words).rstrip())
    lines.insert(1, "-" * len(lines[0]))
    return "\n".join(lines)


def main(paths):
    """Prints the table, and the machines on which it was measured."""
    runs = [json.loads(pathlib.Path(path).read_text()) for path in paths]
    if not runs:
        sys.exit("bench_report: no figures; run scripts/bench.sh")
    print(table(runs))
    for place in sorted({f"{r['machine']}, {r['instruction_set']}, {r['compiler']}, {r['date'][:10]}" for r in runs}):
        print(f"\n{place}; median microseconds a step", end="")
    print()


if __name__ == "__main__":
    main(sys.argv[1:])
