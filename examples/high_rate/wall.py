#!/usr/bin/env python3
"""A hand on a virtual wall of 1 N/mm at 1 kHz: the energy that the wall creates with and without passivity control, and
the force on the hand as a number and an arrow, in a figure.

    wall.py [FOLDER]      on an ideal clock; writes wall.png to FOLDER (default: out/high_rate)
    wall.py --live        ten seconds in a thread of its own: the arrow in the terminal, then the lateness of periods
    wall.py --view        in the browser: a device and the point of contact that it pulls, until you close the page or press Ctrl-C
"""

import sys
import time
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import sinew

STIFFNESS, RATE, DURATION, SEED = 1000.0, 1000.0, 60.0, 1  # N/m, 1/s, s
WALL = sinew.Snapshot(np.array([[1.0 / STIFFNESS]]), np.zeros(1))


def hand(times):
    """Positions of the hand, m: eight sines of up to 6 Hz with seeded phases, at most 10 mm; positive inside the wall."""
    random = np.random.default_rng(SEED)
    frequencies, phases = np.r_[6.0, random.uniform(0.2, 6.0, 7)], random.uniform(0.0, 2.0 * np.pi, 8)
    place = np.sin(2.0 * np.pi * np.multiply.outer(times, frequencies) + phases).sum(axis=1)
    return 10e-3 * place / np.abs(place).max()


def feel(places, passivity):
    """Forces of the hand (N), energy created (J), and mean damping in the wall (N s/m)."""
    loop = sinew.HighRateLoop(None, hands=["hand"], rate=RATE, passivity=passivity)
    forces, energies, damping = np.zeros((3, len(places)))
    for k, place in enumerate(places):
        if k % 10 == 0:
            loop.publish(WALL)  # the model runs at 100 Hz
        loop.set_input(hands={"hand": place})
        loop.advance()
        output = loop.output
        forces[k], energies[k], damping[k] = output.hands["hand"], output.energy_created, output.damping
    return forces, energies, damping[(forces > 0.0) & (np.gradient(places) != 0.0)].mean()


def draw(times, places, found, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4))
    some = times < 1.0
    left.plot(times[some], 1e3 * places[some], "k", lw=1)
    left.axhspan(0.0, 11.0, color="0.85", label="wall")
    forces = found[True][0]
    for k in np.flatnonzero(some)[::40]:
        if forces[k] > 0.0:
            left.annotate("", (times[k], 1e3 * places[k] - 0.8 * forces[k]), (times[k], 1e3 * places[k]),
                          arrowprops={"arrowstyle": "->", "color": "C3"})  # fmt: skip
            left.text(times[k], 1e3 * places[k] + 0.3, f"{forces[k]:.1f}", ha="center", fontsize=7, color="C3")
    left.set(xlabel="time (s)", ylabel="hand (mm)", title="force that the hand feels (N)", ylim=(-11, 11))
    for passivity, name in ((True, "passivity controlled"), (False, "not controlled")):
        right.plot(times, 1e3 * found[passivity][1], label=name)
    right.set(xlabel="time (s)", ylabel="energy created (mJ)")
    right.legend()
    figure.tight_layout()
    figure.savefig(folder / "wall.png", dpi=110)


def live():
    loop = sinew.HighRateLoop(None, hands=["hand"], rate=RATE)
    begin = time.monotonic()
    with loop:
        while (now := time.monotonic() - begin) < 10.0:
            loop.publish(WALL)
            loop.set_input(hands={"hand": 8e-3 * np.sin(2.0 * np.pi * 0.5 * now)})
            force = loop.output.hands["hand"]
            print(f"\r{force:6.2f} N  {'<' + '-' * round(5.0 * force) if force > 0.0 else '':50}", end="", flush=True)
            time.sleep(0.01)
    report, late = loop.report, loop.lateness
    print(f"\n{report.scheduling}; {report.missed} of {report.periods} periods missed")
    print("periods began late by", ", ".join(f"{1e6 * late.quantile(part):.0f} us ({part:.1%})" for part in (0.5, 0.99, 0.999)))


def shown():
    """A device that enters the wall, and beside it a ball that the wall holds back, with the force that the hand feels.

    The ball follows the device outside the wall. Inside, the force of the hand presses it against the wall (the god-object of
    C. B. Zilles & J. K. Salisbury, IROS 1995, pp. 146-151), so the arrow of the contact is that force.
    """
    ball = {"type": "rigid", "shape": {"sphere": {"radius": "4 mm"}}, "mass": "50 g"}
    guide = {"type": "slider", "bodies": ["world", "device"], "axis": "1 0 0"}
    scene = {
        "sinew": 1, "integrator": "backward-euler", "time_step": "10 ms",
        "bodies": {"device": {**ball, "pose": {"position": "0 -8 0 mm"}}, "contact": {**ball, "pose": {"position": "0 8 0 mm"}},
                   "wall": {"type": "rigid", "shape": {"plane": {}}, "fixed": True,
                            "pose": {"position": "4 0 0 mm", "rotation": {"axis": "0 1 0", "angle": "-90 deg"}}}},
        "joints": {"rail": {**guide, "point": "0 -8 0 mm"}, "guide": {**guide, "bodies": ["world", "contact"], "point": "0 8 0 mm"}},
        "actuators": {"hand": {"type": "linear-motor", "joint": "rail", "limits": {"displacement": {"min": "-10 mm", "max": "10 mm"}},
                               "command": {"displacement": {"sine": {"amplitude": "8 mm", "period": "2 s"}}}},
                      "felt": {"type": "linear-motor", "joint": "guide", "command": {"displacement": "0 mm"}}},
        "contacts": {"touch": {"between": ["contact", "wall"]}},
    }  # fmt: skip
    sim = sinew.load(scene)
    place, felt = sim.actuator("hand"), sim.actuator("felt")
    loop = sinew.HighRateLoop(None, hands=["hand"], rate=RATE)
    with loop, sinew.view(sim, block=False, speed=1) as view:
        print("Move the slider of `hand` to take it over. `felt` shows the force as a number, the arrow its size and direction.")
        while view.update():
            loop.publish(WALL)
            loop.set_input(hands={"hand": place.displacement})
            force = loop.output.hands["hand"]
            if force > 0.0:
                felt.force = force
            else:
                felt.displacement = min(place.displacement, 0.0)
            sim.step()


def main():
    if sys.argv[1:] == ["--live"]:
        return live()
    if sys.argv[1:] == ["--view"]:
        return shown()
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/high_rate")
    folder.mkdir(parents=True, exist_ok=True)
    times = np.arange(0.0, DURATION, 1.0 / RATE)
    places = hand(times)
    found = {passivity: feel(places, passivity) for passivity in (True, False)}
    pressed = found[False][0][:-1] > 0.0
    theory = 0.5 * STIFFNESS * (np.diff(places)[pressed] ** 2).sum()
    for passivity, (forces, energies, damping) in found.items():
        name = "with passivity control" if passivity else "without"
        print(f"{name}: {1e3 * energies[-1]:.2f} mJ created, {forces.max():.2f} N at most, {damping:.3f} N s/m added")
    print(f"K T/2 = {0.5 * STIFFNESS / RATE:.3f} N s/m, of which theory has {1e3 * theory:.2f} mJ created")
    draw(times, places, found, folder)


if __name__ == "__main__":
    main()
