"""sinew.plan.brace: what is found, its conditions, and wrong input."""

import numpy as np
import pytest
import sinew
from sinew import pcc, plan

LIMITS = [0.0, 0.12, 0.13, 0.18]
GOAL = [0.10, 0.0, -0.50]
ENDS = [-0.072, -0.1, -0.28], [-0.072, 0.1, -0.28]


def test_a_brace_is_an_equilibrium_that_sticks():
    bar = plan.BraceObject.capsule(*ENDS, 0.05)
    brace = plan.brace(pcc.published_arm(), GOAL, LIMITS, [bar], least_force=0.15, segments=2)
    assert brace.status == "braced" and brace.segments == 2 and brace.object == 0
    assert brace.balance < 1e-8 and abs(brace.gap) < 1e-8
    assert brace.friction_force < 0.6 * brace.normal_force
    assert [c["verdict"] for c in brace.conditions] == ["holds"] * 3
    np.testing.assert_allclose(np.linalg.norm(brace.tip - GOAL), brace.tip_error)
    run = brace.run(hold=0.2, force=0.0)
    assert run.tip.shape == (run.times.size, 3) and run.cone_residual < 1e-9


def test_without_an_object_there_is_none():
    arm = pcc.published_arm()
    assert plan.brace(arm, GOAL, LIMITS, []).status == "infeasible"
    far = plan.BraceObject.sphere([2.0, 0.0, 0.0], 0.1)
    brace = plan.brace(arm, GOAL, LIMITS, [far])
    assert brace.status == "no-object-in-reach" and brace.conditions == []


@pytest.mark.parametrize("friction,kind", [("ice", "unknown-choice"), ([0.5, 0.2], "out-of-range")])
def test_wrong_friction_is_refused(friction, kind):
    with pytest.raises(sinew.Error) as error:
        ball = plan.BraceObject.sphere([-0.08, 0.0, -0.28], 0.05, friction=friction)
        plan.brace(pcc.published_arm(), GOAL, LIMITS, [ball])
    assert error.value.kind == kind
