"""Swings planned in the commands of drive cylinders, compared with torques that are planned first and then inverted."""

import pathlib
import sys

import numpy as np
from sinew import identify, pcc, plan

from suite import plots

TITLE = "Swings planned in the commands of drive cylinders"
SETUP = """The identified four-segment arm has the actuators (tau = 4e12 V^3, 80 ms delay) and drive cylinders (second order,
40 rad/s, sampled at 10 ms, with limits on command and volume) of examples/fluidic_arm/ilc_plants.json. It swings from hanging
at rest to the goals of the case planning in 1.6 s, with knots of 32 ms and seven random starts each.

*One problem* plans motion, volumes and commands together. *Two stages* plans torques with rates within 2 N m/s, inverts the
actuators for the volumes, and finds the commands by a quadratic program; one start is repeated with 1 N m/s. The commands
then go through the whole chain: exact steps of the cylinders, delay, actuators, and the arm integrated with error control.
The same is done with cylinders of 20 rad/s and, in 2 s, of 10 rad/s, with one start each. Plans in one problem promise 0.2 cm
and 0.5 cm/s after the chain, which is the aim."""
SOURCES = {
    "aim": "our aim: as accurate as a plan of torques with perfect drives",
    "two stages": "plan.invert_drive, docs/planning.md",
    "simulator": "identify.predict_motion, which reads volumes and delays in its own way",
    "fine": "cylinders exact in steps of 1 ms, commands held for ten, so that nothing is interpolated",
    "optimum": "the best of the seven starts",
}
COST = 50
SEEDS = range(1, 8)
LEAD = 0.25
HERE = pathlib.Path(__file__).resolve()


def example():
    """The example's module of the arm and its drives."""
    folder = str(HERE.parents[2] / "examples" / "fluidic_arm")
    if folder not in sys.path:
        sys.path.append(folder)
    import ilc_plant

    return ilc_plant


def grid(duration):
    return {"duration": duration, "intervals": round(duration / 0.032)}


def one_problem(plant, goal, cylinders, seed, duration):
    arm, actuators, _ = plant.model()
    task = plan.Task(arm, plant.GOALS[goal], plant.MODEL["torque_limits"], actuators=actuators, cylinders=cylinders,
                     lead=LEAD, **grid(duration))
    found = task.solve(seed)
    return found, task.replay_commands(found.drive["command"], lead=LEAD), found.drive


def slower_torques(plant, goal, cylinders, seed, duration):
    return two_stages(plant, goal, cylinders, seed, duration, rate=1.0)


def two_stages(plant, goal, cylinders, seed, duration, rate=2.0):
    arm, actuators, _ = plant.model()
    task = plan.Task(arm, plant.GOALS[goal], plant.MODEL["torque_limits"], torque_rate_limits=rate,
                     **grid(duration))
    found = task.solve(seed)
    drive = plan.invert_drive(found, actuators, cylinders, lead=LEAD)
    return found, task.replay_commands(drive["command"], actuators, cylinders, lead=LEAD), drive


def otherwise(plant, goal, cylinders, drive):
    """The final tip by the simulator of `identify`, which interpolates the volumes independently."""
    arm, actuators, _ = plant.model()
    volumes = np.stack([c.simulate(u) for c, u in zip(cylinders, drive["command"].T)], axis=1)
    ends = identify.predict_motion(arm, drive["times"], np.zeros(4), inputs=volumes, actuators=actuators,
                                   time_step=1e-3)
    return ends[round((LEAD + 1.6) / 0.01), -1]


def finely(plant, goal, drive):
    """The run with nearly continuous cylinders under held commands."""
    arm, actuators, _ = plant.model()
    task = plan.Task(arm, plant.GOALS[goal])
    given = plant.MODEL["cylinder"]
    cylinder = pcc.second_order_cylinder(given["gain"], given["frequency"], given["damping"], 1e-3)
    held = np.repeat(drive["command"], 10, axis=0)
    return task.replay_commands(held, actuators, [cylinder] * 3, lead=LEAD)


def compare(case, plant, frequency, goal, duration, ways):
    """Final tip speed (cm/s) of each method: the worst of its starts."""
    cylinders = [plant.cylinder(frequency=frequency / plant.MODEL["cylinder"]["frequency"])] * 3
    speeds = {}
    for name, (way, scored) in ways.items():
        seeds = SEEDS if frequency == 40 and way is not slower_torques else [1]
        tried = [way(plant, goal, cylinders, seed, duration) for seed in seeds]
        found = [of for of, _, _ in tried if of.found]
        title = f"{frequency} rad/s, {goal}, {name}"
        case.report(f"{title}: starts that lead to a plan", f"{len(found)} of {len(tried)}", source="aim")
        error, speed = (100 * max(getattr(run, what) for _, run, _ in tried) for what in ("tip_error", "tip_speed"))
        change = 1e6 * max(np.abs(np.diff(drive["command"], axis=0)).max() for _, _, drive in tried)
        speeds[name] = speed
        if scored:
            case.bound(f"{title}: tip error", error, 0.2, unit="cm", source="aim")
            case.bound(f"{title}: tip speed", speed, 0.5, unit="cm/s", source="aim")
            case.report(f"{title}: largest change of a command in a sample", change, unit="ml", source="aim")
        else:
            case.report(f"{title}: tip, and largest change of a command in a sample",
                        f"{error:.2f} cm, {speed:.3g} cm/s, {change:.0f} ml", source="two stages")
        if scored and frequency == 40:
            check(case, plant, title, goal, cylinders, tried)
    return speeds


def check(case, plant, title, goal, cylinders, tried):
    least = min(of.objective for of, _, _ in tried)
    same = sum(of.objective < 1.001 * least for of, _, _ in tried)
    case.report(f"{title}: starts that lead to the same cost", f"{same} of {len(tried)}", source="optimum")
    _, run, drive = tried[0]
    apart = np.linalg.norm(otherwise(plant, goal, cylinders, drive) - run.tip[-1])
    case.bound(f"{title}: tip by the simulator of the identification: difference", 100 * apart, 0.001, unit="cm",
               source="simulator")
    fine = finely(plant, goal, drive)
    case.bound(f"{title}, in continuous time: tip error", 100 * fine.tip_error, 0.3, unit="cm", source="fine")
    case.bound(f"{title}, in continuous time: tip speed", 100 * fine.tip_speed, 1.0, unit="cm/s", source="fine")


def run(case):
    plant = example()
    ways = {"one problem": (one_problem, True), "two stages": (two_stages, False),
            "two stages, torque rates within 1 N m/s": (slower_torques, False)}
    speeds = {(frequency, goal): compare(case, plant, frequency, goal, duration, ways)
              for frequency, duration in ((40, 1.6), (20, 1.6), (10, 2.0)) for goal in plant.GOALS}
    draw(case, plant, speeds)


def draw(case, plant, speeds):
    figure, (left, right) = plots.axes(2)
    cylinders = [plant.cylinder(frequency=0.5)] * 3
    for name, way, colour in (("two stages", two_stages, plots.SECOND), ("one problem", one_problem, plots.OURS)):
        found, run, _ = way(plant, "A", cylinders, 1, 1.6)
        shown = run.times >= LEAD
        wanted = [1e3 * found.torque_at(t - LEAD)[0] for t in run.times[shown]]
        left.plot(run.times[shown] - LEAD, wanted, ":", lw=1, color=colour)
        left.plot(run.times[shown] - LEAD, 1e3 * run.torque[shown, 0], color=colour, label=name)
    left.set(xlabel="time (s)", ylabel="torque of segment 2 (mN m)")
    left.legend()
    places = np.arange(len(plant.GOALS))
    for k, frequency in enumerate((40, 20, 10)):
        for name, marker, colour in (("two stages", "s", plots.SECOND), ("one problem", "o", plots.OURS)):
            values = [speeds[frequency, goal][name] for goal in plant.GOALS]
            right.semilogy(places + 0.2 * (k - 1), values, marker, color=colour, label=name if k == 0 else None,
                           alpha=1.0 - 0.3 * k)
    right.set_xticks(places, list(plant.GOALS))
    right.set(xlabel="goal; 40, 20, 10 rad/s from left to right", ylabel="final speed of the tip (cm/s)")
    right.legend()
    case.figure(figure, "Left: torque of one segment on the swing to A, cylinders of 20 rad/s, planned (dotted) and "
                        "delivered. Right: final speed of the tip after the chain.")
