"""Plots of runs, sweeps and fits with matplotlib: `python3 -m sinew.plot run DIR OUT.png`."""

from __future__ import annotations

import csv
import errno
import json
import math
import pathlib
import re
import sys
import warnings

if __package__:
    from .plot_style import COLOURS, DASHES, DATA, LEGEND_ROWS, OURS, QUIET, SECOND, SHOWN, pyplot, save
else:  # the program runs this file by its path: plots do not need the compiled package
    from plot_style import COLOURS, DASHES, DATA, LEGEND_ROWS, OURS, QUIET, SECOND, SHOWN, pyplot, save


def read_run(folder, table="run.csv") -> dict[str, list[float]]:
    """Reads the numeric columns of a recorded run, by heading.

    Warns if a run.csv of an older version lacks commands.

    Parameters
    ----------
    folder : path-like
        Output folder of `sinew run`.
    table : str
        "run.csv", "probes.csv" or "sensors.csv".
    """
    with open(pathlib.Path(folder) / table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns: dict[str, list[float]] = {}
    for k, name in enumerate(rows[0]):
        try:
            columns[name] = [float(row[k]) for row in rows[1:]]
        except ValueError:
            continue  # text, such as the status of a step
    # Versions that record commands also record the number of substeps; the check works for passive robots, too.
    if table == "run.csv" and "substeps" not in columns:
        warnings.warn(f"{pathlib.Path(folder) / table}: this run was recorded without commands", stacklevel=2)
    return columns


def _split(heading: str) -> tuple[str, str]:
    name, _, unit = heading.partition(" [")
    return name, unit.rstrip("]")


def _spread(name: str, names) -> str | None:
    """The quantity among `names` that is the standard deviation of an estimate; None if it is not an estimate."""
    of, _, component = name.rpartition(".")
    return next((one for one in (f"{name}.std", f"{of}.std.{component}") if one in names), None)


def _panel(heading: str, names=()) -> tuple[str, str] | None:
    """Panel and label of a column of run.csv with the quantities `names`; None if it is not plotted."""
    name, unit = _split(heading)
    of, _, last = name.rpartition(".")
    if last == "std" or of.endswith(".std"):
        return None
    if _spread(name, names) is not None:
        return f"Estimates ({unit})", name
    if unit == "J":
        return "Energy", name
    if not of:
        return None
    if last == "error":
        return "Error", name
    if last in ("x", "y", "z", "rx", "ry", "rz") or last.startswith("target_"):
        return f"Effectors ({unit})", name
    if last in ("force_x", "force_y", "force_z", "normal_force", "friction_force"):
        return "Contact force (N)", f"{of} {last.removesuffix('_force')}"
    if last in ("sticking", "slipping"):
        return "Contact points", f"{of} {last}"
    if last in ("gap", "gap_above"):  # a gap that was not measured is above the dashed line
        return "Contact gap (m)", of + last.removeprefix("gap").replace("_", " ")
    done = last.removesuffix("_command")
    told = " command" if done != last else ""
    if done in ("displacement", "volume_growth", "angle"):
        return f"Motion ({unit})", of + told
    if done in ("tension", "force", "pressure", "torque"):
        return f"Effort ({unit})", of + told
    return f"Input ({unit})", of + told


def _owner(name: str) -> str:
    return name.removesuffix(" command").removesuffix(" true").removesuffix(" above")


def _style(line: int) -> tuple[int, str]:
    """Index of the dash pattern and colour of a line: after the last colour, the colours repeat."""
    return line // len(COLOURS), COLOURS[line % len(COLOURS)]


def _sensor(heading: str) -> tuple[str, str] | None:
    """Panel and label of a column of sensors.csv; None if it is not plotted."""
    name, unit = _split(heading)
    of, _, last = name.rpartition(".")
    quantity, _, component = last.partition("_")
    if quantity not in ("measured", "true"):
        return None
    return f"Sensors ({unit})" if unit else "Sensors", f"{of} {component}".strip() + (" true" if quantity == "true" else "")


def run(folder, out) -> pathlib.Path:
    """Plots efforts, motions, effectors, contacts, probes, sensors, estimates, errors and energies of a recorded run over time.

    Thin dashed lines show the commands of actuators and the true values of sensors, in the same colour, and the
    targets of effectors, in grey. A line probe is shown by its length. Bands about estimates are one standard deviation wide
    to each side.

    Parameters
    ----------
    folder : path-like
        Output folder of `sinew run`.
    out : path-like
        PNG file.
    """
    plt = pyplot()
    columns = read_run(folder)
    time = columns.pop("time [s]")
    numbers = {_split(heading)[0]: values for heading, values in columns.items()}
    panels: dict[str, list[tuple[str, str, list[float]]]] = {}
    for heading, values in columns.items():
        optional = _split(heading)[0].endswith(("_command", ".gap_above"))
        if (not optional or any(map(math.isfinite, values))) and (panel := _panel(heading, numbers)) is not None:
            panels.setdefault(panel[0], []).append((panel[1], _split(heading)[1], values))
    probes = read_run(folder, "probes.csv") if (pathlib.Path(folder) / "probes.csv").exists() else {}
    for heading, values in probes.items():
        name, unit = _split(heading)
        if name != "time" and not re.search(r"\.\d+\.[xyz]$", name):
            panels.setdefault(f"Probes ({unit})", []).append((name.removesuffix(".length"), unit, values))
    sensors = read_run(folder, "sensors.csv") if (pathlib.Path(folder) / "sensors.csv").exists() else {}
    for heading, values in sensors.items():
        if (panel := _sensor(heading)) is not None:
            panels.setdefault(panel[0], []).append((panel[1], _split(heading)[1], values))
    count = max(1, len(panels))
    figure, axes = plt.subplots(count, 1, figsize=(9, 2.3 * count + 0.3), sharex=True, squeeze=False)
    for axis, (group, series) in zip(axes[:, 0], panels.items()):
        names = [name for name, _, _ in series]
        owners = list(dict.fromkeys(_owner(name) for name in names if ".target_" not in name))
        for name, unit, values in series:
            shown, scale = SHOWN.get(unit, (unit, 1.0))
            owner = _owner(name)
            target, asked = ".target_" in name, ".target_" in name or name != owner
            lap, colour = (0, QUIET) if target else _style(owners.index(owner))
            axis.plot(time, [scale * v for v in values], "--" if asked else DASHES[lap % len(DASHES)], lw=1.0 if asked else 1.5,
                      color=colour,
                      label=None if target or (asked and owner in names) else name.replace("_", " "))
            if (spread := _spread(name, numbers)) is not None:
                axis.fill_between(time, *([scale * (v + side * s) for v, s in zip(values, numbers[spread])] for side in (-1, 1)),
                                  color=colour, alpha=0.15, lw=0)
            axis.set_ylabel(f"{group.split(' (')[0]} ({shown})" if shown else group)
        labels = axis.get_legend_handles_labels()[1]
        axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02), ncol=1 + (len(labels) - 1) // LEGEND_ROWS)
    axes[-1, 0].set_xlabel("time (s)")
    save(figure, out)
    plt.close(figure)
    return pathlib.Path(out)


def fit(data, out) -> pathlib.Path:
    """Plots material tests, fitted models and residuals.

    Parameters
    ----------
    data : path-like
        JSON of `sinew fit`.
    out : path-like
        PNG file.
    """
    plt = pyplot()
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
    save(figure, out)
    plt.close(figure)
    return pathlib.Path(out)


def reach(data, out) -> pathlib.Path:
    """Plots the static workspace of an arm's tip, the goals, and the equilibrium nearest to each goal.

    Parameters
    ----------
    data : path-like
        JSON of `sinew reach`.
    out : path-like
        PNG file.
    """
    plt = pyplot()
    content = json.loads(pathlib.Path(data).read_text(encoding="utf-8"))
    goals = content["goals"]
    points = content["tip_m"] + [goal["goal_m"] for goal in goals]
    # Plot x or y against z, whichever has the larger spread.
    spread = [max((p[k] for p in points), default=0) - min((p[k] for p in points), default=0) for k in (0, 1)]
    aside = int(spread[1] > spread[0])
    figure, axis = plt.subplots(figsize=(6.4, 5))
    axis.plot([100 * p[aside] for p in content["tip_m"]], [100 * p[2] for p in content["tip_m"]], ".", ms=2,
              color=QUIET, label="can be held at rest")
    for k, goal in enumerate(goals):
        colour, at = COLOURS[k % len(COLOURS)], goal["goal_m"]
        label = " ".join(f"{100 * x:g}" for x in at) + f" cm: {goal.get('proof', 'not proven')}"
        axis.plot(100 * at[aside], 100 * at[2], "o", color=colour, label=label)
        if goal["found"]:
            axis.plot([100 * at[aside], 100 * goal["tip_m"][aside]], [100 * at[2], 100 * goal["tip_m"][2]], lw=1,
                      color=colour)
    axis.set(xlabel=f"{'xy'[aside]} (cm)", ylabel="z (cm)", aspect="equal")
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02))
    save(figure, out)
    plt.close(figure)
    return pathlib.Path(out)


def plan(data, out) -> pathlib.Path:
    """Plots the torques of a plan, the path of the tip with the goal, and distance and speed of the tip over time.

    Parameters
    ----------
    data : path-like
        JSON of `sinew plan`.
    out : path-like
        PNG file.
    """
    plt = pyplot()
    content = json.loads(pathlib.Path(data).read_text(encoding="utf-8"))
    goal, run = content["goal_m"], content["replay"]
    time, tip = run["times_s"], run["tip_m"]
    figure, (torques, path, end) = plt.subplots(1, 3, figsize=(13, 4))
    for k, name in enumerate(content["actuators"]):
        torques.plot(time, [1e3 * row[k] for row in run["torque_N_m"]], color=COLOURS[k % len(COLOURS)], label=name)
    torques.set(xlabel="time (s)", ylabel="torque (mN m)")
    torques.legend()
    spread = [max(p[k] for p in tip) - min(p[k] for p in tip) for k in (0, 1)]
    aside = int(spread[1] > spread[0])
    path.plot([100 * p[aside] for p in tip], [100 * p[2] for p in tip], color=OURS, label="tip")
    path.plot(100 * goal[aside], 100 * goal[2], "o", color=SECOND, label="goal")
    path.set(xlabel=f"{'xy'[aside]} (cm)", ylabel="z (cm)", aspect="equal")
    path.legend()
    end.semilogy(time, [100 * math.dist(p, goal) for p in tip], color=OURS, label="distance from the goal (cm)")
    end.semilogy(time, [100 * math.hypot(*v) or math.nan for v in run["tip_velocity_m_s"]], color=SECOND,
                 label="speed (cm/s)")
    end.set(xlabel="time (s)", title=f"at the end {100 * content['tip_error_m']:.2g} cm, "
                                     f"{100 * content['tip_speed_m_s']:.2g} cm/s")
    end.legend()
    save(figure, out)
    plt.close(figure)
    return pathlib.Path(out)


def _draw_object(axis, shape, aside):
    """Draws an object of a brace in a view of x or y against z."""
    if "plane" in shape:
        point, normal = shape["plane"]["point_m"], shape["plane"]["normal"]
        along = normal[2], -normal[aside]
        if math.hypot(*along):
            axis.axline((100 * point[aside], 100 * point[2]), (100 * (point[aside] + along[0]), 100 * (point[2] + along[1])),
                        color=QUIET, lw=2)
        return
    first, last = shape["capsule"]["ends_m"]
    plt = pyplot()
    for share in (k / 40 for k in range(41)):
        centre = [100 * ((1 - share) * first[k] + share * last[k]) for k in (aside, 2)]
        axis.add_patch(plt.Circle(centre, 100 * shape["capsule"]["radius_m"], color=QUIET, lw=0, zorder=2))


def brace(data, out) -> pathlib.Path:
    """Plots the poses of a braced arm, the forces at the bracing point, and the tip error with and without the brace.

    Parameters
    ----------
    data : path-like
        JSON of `sinew brace`.
    out : path-like
        PNG file.
    """
    plt = pyplot()
    content = json.loads(pathlib.Path(data).read_text(encoding="utf-8"))
    goal, poses, force = content["goal_m"], content["poses"], content["force"]
    points = [point for pose in poses for point in pose["axis_m"]]
    spread = [max(p[k] for p in points) - min(p[k] for p in points) for k in (0, 1)]
    aside = int(spread[1] > spread[0])
    figure, (arm, forces, error) = plt.subplots(1, 3, figsize=(13, 4))
    for shape in content["objects"]:
        _draw_object(arm, shape, aside)
    for k, pose in enumerate(poses):
        arm.plot([100 * p[aside] for p in pose["axis_m"]], [100 * p[2] for p in pose["axis_m"]],
                 color=COLOURS[k % len(COLOURS)], label=f"{pose['label']}, {pose['time_s']:.2g} s")
    arm.plot(100 * goal[aside], 100 * goal[2], "k+", ms=10, label="goal")
    arm.set(xlabel=f"{'xy'[aside]} (cm)", ylabel="z (cm)", aspect="equal")
    arm.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02))
    forces.plot(force["times_s"], force["normal_N"], color=OURS, label="normal")
    forces.plot(force["times_s"], force["friction_N"], color=SECOND, label="friction")
    forces.set(xlabel="time (s)", ylabel="force on the braced point (N)")
    forces.legend()
    for key, colour in (("not_braced", SECOND), ("braced", OURS)):
        error.semilogy(content[key]["times_s"], [1e3 * x or math.nan for x in content[key]["error_m"]], color=colour,
                       label=key.replace("_", " "))
    error.set(xlabel="time disturbed (s)", ylabel="tip from goal (mm)")
    error.legend()
    save(figure, out)
    plt.close(figure)
    return pathlib.Path(out)


def identify(data, out) -> pathlib.Path:
    """Plots measured and predicted positions of the ends of an arm's segments, and their distances.

    Parameters
    ----------
    data : path-like
        JSON of `sinew identify`.
    out : path-like
        PNG file.
    """
    plt = pyplot()
    records = json.loads(pathlib.Path(data).read_text(encoding="utf-8"))["records"]
    figure, axes = plt.subplots(2, len(records), figsize=(5 * len(records), 6), squeeze=False, sharex="col")

    def numbers(column):
        return [math.nan if value is None else value for value in column]

    for (upper, lower), record in zip(axes.T, records):
        measured = [numbers(column) for column in record["measured"]]
        predicted = [numbers(column) for column in record["predicted"]]
        for segment in range(len(measured) // 3):
            colour = COLOURS[segment % len(COLOURS)]
            upper.plot(record["time"], [100 * x for x in measured[3 * segment]], ".", ms=3, color=colour)
            upper.plot(record["time"], [100 * x for x in predicted[3 * segment]], color=colour, lw=1)
            # Distance along the measured axes only.
            seen = [k for k in range(3 * segment, 3 * segment + 3) if not all(map(math.isnan, measured[k]))]
            off = [1e3 * math.dist([measured[k][i] for k in seen], [predicted[k][i] for k in seen])
                   for i in range(len(record["time"]))]
            lower.plot(record["time"], off, color=colour, lw=1, label=f"end {segment}")
        kind = "fitted" if record["fitted"] else "not fitted to"
        upper.set(title=f"{record['name']} ({kind}): NRMSE {100 * record['nrmse']:.2g} %", ylabel="x (cm): dots seen")
        lower.set(xlabel="time (s)", ylabel="distance of prediction (mm)")
    axes[1, 0].legend()
    save(figure, out)
    plt.close(figure)
    return pathlib.Path(out)


def sweep(folder, out=None, kind=None) -> list[pathlib.Path]:
    """Plots the table of a sweep: see sinew.sweep.plots.draw()."""
    from sinew.sweep import plots

    return plots.draw(folder, out, kind)


def _main_sweep(words: list[str]) -> int:
    """Runs `sweep DIR [OUT [KIND]]`; an empty argument counts as missing."""
    from sinew.errors import Error

    try:
        for path in sweep(*(word or None for word in words)):
            print(f"drew {path}")
    except Error as error:
        print(f"sinew: error: {error}", file=sys.stderr)
        return 2
    return 0


def main(words: list[str]) -> int:
    """Runs `run DIR OUT.png`, `sweep DIR [OUT [KIND]]`, or `brace|fit|identify|plan|reach DATA.json OUT.png`."""
    if words[:1] == ["sweep"] and 2 <= len(words) <= 4:
        return _main_sweep(words[1:])
    kinds = {"run": run, "brace": brace, "fit": fit, "identify": identify, "plan": plan, "reach": reach}
    if len(words) != 3 or words[0] not in kinds:
        print(f"usage: python3 -m sinew.plot {'|'.join(kinds)} SOURCE OUT.png", file=sys.stderr)
        return 2
    warnings.showwarning = lambda message, *_, **__: print(f"sinew: remark: {message}", file=sys.stderr)
    try:
        path = kinds[words[0]](words[1], words[2])
    except ImportError as missing:
        print(f"sinew: error: plots need matplotlib: {missing}; apt-get install python3-matplotlib", file=sys.stderr)
        return 2
    except OSError as problem:
        if problem.errno not in (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG):
            raise
        print(f"sinew: error: {words[2]}: {problem.strerror}; check that the disk is not full [recording-failed]", file=sys.stderr)
        return 1
    print(f"drew {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
