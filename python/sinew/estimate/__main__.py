"""`sinew estimate`: python3 -m sinew.estimate SCENE --measured FILE.csv --std NAME=STD --force NAME=BODY:POINT:STD."""

from __future__ import annotations

import argparse
import pathlib
import sys

import numpy as np

from .. import command
from ..command import quantity
from ..errors import Error, RunError
from .files import read_readings, write_table
from .places import locate, patches
from .quantities import Force, Parameter
from .replay import FILTERS, filtered, has_parameters, settled, twin_of
from .static import solve
from .twin import Twin



def _options(words: list[str]) -> argparse.Namespace:
    parser = command.parser("estimate")
    for name in ("measured", "out", "walk", "method", "search"):
        parser.add_argument(f"--{name}")
    for name in ("std", "force", "parameter", "marker", "set"):
        parser.add_argument(f"--{name}", action="append", default=[])
    parser.add_argument("--quiet", action="store_true")
    return parser.parse_args(words)


def _force(option: str, text: str) -> float:
    return quantity(option, text, (1, 1, -2, 0), kind="a force", example="1N")


def _point(option: str, text: str) -> list[float]:
    words = text.split()
    unit = words.pop() if len(words) == 4 else ""
    if len(words) != 3:
        raise Error("wrong-length", option, f"'{text}' is not a point", "write three numbers and a unit, for example 0 10 150 mm")
    return [quantity(option, f"{word} {unit}", (1, 0, 0, 0), kind="a length", example="10mm") for word in words]


def _pair(option: str, text: str, parts: int) -> tuple[str, list[str]]:
    name, separator, rest = text.partition("=")
    found = [part.strip() for part in rest.split(":")]
    if not separator or not name or len(found) != parts:
        form = ":".join(["..."] * parts)
        raise Error("bad-argument", option, f"'{text}' is not of the form NAME={form}", "see `sinew estimate --help`")
    return name.strip(), found


def _unknowns(options: argparse.Namespace) -> list:
    walk = quantity("--walk", options.walk) if options.walk else 1.0
    unknowns: list = []
    for text in options.force:
        name, (body, point, std) = _pair("--force", text, 3)
        unknowns.append(Force(name, body, _point("--force", point), prior=_force("--force", std), walk=walk))
    for text in options.parameter:
        path, (start, share) = _pair("--parameter", text, 2)
        unknowns.append(Parameter(path, quantity("--parameter", start), quantity("--parameter", share)))
    if not unknowns and not options.search:
        raise Error("no-unknowns", "sinew estimate", "nothing to estimate", "give --force, --parameter or --search")
    return unknowns


def _estimate(options: argparse.Namespace) -> int:
    if options.measured is None:
        raise Error("bad-argument", "--measured", "no measurements given", "give --measured FILE.csv")
    record = read_readings(options.measured)
    stds = {name: quantity("--std", value) for name, (value,) in (_pair("--std", text, 1) for text in options.std)}
    markers = {name: (body, _point("--marker", point)) for name, (body, point) in (_pair("--marker", t, 2) for t in options.marker)}
    twin, commanded = twin_of(options.scene, record, stds, _unknowns(options), markers=markers, set=options.set)
    out = pathlib.Path(options.out or f"out/{pathlib.Path(options.scene).stem}-estimate")
    for name, count in record.missing.items():
        if name in {*twin.outputs, *[m.name for m in twin.measured]}:
            print(f"sinew: warning: {options.measured}: {name}: {count} of {len(record.time)} readings are missing; the estimate goes "
                  "on without them", file=sys.stderr)
    for begin, end in record.gaps:
        print(f"sinew: warning: {options.measured}: no readings from {begin:g} to {end:g} s", file=sys.stderr)
    if options.search:
        table = _search(options, twin, record, commanded)
    else:
        table = _over_time(options, twin, record, commanded)
    out.mkdir(parents=True, exist_ok=True)
    write_table(out / "estimate.csv", {_heading(name, twin): values for name, values in table.items()})
    if not options.quiet:
        _print(options, table, out)
    return 0


def _heading(name: str, twin: Twin) -> str:
    forces = {component for unknown in twin.unknowns if isinstance(unknown, Force) for component in unknown.components}
    return f"{name} [N]" if name.removesuffix(".std") in forces else name


def _over_time(options: argparse.Namespace, twin: Twin, record, commanded) -> dict[str, np.ndarray]:
    method = options.method or ("settled" if has_parameters(twin) or len(record.time) == 1 else "extended")
    if method not in ("settled", *FILTERS):
        raise Error("unknown-choice", "--method", f"there is no method '{method}'", f"use settled, {', '.join(FILTERS)}")
    if method == "settled":
        table, rows = settled(twin, record, commanded)
        found = next((row for row in reversed(rows) if row is not None), None)
        if found is None:
            raise RunError("not-converged", "sinew estimate", "no row has an estimate", "check the readings and the priors")
        seen = found.observability
    else:
        table = filtered(twin, record, commanded, kind=method)
        seen = solve(twin, _last(twin, record)).observability
    if not options.quiet:
        print("singular values " + ", ".join(f"{value:.3g}" for value in seen.singular_values))
    for text in seen.unobservable:
        print(f"sinew: warning: not observable: {text}; its prior decides", file=sys.stderr)
    return table


def _last(twin: Twin, record) -> dict[str, float]:
    known = {*twin.outputs, *[m.name for m in twin.measured]}
    rows = [{n: v for n, v in record.at(k).items() if n in known} for k in range(len(record.time))]
    return next((row for row in reversed(rows) if any(name in twin.outputs for name in row)), {})


def _search(options: argparse.Namespace, twin: Twin, record, commanded) -> dict[str, np.ndarray]:
    body, _, rest = options.search.partition(":")
    count, _, std = rest.partition(":")
    if not count.isdigit() or not std:
        raise Error("bad-argument", "--search", f"'{options.search}' is not of the form BODY:PATCHES:STD", "write trunk:48:1N")
    areas = patches(twin.sim, body, int(count))
    prior = _force("--search", std)
    names = ("x", "y", "z")
    table: dict[str, list] = {"time [s]": [], "patch": [], "probability": [], **{f"place.{a} [m]": [] for a in names},
                              **{f"force.{a} [N]": [] for a in names}, "status": []}
    known = {*twin.outputs, *[m.name for m in twin.measured]}
    for k, time in enumerate(record.time):
        for owner, quantity in commanded.items():
            value = record.at(k).get(f"{owner}.{quantity}")
            if value is not None:
                setattr(twin.sim.actuator(owner), quantity, value)
        found = locate(twin, {n: v for n, v in record.at(k).items() if n in known}, areas, prior=prior)
        table["time [s]"].append(time)
        table["patch"].append(found.patch)
        table["probability"].append(found.probability[found.patch])
        for axis, name in enumerate(names):
            table[f"place.{name} [m]"].append(found.place[axis])
            table[f"force.{name} [N]"].append(found.force[axis])
        table["status"].append(found.status)
    return {name: np.array(values) for name, values in table.items()}


def _print(options: argparse.Namespace, table, out: pathlib.Path) -> None:
    print(f"{'rows':<28}{len(table['time [s]'])}")
    for name, values in table.items():
        if name not in ("time [s]", "status", "lost") and not name.endswith(".std"):
            deviation = f" +- {table[f'{name}.std'][-1]:.2g}" if f"{name}.std" in table else ""
            print(f"{name:<28}{values[-1]:.5g}{deviation}")
    if "status" in table:
        words, counts = np.unique(table["status"], return_counts=True)
        print(f"{'status':<28}{', '.join(f'{count} {word}' for word, count in zip(words, counts))}")
    print(f"{'table':<28}{out / 'estimate.csv'}")


def main(words: list[str]) -> int:
    """Runs `sinew estimate`; returns the exit code, see command.exit_code()."""
    options = _options(words)
    return command.exit_code(lambda: _estimate(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
