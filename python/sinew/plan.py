"""Motion planning for constant-curvature arms, to goals beyond their static workspace.

    from sinew import pcc, plan
    arm = pcc.published_arm()
    task = plan.Task(arm, goal=[-0.25, 0.0, -0.45], torque_limits=[0.0, 0.12, 0.13, 0.18])
    found = task.solve()                    # a Plan: found.status, found.torque, ...
    task.replay(found).tip_error            # m, simulated with fine steps
    plan.Tracker(task, found).run()         # with feedback
    plan.Task(arm, goal, limits, actuators=actuators, cylinders=cylinders).solve().drive["command"]
    bar = plan.BraceObject.capsule([-0.077, -0.1, -0.445], [-0.077, 0.1, -0.445], 0.05)
    limits = pcc.published_torque_limits()
    plan.brace(arm, [0.05, 0.0, -0.53], limits, [bar]).run()    # braced against the bar

SI units everywhere. docs/planning.md and docs/bracing.md have the equations and their assumptions.
"""

from ._core import (
    Plan,
    PlanBrace as Brace,
    PlanBraceObject as BraceObject,
    PlanBraceRun as BraceRun,
    PlanObstacle as Obstacle,
    PlanReplay as Replay,
    PlanTask as Task,
    PlanTracker as Tracker,
    plan_brace as brace,
    plan_invert_cylinder as invert_cylinder,
    plan_invert_drive as invert_drive,
    plan_nearest_reach as nearest_reach,
    plan_plane as Plane,
    plan_prove_out_of_reach as prove_out_of_reach,
    plan_sample_reach as sample_reach,
    plan_sphere as Sphere,
)

__all__ = [
    "Brace",
    "BraceObject",
    "BraceRun",
    "Obstacle",
    "Plan",
    "Plane",
    "Replay",
    "Sphere",
    "Task",
    "Tracker",
    "brace",
    "invert_cylinder",
    "invert_drive",
    "nearest_reach",
    "prove_out_of_reach",
    "sample_reach",
]

for _name in ("Brace", "BraceObject", "BraceRun", "Obstacle", "Plan", "Replay", "Task", "Tracker"):
    _type = globals()[_name]
    _type.__module__, _type.__name__, _type.__qualname__ = "sinew.plan", _name, _name
del _type, _name
