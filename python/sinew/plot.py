"""Pictures of runs and fits, by matplotlib: `python3 -m sinew.plot run DIR OUT.png`."""

from __future__ import annotations

import csv
import json
import math
import pathlib
import re
import sys

OURS, DATA, SECOND, QUIET = "#1f5fa8", "#222222", "#c8501e", "#999999"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195", "#5c5c5c")


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"axes.grid": True, "grid.color": "#e4e4e4", "axes.spines.top": False,
                         "axes.spines.right": False, "legend.frameon": False,
                         "figure.constrained_layout.use": True, "legend.fontsize": 8})
    return plt


# Shown units: what one SI unit is in them.
SHOWN = {"m": ("mm", 1e3), "Pa": ("kPa", 1e-3), "m^3": ("ml", 1e6), "J": ("mJ", 1e3), "rad": ("degrees", 180 / math.pi)}


def read_run(folder, table="run.csv") -> dict[str, list[float]]:
    """The numeric columns of a run's table, by their headings.

    Parameters
    ----------
    folder : path-like
        As `sinew run` wrote it.
    table : str
        Or "probes.csv".
    """
    with open(pathlib.Path(folder) / table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns: dict[str, list[float]] = {}
    for k, name in enumerate(rows[0]):
        try:
            columns[name] = [float(row[k]) for row in rows[1:]]
        except ValueError:
            continue  # words, such as the law's status
    return columns


def _split(heading: str) -> tuple[str, str]:
    name, _, unit = heading.partition(" [")
    return name, unit.rstrip("]")


def run(folder, out) -> pathlib.Path:
    """Draws efforts, motions, effectors, probes, errors and energies of a recorded run over time.

    Of a line that is probed its length is drawn.

    Parameters
    ----------
    folder : path-like
        As `sinew run` wrote it.
    out : path-like
        PNG file.
    """
    plt = _pyplot()
    columns = read_run(folder)
    time = columns.pop("time [s]")
    panels: dict[str, list[tuple[str, str, list[float]]]] = {}
    for heading, values in columns.items():
        name, unit = _split(heading)
        last = name.rsplit(".", 1)[-1]
        if unit == "J":
            group = "Energy"
        elif "." not in name:
            continue
        elif last == "error":
            group = "Error"
        elif last in ("x", "y", "z", "rx", "ry", "rz") or last.startswith("target_"):
            group = f"Effectors ({unit})"
        elif last in ("displacement", "volume_growth"):
            group = f"Motion ({unit})"
        else:
            group = f"Effort ({unit})"
        if group.startswith(("Effort", "Motion")):
            name = name.rsplit(".", 1)[0]
        panels.setdefault(group, []).append((name, unit, values))
    probes = read_run(folder, "probes.csv") if (pathlib.Path(folder) / "probes.csv").exists() else {}
    for heading, values in probes.items():
        name, unit = _split(heading)
        if name != "time" and not re.search(r"\.\d+\.[xyz]$", name):
            panels.setdefault(f"Probes ({unit})", []).append((name.removesuffix(".length"), unit, values))
    count = max(1, len(panels))
    figure, axes = plt.subplots(count, 1, figsize=(9, 2.3 * count + 0.3), sharex=True, squeeze=False)
    for axis, (group, series) in zip(axes[:, 0], panels.items()):
        for k, (name, unit, values) in enumerate(series):
            shown, scale = SHOWN.get(unit, (unit, 1.0))
            goal = ".target_" in name
            axis.plot(time, [scale * v for v in values], "--" if goal else "-", lw=1.0 if goal else 1.5,
                      color=QUIET if goal else COLOURS[k % len(COLOURS)],
                      label=None if goal else name.replace("_", " "))
            axis.set_ylabel(f"{group.split(' (')[0]} ({shown})" if shown else group)
        axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02))
    axes[-1, 0].set_xlabel("time (s)")
    figure.savefig(out, dpi=110)
    plt.close(figure)
    return pathlib.Path(out)


def fit(data, out) -> pathlib.Path:
    """Draws tests of rubber, fitted laws, and what is left between them.

    Parameters
    ----------
    data : path-like
        JSON of `sinew fit`.
    out : path-like
        PNG file.
    """
    plt = _pyplot()
    content = json.loads(pathlib.Path(data).read_text(encoding="utf-8"))
    tests, fits = content["tests"], content["fits"]
    figure, axes = plt.subplots(2, len(tests), figsize=(4.6 * len(tests), 5.4), squeeze=False, sharex="col",
                                gridspec_kw={"height_ratios": (3, 1)})
    for k, test in enumerate(tests):
        top, low = axes[0, k], axes[1, k]
        top.plot(test["stretch"], [1e-3 * s for s in test["stress"]], "o", ms=3.5, color=DATA, label="measured")
        for j, one in enumerate(fits):
            colour = COLOURS[j % len(COLOURS)]
            top.plot(test["stretch"], [1e-3 * s for s in one["stress"][k]], color=colour, lw=1.5, label=one["model"])
            low.plot(test["stretch"], [1e-3 * (a - b) for a, b in zip(one["stress"][k], test["stress"])],
                     color=colour, lw=1)
        top.set(title=f"{test['name']} ({test['mode']})", ylabel="nominal stress (kPa)")
        low.set(xlabel="stretch", ylabel="fit - measured (kPa)")
        top.legend()
    figure.savefig(out, dpi=110)
    plt.close(figure)
    return pathlib.Path(out)


def main(words: list[str]) -> int:
    """`run DIR OUT.png` or `fit DATA.json OUT.png`."""
    if len(words) != 3 or words[0] not in ("run", "fit"):
        print("usage: python3 -m sinew.plot run|fit SOURCE OUT.png", file=sys.stderr)
        return 2
    try:
        path = (run if words[0] == "run" else fit)(words[1], words[2])
    except ImportError as missing:
        print(f"sinew: error: plots need matplotlib: {missing}; apt-get install python3-matplotlib", file=sys.stderr)
        return 2
    print(f"drew {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
