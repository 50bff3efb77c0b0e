"""`sinew sweep`: python3 -m sinew.sweep SCENE --vary KEY=FROM:TO:N --measure NAME --out DIR."""

from __future__ import annotations

import argparse
import contextlib
import signal
import sys
import time
import warnings

from .. import _core
from ..errors import Error, RunError
from .progress import clock

_STOPPED, _FAILED, _WRONG_INPUT = 128, 1, 2


def _options(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="sinew sweep", allow_abbrev=False)
    parser.add_argument("scene", metavar="SCENE")
    for name in ("vary", "measure", "set"):
        parser.add_argument(f"--{name}", action="append", default=[])
    for name in ("out", "sample", "scheduler", "duration", "timeout"):
        parser.add_argument(f"--{name}")
    for name in ("workers", "seed"):
        parser.add_argument(f"--{name}", type=int)
    for name in ("static", "resume", "quiet"):
        parser.add_argument(f"--{name}", action="store_true")
    return parser.parse_args(words)


def _seconds(option: str, text: str | None) -> float | None:
    if text is None:
        return None
    try:
        value, dimension = _core._quantity(text)
    except Error as error:
        raise Error(error.kind, option, error.message, error.remedy) from None
    if dimension not in ((0, 0, 0, 0), (0, 0, 1, 0)):
        raise Error("wrong-dimension", option, f"'{text}' is no time", "write a time such as 5s")
    return value


def _pairs(vary: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for text in vary:
        key, separator, values = text.partition("=")
        if not separator or not key or not values:
            raise Error("bad-argument", "--vary", f"'{text}' is no KEY=VALUES", "write --vary bodies.trunk.mass=30g:60g:4")
        if key in found:
            raise Error("duplicate-key", "--vary", f"'{key}' is varied twice", "give each key once, several values as A,B,C")
        found[key] = values
    return found


def _sweep(options: argparse.Namespace) -> int:
    from . import run

    begin = time.monotonic()
    table = run(options.scene, vary=_pairs(options.vary), measure=options.measure, out=options.out, sample=options.sample,
                seed=1 if options.seed is None else options.seed, workers=options.workers, scheduler=options.scheduler,
                duration=_seconds("--duration", options.duration), static=options.static, set=options.set,
                timeout=_seconds("--timeout", options.timeout), resume=options.resume, progress=False if options.quiet else None)
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
    return _FAILED if len(table) and len(failed) == len(table) else 0


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


def _interrupted(number: int, _frame: object) -> None:
    raise KeyboardInterrupt(number)


def main(words: list[str]) -> int:
    """Of the command line; the exit code: 0 done, 1 every sample failed or the sweep broke off, 2 wrong input, 130 after
    Ctrl-C, 143 after SIGTERM."""
    options = _options(words)
    warnings.showwarning = lambda message, *_, **__: print(f"sinew: warning: {message}", file=sys.stderr)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupted)
    try:
        return _sweep(options)
    except Error as error:
        print(f"sinew: error: {error}", file=sys.stderr)
        return _FAILED if isinstance(error, RunError) else _WRONG_INPUT
    except KeyboardInterrupt as stop:
        print("sinew: stopped; the samples that were done are in the table, and --resume does the others", file=sys.stderr)
        return _STOPPED + (stop.args[0] if stop.args else signal.SIGINT)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
