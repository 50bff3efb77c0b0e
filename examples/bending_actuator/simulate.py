#!/usr/bin/env python3
"""A fibre-reinforced bending actuator under slow pressure waves, in water and in air.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/bending_actuator/simulate.py --out FOLDER

draws the path of the tip, the errors of the Taylor models relative to the exact one, and a calibration.
Lengths, radii and densities are assumed; the modulus is a published fit.
"""

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from sinew import pcc

AMPLITUDES = (20e3, 50e3, 80e3, 90e3)  # Pa
PERIODS = (5.0, 10.0)  # s: 0.2 and 0.1 Hz
AIR, WATER = 1.2, 1000.0  # kg/m^3
SIZES = {"length": 0.1, "chamber_radius": 6e-3, "wall_thickness": 2e-3}


def actuator(around, **changes):
    """A level actuator, filled with the fluid around it. Below 10 kPa, the modulus is held at the lower end of its fit."""
    return pcc.BendingActuator(**{
        **SIZES, "modulus": pcc.published_modulus(outside="hold"), "filling_density": around,
        "surroundings_density": around, "inclination": np.pi / 2, "stiffness_damping": 5e-3, **changes,
    })


def wave(amplitude, period, step=0.01):
    time = np.arange(0.0, period + step / 2, step)
    return time, amplitude / 2 * (1 - np.cos(2 * np.pi * time / period))


def tip_trajectories(folder):
    """Draws the backbones at the highest pressure, the paths of the tip, and its height over a period."""
    figure, (shape, height) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
    along = np.linspace(0, 1, 60)
    for name, around, style in (("air", AIR, "-"), ("water", WATER, "--")):
        model = actuator(around)
        for number, amplitude in enumerate(AMPLITUDES):
            colour = f"C{number}"
            for period in PERIODS:
                run = model.simulate(*wave(amplitude, period), angle=model.equilibrium(0.0))
                print(f"{name:5} {amplitude / 1e3:3.0f} kPa {1 / period:.1f} Hz: {run['angle'].min():6.3f} to "
                      f"{run['angle'].max():5.3f} rad, tip up to {1e3 * run['tip'][:, 1].max():5.1f} mm high")
            shape.plot(*(1e3 * model.point(run["angle"].max(), along).T), style, color=colour)
            height.plot(run["time"] / period, 1e3 * run["tip"][:, 1], style, color=colour,
                        label=f"{amplitude / 1e3:.0f} kPa" if name == "air" else None)
    shape.plot(*(1e3 * run["tip"].T), ":", color="0.5", lw=1, label="path of the tip")
    shape.set(xlabel="x (mm)", ylabel="height (mm)", aspect="equal")
    height.set(xlabel="time over period", ylabel="height of the tip (mm)",
               title="in air (solid) and water (dashed), 0.1 Hz")
    shape.legend(frameon=False)
    height.legend(frameon=False)
    figure.savefig(folder / "tip.png", dpi=120)


def taylor_against_exact(folder):
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    time, pressure = wave(90e3, 5.0)
    for axis, (name, around) in zip(axes, {"air": AIR, "water": WATER}.items()):
        exact = actuator(around, order=None).simulate(time, pressure)
        for order in (4, 5, 6, 7, 9):
            run = actuator(around, order=order).simulate(time, pressure)
            error = np.linalg.norm(run["tip"] - exact["tip"], axis=1) / SIZES["length"]
            axis.semilogy(time, 100 * error, label=f"order {order}")
            print(f"{name:5} order {order}: tip within {100 * error.max():.3g} % of the length of the exact model")
        axis.set(title=f"in {name}, 0 to 90 kPa", xlabel="time (s)", ylim=(1e-5, 100))
    axes[0].set_ylabel("distance of the tips over length (%)")
    axes[0].legend(frameon=False)
    figure.savefig(folder / "taylor.png", dpi=120)


def calibration(folder):
    """Calibrates an actuator from the tip of another one, whose mass is distributed, with noise of 0.3 mm."""
    noise = np.random.default_rng(1)
    truth = actuator(WATER, order=None, mass_line="section")
    records = []
    for amplitude in AMPLITUDES:
        time, pressure = wave(amplitude, 5.0, 0.04)
        tip = truth.simulate(time, pressure)["tip"] + noise.normal(0.0, 3e-4, (len(time), 2))
        records.append(pcc.TipRecord(time, tip, pressure, f"{amplitude / 1e3:.0f} kPa"))
    seen = records[-1]
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    shown = np.linspace(0, seen.pressure.max(), 200)
    axes[0].plot(shown / 1e3, truth.parameters["modulus"].value(shown) / 1e3, "k:", label="behind the record")
    axes[1].plot(seen.time, 1e3 * seen.tip[:, 1], ".", ms=3, color="0.6", label="record")
    for degree in (0, 2, 5):
        fit = pcc.fit_modulus(actuator(WATER), records, degree=degree)
        axes[0].plot(shown / 1e3, fit.actuator.parameters["modulus"].value(shown) / 1e3, label=f"degree {degree}")
        axes[1].plot(seen.time, 1e3 * fit.tips[-1][:, 1], lw=1)
        worst = max(fit.errors, key=lambda errors: errors.mean)
        print(f"degree {degree}: mean error up to {100 * worst.mean_of_length:.2f} % of the length, "
              f"RMSE {1e3 * worst.root_mean_square[0]:.2f} and {1e3 * worst.root_mean_square[1]:.2f} mm")
    axes[0].set(xlabel="pressure (kPa)", ylabel="E (kPa)")
    axes[1].set(xlabel="time (s)", ylabel="height of the tip (mm)", title="0 to 90 kPa")
    axes[0].legend(frameon=False)
    axes[1].legend(frameon=False)
    figure.savefig(folder / "calibration.png", dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("."), help="folder of the figures")
    folder = parser.parse_args().out
    folder.mkdir(parents=True, exist_ok=True)
    tip_trajectories(folder)
    taylor_against_exact(folder)
    calibration(folder)


if __name__ == "__main__":
    main()
