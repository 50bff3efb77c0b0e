"""`sinew sweep`: python3 -m sinew.sweep SCENE --vary KEY=FROM:TO:N --measure NAME --out DIR."""

from __future__ import annotations

import argparse
import contextlib
import sys
import time

from .. import command
from ..errors import Error
from .progress import clock


def _options(words: list[str]) -> argparse.Namespace:
    parser = command.parser("sweep")
    for name in ("vary", "measure", "set"):
        parser.add_argument(f"--{name}", action="append", default=[])
    for name in ("out", "sample", "scheduler", "duration", "timeout"):
        parser.add_argument(f"--{name}")
    for name in ("workers", "seed"):
        parser.add_argument(f"--{name}", type=int)
    for name in ("static", "resume", "quiet"):
        parser.add_argument(f"--{name}", action="store_true")
    return parser.parse_args(words)


def _pairs(vary: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for text in vary:
        key, separator, values = text.partition("=")
        if not separator or not key or not values:
            raise Error("bad-argument", "--vary", f"'{text}' is not KEY=VALUES", "write for example --vary bodies.trunk.mass=30g:60g:4")
        if key in found:
            raise Error("duplicate-key", "--vary", f"'{key}' is given twice", "give each key once, with its values as A,B,C")
        found[key] = values
    return found


def _sweep(options: argparse.Namespace) -> int:
    from . import run

    begin = time.monotonic()
    table = run(options.scene, vary=_pairs(options.vary), measure=options.measure, out=options.out, sample=options.sample,
                seed=1 if options.seed is None else options.seed, workers=options.workers, scheduler=options.scheduler,
                duration=command.seconds("--duration", options.duration), static=options.static, set=options.set,
                timeout=command.seconds("--timeout", options.timeout), resume=options.resume, progress=False if options.quiet else None)
    failed = table[table["status"] == "failed"]
    flagged = table[table["status"] == "flagged"]
    if not options.quiet:
        lines = {"samples": len(table), "done": (table["status"] == "done").sum(), "flagged": len(flagged), "failed": len(failed),
                 "wall time": clock(time.monotonic() - begin), "sum of samples": clock(table["seconds"].sum()),
                 "table": f"{options.out}/sweep.h5"}
        for name, value in lines.items():
            print(f"{name:<16}{value}")
        _print_indices(options, table)
    for kind, rows in (("failed", failed), ("flagged", flagged)):
        if len(rows):
            print(f"sinew: warning: {len(rows)} of {len(table)} samples {'failed' if kind == 'failed' else 'are flagged'}, the first "
                  f"is {rows.index[0]}: {rows['error'].iloc[0]}", file=sys.stderr)
    return command.FAILED if len(table) and len(failed) == len(table) else 0


def _print_indices(options: argparse.Namespace, table) -> None:
    if not str(options.sample).startswith("saltelli"):
        return
    from . import indices
    from .table import component_names

    for name, shape in table.attrs["outputs"].items():
        for column in component_names(name, shape):
            if column in table:
                with contextlib.suppress(Error):  # too few samples
                    print(f"\nSobol indices of {column}\n{indices(options.out, column).to_string(float_format='%.3f')}")


def main(words: list[str]) -> int:
    """Runs `sinew sweep`; returns the exit code, see command.exit_code(). 1 also if every sample failed."""
    options = _options(words)
    return command.exit_code(lambda: _sweep(options), "interrupted; the finished samples are in the table, continue with --resume")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
