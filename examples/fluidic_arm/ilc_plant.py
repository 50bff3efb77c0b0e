"""A fluidic arm and its inexact model, for the learning examples. The numbers are in ilc_plants.json."""

import json
from pathlib import Path

import numpy as np
from sinew import identify, pcc

SETUP = json.loads((Path(__file__).resolve().parent / "ilc_plants.json").read_text())
MODEL, ERRORS, GOALS = SETUP["model"], SETUP["plant"], SETUP["goals"]
DRIVEN = np.vstack([np.zeros(3), np.eye(3)])  # the first segment has no actuator


def arm(masses, stiffness, damping, centre="arc"):
    return pcc.Arm(MODEL["lengths"], masses, stiffness, damping, centre=centre, actuation=DRIVEN)


def cylinder(gain=1.0, frequency=1.0):
    """Drive cylinder with limits; `gain` and `frequency` are factors on the numbers of the model."""
    given = MODEL["cylinder"]
    free = pcc.second_order_cylinder(gain * given["gain"], frequency * given["frequency"], given["damping"],
                                     given["sample_time"])
    return pcc.DriveCylinder(free.a, free.b, free.c, free.d, sample_time=given["sample_time"],
                             input_limits=tuple(given["input_limits"]), volume_limits=tuple(given["volume_limits"]))


def model(centre="arc"):
    """Initial model of the learner, (arm, actuators, cylinders), with lumped masses, or "distributed" as in the plant."""
    return (arm(MODEL["masses"], MODEL["stiffness"], MODEL["damping"], centre),
            [pcc.FluidicActuator(MODEL["cubic"], delay=MODEL["delay"])] * 3, [cylinder()] * 3)


def excitation():
    """Commands (samples, 3) that move the arm from rest through its whole range, with volumes as large as in the attempts."""
    given, step = SETUP["excitation"], MODEL["cylinder"]["sample_time"]
    time = step * np.arange(round(given["seconds"] / step) + 1)
    fade = np.sin(np.pi * np.clip(time, 0, 0.5))[:, None] ** 2
    waves = [pcc.Excitation(given["amplitude"], seed=10 * given["seed"] + k).at(time) for k in range(3)]
    return np.clip(fade * np.stack(waves, axis=1), -given["largest"], given["largest"])


class Plant:
    """Runs commands (samples, 3) and returns the measured record; `true_tip` has the path of the tip without noise."""

    def __init__(self, seed):
        random = np.random.default_rng([20, seed])

        def sign(size, count=None):
            return 1.0 + size * random.choice([-1.0, 1.0], count)

        def within(name, count=None):
            return 1.0 + random.uniform(*ERRORS[name], count)

        self.arm = arm(np.array(MODEL["masses"]) * sign(ERRORS["mass_error"], 4),
                       MODEL["stiffness"] * sign(ERRORS["stiffness_error"]),
                       MODEL["damping"] * within("damping_range"), ERRORS["centre"])
        delay = random.uniform(*ERRORS["delay_range_s"])
        self.actuators = [pcc.FluidicActuator(MODEL["cubic"] * f, delay=delay) for f in within("cubic_range", 3)]
        self.cylinders = [cylinder(within("cylinder_gain_range"), within("cylinder_frequency_range"))
                          for _ in range(3)]
        self.random, self.true_tip = random, None

    def __call__(self, command):
        step = MODEL["cylinder"]["sample_time"]
        time = step * np.arange(len(command))
        volumes = np.stack([c.simulate(u) for c, u in zip(self.cylinders, np.transpose(command))], axis=1)
        start = ERRORS["start_angle_deviation"] * self.random.standard_normal(4)
        ends = identify.predict_motion(self.arm, time, start, inputs=volumes, actuators=self.actuators, time_step=1e-3)
        self.true_tip = ends[:, -1].copy()
        ends += ERRORS["marker_noise"] * self.random.standard_normal(ends.shape)
        volumes = volumes + ERRORS["volume_noise"] * self.random.standard_normal(volumes.shape)
        return identify.MotionRecord(time, ends, volumes)
