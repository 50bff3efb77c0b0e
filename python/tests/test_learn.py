"""sinew.learn, and the inversion of drives that it uses."""

import numpy as np
import pytest
import sinew
from sinew import identify, learn, pcc, plan

STEP, LEAD = 0.01, 0.15
GOAL = [0.16, 0.0, -0.20]


def arm(mass=1.0, stiffness=1.0, centre="arc"):
    return pcc.Arm([0.14, 0.14], mass * np.array([0.12, 0.09]), 0.108 * stiffness, 4.2e-3, centre=centre)


def cylinder(frequency=60.0, largest=8e-5):
    free = pcc.second_order_cylinder(1.0, frequency, 0.8, STEP)
    return pcc.DriveCylinder(free.a, free.b, free.c, free.d, sample_time=STEP, input_limits=(-largest, largest),
                             volume_limits=(-5e-5, 5e-5))


def learner(torque_limits=(0.15, 0.15), **more):
    options = {"duration": 0.8, "lead": LEAD, "plan_options": {"intervals": 25}, **more}
    return learn.Learner(arm(), [pcc.FluidicActuator(4e12, delay=0.05)] * 2, [cylinder()] * 2, GOAL, torque_limits,
                         **options)


def rehearsed(plant, **more):
    student = learner(**more)
    command = student.rehearsal(0.9)
    student.learn_from(command, plant(command))
    return student


class Plant:
    """A plant that is heavier and softer than the model, with more delay, slower cylinders and distributed mass."""

    def __init__(self):
        self.random = np.random.default_rng(3)
        self.arm = arm(1.1, 0.9, "distributed")
        self.actuators = [pcc.FluidicActuator(3.7e12, delay=0.08)] * 2
        self.cylinder = cylinder(52.0)

    def __call__(self, command):
        time = STEP * np.arange(len(command))
        volumes = np.stack([self.cylinder.simulate(u) for u in command.T], axis=1)
        ends = identify.predict_motion(self.arm, time, np.zeros(2), inputs=volumes, actuators=self.actuators,
                                       time_step=2e-3)
        return identify.MotionRecord(time, ends + 2e-4 * self.random.standard_normal(ends.shape),
                                     volumes + 5e-8 * self.random.standard_normal(volumes.shape))


def test_attempts_come_nearer():
    student = learner()
    first, second, third = student.run(Plant(), 3)
    assert first.tip_error > 0.02
    assert min(second.tip_error, third.tip_error) < 0.25 * first.tip_error
    assert third.tip_error < 0.01
    assert first.proposal.times[-1] == pytest.approx(LEAD + 0.8)
    assert first.proposal.command.shape == first.proposal.volume.shape == (96, 2)
    # The assumed delay, and the identified one.
    assert first.proposal.actuators[0].delay == 0.05
    assert student.actuators[0].delay == pytest.approx(0.08, abs=0.01)
    assert [a.tip_error for a in student.attempts] == [first.tip_error, second.tip_error, third.tip_error]
    assert third.tip_error == pytest.approx(np.linalg.norm(third.record.positions[-1, -1] - GOAL))


def test_a_motion_before_the_first_attempt_helps():
    plant = Plant()
    time = STEP * np.arange(301)
    fade = np.sin(np.pi * np.clip(time, 0.0, 0.5))[:, None] ** 2
    command = fade * np.stack([pcc.Excitation(3e-5, seed=k).at(time) for k in (1, 2)], axis=1)
    student = learner()
    assert student.learn_from(command, plant(command)) is not None
    told = next(student.run(plant, 1))
    untold = next(learner().run(plant, 1))
    assert told.tip_error < 0.5 * untold.tip_error


def test_the_next_commands_are_the_last_with_a_small_change():
    plant = Plant()
    first, second, third = (attempt.proposal for attempt in rehearsed(plant).run(plant, 3))
    for before, after in ((first, second), (second, third)):
        assert after.plan is before.plan
        assert 0.0 < np.linalg.norm(after.command - before.command) < 0.1 * np.linalg.norm(before.command)
        assert np.linalg.norm(after.predicted - GOAL) < 2e-3


def test_changed_commands_keep_the_limits_of_volume():
    # The goal needs nearly the full torques: without the limits, the volumes would exceed them by 15 %.
    plant, limits = Plant(), (0.075, 0.105)
    most = [pcc.FluidicActuator(4e12).volume(torque) for torque in limits]
    for attempt in rehearsed(plant, torque_limits=limits).run(plant, 3):
        share = np.abs(attempt.proposal.volume).max(axis=0) / most
        assert share.max() < 1.001
        assert share.max() > 0.98
    assert attempt.tip_error < 0.005


def test_changed_commands_keep_the_limits_of_cylinders():
    # The command limits are slightly above the static volumes, so commands that accelerate the cylinders are clipped.
    plant = Plant()
    plant.cylinder = cylinder(52.0, 3.6e-5)
    student = learn.Learner(arm(), [pcc.FluidicActuator(4e12, delay=0.05)] * 2, [cylinder(60.0, 3.6e-5)] * 2, GOAL,
                            (0.15, 0.15), duration=0.8, lead=LEAD, plan_options={"intervals": 25})
    command = student.rehearsal(0.9)
    student.learn_from(command, plant(command))
    for attempt in student.run(plant, 3):
        most = np.abs(attempt.proposal.command).max()
        assert 0.999 * 3.6e-5 < most <= 3.6e-5 * (1 + 1e-12)
    assert attempt.tip_error < 0.005


def test_a_rehearsal_makes_the_first_attempt_better():
    plant = Plant()
    student = learner()
    command = student.rehearsal(0.9)
    np.testing.assert_allclose(command, 0.9 * learner().propose().command, rtol=1e-9, atol=1e-15)
    assert student.attempts == []
    record = plant(command)
    assert np.linalg.norm(record.positions[-1, -1] - GOAL) > 0.02
    student.learn_from(command, record)
    assert next(student.run(plant, 1)).tip_error < 0.5 * next(learner().run(plant, 1)).tip_error
    for fraction in (0.0, 1.0):
        with pytest.raises(sinew.Error, match="between 0 and 1"):
            student.rehearsal(fraction)


def test_a_cylinder_is_told_what_gives_the_volumes():
    drive = cylinder()
    commands = 3e-5 * np.sin(6.0 * STEP * np.arange(100))
    volumes = drive.simulate(commands)
    found = plan.invert_cylinder(drive, volumes, smoothing=1e-11)
    assert found["status"] == "optimal"
    np.testing.assert_allclose(found["volume"], volumes, atol=1e-11)
    np.testing.assert_allclose(found["command"][:-1], commands[:-1], atol=3e-8)
    assert drive.input_limits == (-8e-5, 8e-5) and drive.volume_limits == (-5e-5, 5e-5)
    bound = plan.invert_cylinder(drive, np.full(60, 9e-5))
    assert bound["volume"].max() == pytest.approx(5e-5) and bound["command"].max() <= 8e-5 * (1 + 1e-9)


def test_torques_go_back_to_commands():
    task = plan.Task(arm(), GOAL, [0.15, 0.15], torque_rate_limits=2.0, duration=0.8, intervals=25)
    found = task.solve(1)
    actuators = [pcc.FluidicActuator(4e12, delay=0.05)] * 2
    drive = plan.invert_drive(found, actuators, [cylinder()] * 2, lead=LEAD)
    assert drive["found"] and drive["status"] == ["optimal", "optimal"]
    k = 60
    torque = actuators[0].torque(drive["wanted"][k])
    np.testing.assert_allclose(torque, found.torque_at(drive["times"][k] + 0.05 - LEAD), atol=1e-12)
    with pytest.raises(sinew.Error, match="lead of at least"):
        plan.invert_drive(found, actuators, [cylinder()] * 2, lead=0.02)
    with pytest.raises(sinew.Error, match="a cylinder for each"):
        plan.invert_drive(found, actuators, [cylinder()], lead=LEAD)


def test_what_cannot_be():
    student = learner()
    record = identify.MotionRecord(STEP * np.arange(50), np.zeros((50, 2, 3)), np.zeros((50, 2)))
    with pytest.raises(sinew.Error, match="call propose"):
        student.observe(record)
    student.propose()
    with pytest.raises(sinew.Error, match="50 samples for 96"):
        student.observe(record)
    with pytest.raises(sinew.Error, match="1 or more"):
        learner(memory=0)
    with pytest.raises(sinew.Error, match="cylinder for each"):
        learn.Learner(arm(), [pcc.FluidicActuator(4e12)] * 2, [cylinder()], GOAL, [0.1, 0.1])
