"""The examples of docs/steering.md, in shorter runs."""

import importlib.util
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import sinew

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "steer"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_trunk_leans_on_a_tube_and_arrives_behind_it(friction):
    inspection = load("inspection")
    inspection.TRAVEL = 0.5
    rows, _ = inspection.inspect(friction)
    # Columns: time, error, seconds, points, sticking, slipping, normal force, gap, on target.
    there = rows[(rows[:, 0] > 1.0) & (rows[:, 0] < 1.5)]
    assert there[:, 1].max() < 5e-6 and there[:, 8].all()
    assert there[:, 6].min() > 0.5
    pressed = rows[:, 6] > 0.0
    assert rows[pressed, 7].min() > -1e-9
    # In the step that arrives, the surfaces may overlap by the error of a following step, before any force.
    assert np.nanmin(rows[~pressed, 7]) > -2e-5


def test_fingers_hold_a_shell_with_the_force_asked_for():
    grip = load("grip")
    # The hand rises as soon as it holds the shell, which is then at rest in it.
    grip.LIFTS, grip.LIFTED, grip.END, grip.ASIDE = 1.2, 2.2, 3.5, 0.0
    rows, sim = grip.hold(1.0)
    late = rows[rows[:, 0] > grip.LIFTS]
    # The goal is 2 %, or 4 % while the fingers slip as they close, see docs/steering.md.
    assert np.abs(late[:, 1:4] - 1.0).max() < 2e-3
    assert late[-1, 4] > 0.06
    assert np.nanmin(rows[:, 5]) > -1e-8
    # The goal for a minute is 1e-6 of the size: no node moves farther, including the alternation between steps.
    assert 0.0 < grip.creep(sim, 0.3) < 1e-6 * 2 * grip.TALL


def test_fingers_carry_a_cup_along_a_circle_without_turning_it():
    manipulation = load("manipulation")
    manipulation.END = 2.7
    rows, way = manipulation.carry(manipulation.hold(), 4e-3)
    # Columns: time, distance, rotation, three normal forces, points, sticking, slipping, smallest gap, seconds.
    assert np.median(rows[:, 1]) < 1e-6 and rows[:, 1].max() < 1e-5
    assert np.median(rows[:, 2]) < 1e-5 and rows[:, 2].max() < 1e-4
    assert rows[:, 3:6].min() > 0.99 * manipulation.LEAST
    assert rows[:, 6].min() >= 81 and np.median(rows[:, 7] + rows[:, 8]) > 25  # at least as many points as Coevoet et al. (2019)
    assert rows[:, 7].min() > 0  # some points stick in every step
    assert rows[:, 9].min() > -1e-8
    assert np.linalg.norm(way[-1]) > 7e-3  # halfway around the circle


def test_one_linearisation_a_step_carries_the_cup_as_well(tmp_path):
    # The linearisation error of a dynamic step does not come from the controller's choice. When the damping reacted to it, the
    # cup was off its path by millimetres.
    manipulation = load("manipulation")
    manipulation.END = 2.7
    held = manipulation.hold()
    sim = sinew.load({**manipulation.scene(tmp_path), "solver": {"method": "one-linearisation"}}, threads=1)
    sim.restore(held.state())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        rows, _ = manipulation.carry(sim, 4e-3)
    assert np.median(rows[:, 1]) < 1e-6 and rows[:, 1].max() < 1e-5


def test_fingertips_roll_a_cylinder_between_them():
    in_hand = load("in_hand")
    in_hand.TURNED, in_hand.END = 0.65, 0.7
    angle = np.radians(15.0)
    rows, _, _ = in_hand.roll(angle, 1.0)
    # Columns: time, target, angle, distance of the axis, two normal forces, sticking, slipping, two bones, seconds.
    late = rows[rows[:, 0] > in_hand.HELD + 0.1]
    assert np.abs(late[:, 2] - late[:, 1]).max() < 1e-4
    assert rows[-1, 2] == pytest.approx(angle, abs=1e-5)
    assert late[:, 3].max() < 1e-5
    assert np.abs(late[:, 4] - 1.0).max() < 1e-3
    # One bone rises and the other one sinks, each by about the arc length; the pads shear.
    assert rows[-1, 8:10] - rows[0, 8:10] == pytest.approx(in_hand.RADIUS * angle * np.array([1.0, -1.0]), abs=0.5e-3)


def test_a_wheel_rolls_to_a_position():
    roll = load("roll")
    roll.STAYS = 1.6
    rows, _ = roll.roll([10e-3])
    # Columns: time, target, position, normal force, slipping points, smallest gap, seconds.
    assert rows[-1, 2] == pytest.approx(10e-3, abs=2.5e-3)
    assert np.abs(rows[-10:, 2] - rows[-1, 2]).max() < 1e-3  # it does not oscillate
    assert rows[:, 5].min() > -1e-8


def test_pressures_are_found_for_a_stride():
    stride = load("stride")
    stride.SHARES, stride.NEAR = (0.78, 0.85), 2e-2
    rows, log, _ = stride.walk([5e-3])
    # The stride that is made is the one found, because the search undoes its trials.
    assert rows[0, 1] == pytest.approx(5e-3, abs=0.3e-3)
    assert log[-1, 1] == rows[0, 1] and 0.78 < rows[0, 2] < 0.85


def test_a_stride_out_of_reach_says_how_far_the_robot_gets():
    stride = load("stride")
    stride.SHARES = (0.1, 0.2)
    with pytest.raises(ValueError, match="no stride to 50.0 mm: the robot gets to between"):
        stride.Quadruped().find(50e-3)


@pytest.mark.parametrize("force", [0.5, 1.0, 3.0])
def test_a_cylinder_pressed_between_pads_needs_no_parts_of_steps(force):
    # Two forces N at its ends turn a cylinder out of its place once 2 N R > I/h^2, here 0.44 N. Friction at the pads holds it.
    in_hand = load("in_hand")
    sim = sinew.load(in_hand.scene(), threads=1)
    sim.step(20)
    efforts = {name: actuator.force for name, actuator in sim.actuators.items()}
    for k in range(20):
        share = min(1.0, 0.1 * (k + 1))
        for name, effort in efforts.items():
            sim.actuator(name).force = effort + share * (force - effort) if "press" in name else effort
        sim.step()
        assert not sim.report.flagged and sim.report.substeps == 1
    # The pads bulge around the cylinder: the sum of their normal forces exceeds the force of the motors.
    assert min(sim.contact(side).normal_force for side in in_hand.SIDES) > 0.99 * force
    assert np.abs(sim.effector("turn").value).max() < 1e-3
