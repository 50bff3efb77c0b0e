"""Identifies a fluidic arm from motion capture: masses, stiffness, damping, actuators and their delay.

The records are simulated here with a different arm, whose mass is distributed. Read yours with
`identify.read_motion("take_1.csv", segments=4)`; the header is "time [s],x_0 [mm],y_0 [mm],z_0 [mm],...,
volume_0 [ml],...". Draws measured and predicted motion, and the residuals.

    python identify.py [--out identify.png]
"""

import argparse

import numpy as np
from sinew import identify, pcc

LENGTHS = [0.14] * 4  # m, assumed
MASSES = np.array([0.190, 0.146, 0.090, 0.090])  # kg
ACTUATION = np.vstack([np.zeros(3), np.eye(3)])  # the first segment has no actuator


def arm(masses, stiffness, damping, centre="arc"):
    return pcc.Arm(LENGTHS, masses, stiffness, damping, centre=centre, actuation=ACTUATION)


def capture(robot, actuators, seed, duration=8.0, rate=50):
    """Simulated motion capture: noise of 0.3 mm, 2 % of the markers hidden, unevenly spaced frames."""
    generator = np.random.default_rng(seed)
    time = np.arange(round(duration * rate) + 1) / rate
    time[1:-1] += 0.3 / rate * (generator.random(len(time) - 2) - 0.5)
    fade = np.sin(np.pi * np.clip(time, 0, 0.5)) ** 2  # starts from rest
    volumes = np.stack([fade * pcc.Excitation(3e-5, seed=10 * seed + k).at(time) for k in range(3)], axis=1)
    ends = identify.predict_motion(robot, time, np.zeros(4), inputs=volumes, actuators=actuators, time_step=1e-3)
    ends += 3e-4 * generator.standard_normal(ends.shape)
    ends[generator.random(ends.shape[:2]) < 0.02] = np.nan
    return identify.MotionRecord(time, ends, volumes, name=f"take_{seed}")


def draw(path, records, fits):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, rows = plt.subplots(2, len(records), figsize=(5 * len(records), 6), sharex=True, layout="constrained")
    for column, (record, fit) in enumerate(zip(records, fits)):
        for segment in range(4):
            color = f"C{segment}"
            rows[0, column].plot(record.time, 100 * record.positions[:, segment, 0], ".", ms=3, color=color)
            rows[0, column].plot(record.time, 100 * fit.predicted[:, segment, 0], color=color, lw=1)
            distance = np.linalg.norm(fit.predicted - record.positions, axis=2)[:, segment]
            rows[1, column].plot(record.time, 1e3 * distance, color=color, lw=1, label=f"end {segment}")
        rows[0, column].set(title=f"{record.name}: NRMSE {100 * fit.nrmse:.2g} %", ylabel="x (cm): dots seen")
        rows[1, column].set(xlabel="time (s)", ylabel="distance of prediction (mm)")
    rows[1, 0].legend(fontsize=8)
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="identify.png", help="figure to write")
    options = parser.parse_args()

    truth = arm(MASSES, 0.108, 4.2e-3, centre="distributed")
    actuators = [pcc.FluidicActuator(4e12, delay=0.08)] * 3
    fitted, other = capture(truth, actuators, 1), capture(truth, actuators, 2)

    guess = arm(MASSES * [0.75, 1.0, 1.25, 0.8], 0.092, 2.1e-3)
    start = [pcc.FluidicActuator(2.8e12, delay=0.02)] * 3
    free = identify.fit_arm(guess, [fitted], actuators=start)
    print(f"Nothing weighed: {free.undetermined} direction is not determined by motion.")
    found = identify.fit_arm(guess, [fitted], actuators=start, fixed=["mass_1"])
    print(f"Segment 1 weighed:\n{found}")
    record = found.records[0]
    print(f"summed error {record.start_summed_error:.3g} m before, {record.summed_error:.3g} m after; "
          f"an end is {1e3 * record.mean_error:.2g} mm off on average")
    checked = identify.validate_arm(found, [other])[0]
    print(f"a record that was not fitted to: NRMSE {100 * checked.nrmse:.2g} %")
    draw(options.out, [fitted, other], [record, checked])
    print(f"wrote {options.out}")


if __name__ == "__main__":
    main()
