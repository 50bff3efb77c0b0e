"""sinew.plan: plans, replays, regulators and static reach from Python."""

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
    assert found.times[-1] == found.duration == 1.6
    assert (np.abs(found.torque) <= np.array(LIMITS) + 1e-8).all()
    np.testing.assert_allclose(found.torque_at(0.016), 0.5 * (found.torque[0] + found.torque[1]))
    run = task.replay(found)
    assert run.tip.shape == (1601, 3)
    assert run.tip_error == pytest.approx(np.linalg.norm(run.tip[-1] - GOAL))
    assert run.tip_error < 0.003 and run.tip_speed < 0.01
    assert run.clearance == np.inf


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
        ({"method": "euler"}, "unknown-choice", "hermite-simpson"),
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
