"""sinew.plan: plans, replays, regulators and static reach."""

import numpy as np
import pytest
import sinew
from sinew import pcc, plan

LIMITS = [0.0, 0.12, 0.13, 0.18]
GOAL = [0.20, 0.0, -0.40]


@pytest.fixture(scope="module")
def grab():
    task = plan.Task(pcc.published_arm(), GOAL, LIMITS, torque_rate_limits=2.0)
    return task, task.solve(1)


def test_a_plan_is_carried_out(grab):
    task, found = grab
    assert found.status == "solved" and found.found
    assert found.theta.shape == found.torque.shape == (51, 4)
    assert found.times[-1] == found.duration == pytest.approx(1.6)
    assert (np.abs(found.torque) <= np.array(LIMITS) + 1e-8).all()
    np.testing.assert_allclose(found.torque_at(0.016), 0.5 * (found.torque[0] + found.torque[1]))
    run = task.replay(found)
    assert run.tip.shape == (1601, 3)
    assert run.tip_error == pytest.approx(np.linalg.norm(run.tip[-1] - GOAL))
    assert found.tip_error <= 2e-3 and found.tip_speed <= 5e-3
    assert run.tip_error == pytest.approx(found.tip_error, abs=2e-6)
    assert run.tip_speed == pytest.approx(found.tip_speed, abs=5e-6)
    at = np.linalg.norm(pcc.published_arm().endpoints(found.theta[-1])[-1] - GOAL)
    assert found.planned_tip_error == pytest.approx(at, abs=1e-12)
    assert found.corrections >= 0 and found.clearance == np.inf
    assert run.clearance == np.inf


def test_what_the_torques_miss_is_said():
    settings = {"method": "backward-euler", "duration": 2.4, "intervals": 30}
    found = plan.Task(pcc.published_arm(), GOAL, LIMITS, **settings).solve(1, corrections=0)
    assert found.status == "not-met-on-replay" and not found.found
    assert found.planned_tip_error <= 2e-3 and found.tip_error > 0.02
    with pytest.raises(sinew.Error, match="give zero or more"):
        plan.Task(pcc.published_arm(), GOAL, LIMITS).solve(1, corrections=-1)


def test_warm_starts_and_obstacles(grab):
    _, before = grab
    arm = pcc.published_arm()
    warm = plan.Task(arm, [0.205, 0.0, -0.40], LIMITS, torque_rate_limits=2.0).solve(warm=before)
    assert warm.found
    floor = plan.Plane(point=[0, 0, -0.6], normal=[0, 0, 1], clearance=0.01)
    task = plan.Task(arm, GOAL, LIMITS, obstacles=[floor, plan.Sphere([0, 0.3, 0], 0.1)])
    found = task.solve(1)
    assert found.found
    assert task.replay(found).clearance > 0.0


def test_feedback_helps_a_disturbed_arm(grab):
    tracker = plan.Tracker(*grab)
    assert tracker.gain(0).shape == (4, 8)
    assert tracker.steps * tracker.time_step == pytest.approx(1.6)
    start = [0.05, -0.05, 0.05, 0.0]
    closed, bare = tracker.run(theta=start), tracker.run(theta=start, feedback=False)
    assert closed.tip_error < 0.5 * bare.tip_error
    with pytest.raises(sinew.Error, match="give 0 to"):
        tracker.gain(10000)


def drives(frequency):
    cylinder = pcc.second_order_cylinder(1.0, frequency, 0.8, 0.01)
    limited = pcc.DriveCylinder(cylinder.a, cylinder.b, cylinder.c, cylinder.d, sample_time=0.01,
                                input_limits=(-8e-5, 8e-5), volume_limits=(-4e-5, 4e-5))
    return [pcc.FluidicActuator(4e12, delay=0.08)] * 4, [limited] * 4


def test_a_plan_in_commands_of_cylinders(grab):
    arm = pcc.published_arm()
    actuators, cylinders = drives(20.0)
    task = plan.Task(arm, GOAL, LIMITS, actuators=actuators, cylinders=cylinders, lead=0.25)
    found = task.solve(1)
    assert found.found
    drive = found.drive
    assert drive["command"].shape == drive["volume"].shape == (186, 4) and drive["lead"] == 0.25
    np.testing.assert_allclose(np.diff(drive["times"]), 0.01)
    np.testing.assert_allclose(drive["volume"][:, 3], cylinders[3].simulate(drive["command"][:, 3]), atol=1e-20)
    assert (np.abs(drive["command"]) <= 8e-5 * (1 + 1e-6)).all()
    # Volumes act after the delay: the volume at 1.0 s acts 0.83 s into the plan.
    np.testing.assert_allclose(found.torque_at(0.83), [actuators[0].torque(v) for v in drive["volume"][100]],
                               atol=1e-14)
    run = task.replay_commands(drive["command"], lead=0.25)
    assert run.times[-1] == pytest.approx(1.85)
    assert run.tip_error < 0.003 and run.tip_speed < 0.01
    # The cylinders reproduce torques planned without them less accurately.
    before, torques = grab
    inverted = plan.invert_drive(torques, actuators, cylinders, lead=0.25)
    after = before.replay_commands(inverted["command"], actuators, cylinders, lead=0.25)
    assert after.tip_speed > 2 * run.tip_speed
    assert torques.drive is None


def test_what_drives_cannot_be():
    arm = pcc.published_arm()
    actuators, cylinders = drives(40.0)
    with pytest.raises(sinew.Error, match="give a cylinder for each actuator"):
        plan.Task(arm, GOAL, LIMITS, actuators=actuators)
    with pytest.raises(sinew.Error, match="give one for each input"):
        plan.Task(arm, GOAL, LIMITS, actuators=actuators[:2], cylinders=cylinders[:2])
    with pytest.raises(sinew.Error, match="at least the longest delay"):
        plan.Task(arm, GOAL, LIMITS, actuators=actuators, cylinders=cylinders, lead=0.05)
    with pytest.raises(sinew.Error, match="give zero or more"):
        plan.Task(arm, GOAL, LIMITS, actuators=actuators, cylinders=cylinders, lead=-0.1)
    with pytest.raises(sinew.Error, match="the duration is not free"):
        plan.Task(arm, GOAL, LIMITS, actuators=actuators, cylinders=cylinders, duration_range=[1, 2])
    task = plan.Task(arm, GOAL, LIMITS)
    with pytest.raises(sinew.Error, match="0 actuators and cylinders for 4 inputs"):
        task.replay_commands(np.zeros((9, 4)), lead=0.25)


def test_static_reach():
    arm = pcc.published_arm()
    held = plan.sample_reach(arm, LIMITS, samples=20)
    assert held["tip"].shape[0] == held["theta"].shape[0] > 0
    nearest = plan.nearest_reach(arm, LIMITS, GOAL)
    assert nearest["found"] and 0.05 < nearest["distance"] < 0.1
    assert plan.prove_out_of_reach(arm, LIMITS, GOAL)["verdict"] == "out-of-reach"
    inside = plan.prove_out_of_reach(arm, LIMITS, [0.1, 0.0, -0.5])
    assert inside["verdict"] == "reachable"
    np.testing.assert_allclose(arm.endpoints(inside["theta"])[-1], [0.1, 0.0, -0.5], atol=0.021)


@pytest.mark.parametrize(
    "change,kind,text",
    [
        ({"goal": [0.5, 0.0, -0.4]}, "out-of-range", "0.56 m long"),
        ({"goal": [0.5, 0.0]}, "wrong-shape", "goal"),
        ({"torque_limits": [[0.1] * 4, [-0.1] * 4]}, "contradictory-limits", "above the upper"),
        ({"torque_limits": [0.1] * 3}, "wrong-shape", "torque_limits"),
        ({"theta": [0.5] * 4, "angle_limits": 0.1}, "contradictory-limits", "start.position"),
        ({"method": "euler"}, "unknown-choice", "radau"),
        ({"intervals": 1}, "out-of-range", "intervals"),
        ({"duration_range": [2.0, 1.0]}, "contradictory-limits", "duration"),
    ],
)
def test_wrong_tasks_are_refused(change, kind, text):
    with pytest.raises(sinew.Error, match=text) as error:
        plan.Task(**{"arm": pcc.published_arm(), "goal": GOAL, "torque_limits": LIMITS, **change})
    assert error.value.kind == kind


def test_what_has_no_plan_says_so():
    task = plan.Task(pcc.published_arm(), [-0.3, 0.0, -0.3], LIMITS, duration=0.3, intervals=10)
    found = task.solve(1)
    assert found.status == "infeasible" and not found.found
