"""sinew.plan.brace: braces, their conditions, and invalid input."""

import numpy as np
import pytest
import sinew
from sinew import pcc, plan

LIMITS = [0.0, 0.12, 0.13, 0.18]
GOAL = [0.05, 0.0, -0.53]
ENDS = [-0.077, -0.1, -0.445], [-0.077, 0.1, -0.445]


def test_a_brace_is_an_equilibrium_that_sticks():
    bar = plan.BraceObject.capsule(*ENDS, 0.05)
    brace = plan.brace(pcc.published_arm(), GOAL, LIMITS, [bar], segments=4, fractions=[0.25], hold_force=0.03)
    assert brace.status == "braced" and brace.segments == 4 and brace.object == 0
    assert brace.balance < 1e-8 and abs(brace.gap) < 1e-8
    assert brace.friction_force < 0.6 * brace.normal_force
    assert brace.hold_force > 0.03 and brace.peak_compliance >= brace.tip_compliance > 0
    assert [c["verdict"] for c in brace.conditions] == ["holds"] * 3
    # The friction condition includes the force to be held, which requires more friction.
    assert brace.conditions[0]["value"] > brace.friction_force / brace.normal_force
    np.testing.assert_allclose(np.linalg.norm(brace.tip - GOAL), brace.tip_error)
    run = brace.run(hold=0.2, force=0.0)
    assert run.tip.shape == (run.times.size, 3) and run.cone_residual < 1e-9
    assert run.status == "held" and run.mean_error < 2e-3 and run.hold_force > 0.02


def test_without_an_object_there_is_none():
    arm = pcc.published_arm()
    assert plan.brace(arm, GOAL, LIMITS, []).status == "infeasible"
    far = plan.BraceObject.sphere([2.0, 0.0, 0.0], 0.1)
    brace = plan.brace(arm, GOAL, LIMITS, [far])
    assert brace.status == "no-object-in-reach" and brace.conditions == []


def test_what_came_nearest_tells_why_there_is_none():
    bar = plan.BraceObject.capsule(*ENDS, 0.05, friction="coated-rigid")
    brace = plan.brace(pcc.published_arm(), GOAL, LIMITS, [bar], segments=4, fractions=[0.25])
    assert brace.status == "infeasible" and not brace.found
    assert {c["name"]: c["verdict"] for c in brace.conditions}["friction"] == "violated"
    assert brace.hold_force < 0.04


@pytest.mark.parametrize("friction,kind", [("ice", "unknown-choice"), ([0.5, 0.2], "out-of-range")])
def test_wrong_friction_is_refused(friction, kind):
    with pytest.raises(sinew.Error) as error:
        ball = plan.BraceObject.sphere([-0.08, 0.0, -0.28], 0.05, friction=friction)
        plan.brace(pcc.published_arm(), GOAL, LIMITS, [ball])
    assert error.value.kind == kind
