"""The scenes and scripts of examples/, with the figures that their comments and pages claim.

A tolerance is half of the last digit of a claim, or the spread that its page gives; where rounding decides (the side to which a
symmetric robot leaves its plane), a figure that does not depend on it is taken. Times of computation are no figures here.
"""

from __future__ import annotations

import numpy as np

from .examples import Example, Figure, at, first_above, largest, last, printed

# Imported by scripts, and no examples of their own.
PARTS = ("fluidic_arm/ilc_plant.py",)


def _aside(column: str):
    return lambda ran: 1e3 * abs(float(ran.table[column][-1]))


_CURL = "docs/locomotion.md, Curling"
_STEER = "docs/steering.md"

EXAMPLES = (
    Example("arm/conical.yaml", limit=120),
    Example("arm/curl.yaml", limit=120, figures=(
        Figure("first contact", first_above("self.normal_force", 0.0), 2.675, 0.005, "s", _CURL),
        Figure("tension then", lambda ran: at("tendon.tension", first_above("self.normal_force", 0.0)(ran))(ran), 5.35, 0.01,
               "N", _CURL),
        Figure("largest normal force", largest("self.normal_force"), 0.072, 0.004, "N", _CURL),
        Figure("deepest overlap", lambda ran: -1e3 * float(np.nanmin(ran.table["self.gap"])), 0.0, 1e-9, "mm", _CURL),
        Figure("tip at 2.9 s, x", last("tip.x", 1e3), 41.9, 0.1, "mm", _CURL),
        Figure("tip at 2.9 s, distance from the tendon's plane", _aside("tip.y"), 0.8, 0.05, "mm", _CURL),
        Figure("tip at 2.9 s, z", last("tip.z", 1e3), 25.3, 0.05, "mm", _CURL))),
    Example("arm/square.yaml"),
    Example("arm/underwater.yaml"),
    Example("beam/swing.yaml"),
    Example("contact/incline.yaml", figures=(
        Figure("points that slip at the end", last("incline.slipping"), 0.0, 0.0),)),
    Example("contact/lift.yaml"),
    Example("contact/soft_lift.yaml"),
    Example("contact/squeeze.yaml"),
    Example("finger/hold.yaml"),
    Example("finger/module.yaml", limit=300),
    Example("finger/push.yaml"),
    Example("finger/ribbed.yaml"),
    Example("finger/sensors.yaml", limit=300),
    Example("fluidic_arm/arm.yaml"),
    Example("fluidic_arm/brace.yaml"),
    Example("hybrid/pick.yaml", figures=(
        Figure("steps", printed(r"^steps solved +([0-9]+)"), 1050, 0, "", "docs/grasping.md"),)),
    Example("joints/two_segments.yaml"),
    Example("rigid/bounce.yaml"),
    Example("rigid/hand.yaml"),
    Example("rigid/slider_crank.yaml"),
    Example("rigid/urdf_arm.yaml"),
    Example("ring/sma.yaml"),
    Example("roll/roll.yaml", limit=240, figures=(
        Figure("distance in periods 3 and 4, a whole turn", lambda ran: at("rim.x", 8.0, 1e3)(ran) - at("rim.x", 4.0, 1e3)(ran),
               184.5, 0.5, "mm", "docs/locomotion.md, Rolling"),)),
    Example("trunk/circle.yaml"),
    Example("trunk/trunk.yaml"),
    Example("bending_actuator/simulate.py", figures=(
        Figure("tip of order 5, in water", printed(r"^water order 5: tip within ([0-9.]+)"), 3.9, 0.05, "%",
               "docs/bending_actuator.md"),
        Figure("tip of order 7, in water", printed(r"^water order 7: tip within ([0-9.]+)"), 0.5, 0.05, "%",
               "docs/bending_actuator.md"),
        Figure("tip of order 9, in water", printed(r"^water order 9: tip within ([0-9.]+)"), 0.06, 0.005, "%",
               "docs/bending_actuator.md"))),
    Example("crawl/crawl.py", limit=600, figures=tuple(
        Figure(f"distance per cycle at friction {friction}", printed(rf"^ +{friction:.2f} +([-0-9.]+)"), distance, 0.1, "mm",
               "docs/locomotion.md, Crawling")
        for friction, distance in ((0.05, 3.4), (0.1, 9.6), (0.2, 14.3), (0.3, 15.1), (0.5, 14.9), (0.7, 14.1), (1.0, 12.1)))),
    Example("crawl/multigait.py", arguments=("{data}", "--friction", "0.7"), needs="multigait", limit=1200, figures=(
        Figure("distance per cycle at friction 0.7", printed(r"^friction 0\.7: ([-0-9.]+) mm"), 1.85, 0.05, "mm",
               "docs/locomotion.md, The multigait robot"),)),
    Example("fluidic_arm/brace.py", figures=(
        Figure("friction that the brace needs", printed(r"friction: holds, ([0-9.]+)"), 0.52, 0.025, "", "docs/bracing.md"),
        Figure("force under which it sticks", printed(r"sticks under up to ([0-9.]+)"), 0.046, 0.0025, "N", "docs/bracing.md"))),
    Example("fluidic_arm/drive.py", figures=tuple(
        Figure(f"tip on goal {goal}, two stages", printed(rf"^{goal} +two stages +([0-9.]+)"), distance, 0.02, "cm",
               "docs/planning.md, Results")
        for goal, distance in (("A", 0.31), ("B", 0.20), ("C", 0.19), ("D", 0.32)))),
    Example("fluidic_arm/identify.py"),
    Example("fluidic_arm/ilc.py", limit=600),
    Example("fluidic_arm/plan.py", figures=tuple(
        Figure(f"nearest equilibrium to goal {goal}", printed(rf"^{goal} +([0-9.]+)"), distance, 0.05, "cm", "docs/planning.md, Results")
        for goal, distance in (("A", 11.2), ("B", 9.1), ("C", 7.4), ("D", 21.5)))),
    Example("grasp/grasp.py", limit=1200, notices=("locking-element",), figures=(
        Figure("rise of the tapered cup at friction 0.6", printed(r"^ +0\.60 +([-0-9.]+)"), 62.4, 0.1, "mm", "docs/grasping.md"),
        Figure("rise of the straight cup at friction 0.6", printed(r"^ +0\.60 +([-0-9.]+) +([-0-9.]+)", 2), 59.8, 0.1, "mm",
               "docs/grasping.md"),
        Figure("tension at 8 mm of pull", printed(r"^ +8\.0 +([-0-9.]+)"), 7.1, 0.05, "N", "docs/grasping.md"),
        Figure("normal force of a finger at 8 mm of pull", printed(r"^ +8\.0 +([-0-9.]+) +([-0-9.]+)", 2), 0.41, 0.01, "N",
               "docs/grasping.md"))),
    Example("gym/judge.py", arguments=("trunk-reach", "--episodes", "20")),
    Example("gym/learn.py", arguments=("trunk-reach", "--seeds", "1"), limit=1200),
    Example("gym/policy_gradient.py", needs="torch", limit=1800, figures=(
        Figure("goals within 5 mm", printed(r"never seen, within 5 mm: ([0-9.]+)"), 0.99, 0.02, "", "docs/gym.md"),)),
    Example("high_rate/wall.py", figures=(
        Figure("energy created without passivity control, less that of theory",
               lambda ran: printed(r"^without: ([0-9.]+)")(ran) - printed(r"theory has ([0-9.]+)")(ran), 0.0, 1.0, "mJ",
               "docs/high_rate.md"),)),
    Example("hybrid/pick.py", limit=240, figures=(
        Figure("weight that the fingers carry", printed(r"sum, weight of the box +([0-9.]+)"), 0.3924, 0.0001, "N",
               "docs/grasping.md"),
        Figure("normal force of the thumb", printed(r"^ +thumb +([0-9.]+)"), 0.5750, 0.002, "N", "docs/grasping.md"),
        Figure("tension of the thumb's cable", printed(r"^ +thumb +[0-9.]+ +[0-9.]+ +([0-9.]+)"), 11.47, 0.01, "N",
               "docs/grasping.md"))),
    Example("python/closed_loop.py"),
    Example("python/compliance.py"),
    Example("python/estimate.py"),
    Example("python/follow_circle.py"),
    Example("python/grasp.py"),
    Example("python/workspace.py"),
    Example("steer/grip.py", arguments=("--force", "1.0"), limit=300, notices=("locking-element",), figures=(
        Figure("largest error of a force", printed(r"off by ([0-9.]+) % at most"), 0.0, 0.01, "%", f"{_STEER}, Hold an egg"),)),
    Example("steer/in_hand.py", arguments=("--angle", "90", "--grip", "1"), limit=300, figures=(
        Figure("angle reached", printed(r"^turned ([0-9.]+)"), 90.0, 0.0001, "degrees", f"{_STEER}, Roll a cylinder"),
        Figure("largest error of the angle", printed(r"off by ([0-9.]+) degrees at most"), 0.0, 0.0001, "degrees",
               f"{_STEER}, Roll a cylinder"))),
    Example("steer/inspection.py", figures=(
        Figure("error of the tip without friction", printed(r"^friction 0[.0]*: error ([0-9.]+)"), 0.0, 0.0015, "mm",
               f"{_STEER}, Lean on a tube"),)),
    Example("steer/manipulation.py", arguments=("--radius", "5"), limit=300, figures=(
        Figure("median distance of the cup from its path", printed(r"off its path by ([0-9.]+)"), 0.00012, 0.00005, "mm",
               f"{_STEER}, Carry a cup"),)),
    Example("steer/roll.py", arguments=("--to", "140", "60"), limit=300, figures=(
        Figure("error at 140 mm", printed(r"asked 140\.0 mm: off by ([-+0-9.]+)"), -0.16, 0.05, "mm", f"{_STEER}, Roll to a position"),
        Figure("error at 60 mm", printed(r"asked 60\.0 mm: off by ([-+0-9.]+)"), 0.02, 0.05, "mm", f"{_STEER}, Roll to a position"))),
    Example("steer/stride.py", arguments=("--strides", "4", "8", "2"), limit=900, notices=("locking-element",), figures=(
        Figure("first stride", printed(r"^stride of 4\.0 mm: ([0-9.]+)"), 3.9, 0.1, "mm", f"{_STEER}, Strides"),
        Figure("second stride", printed(r"^stride of 8\.0 mm: ([0-9.]+)"), 8.1, 0.1, "mm", f"{_STEER}, Strides"),
        Figure("third stride", printed(r"^stride of 2\.0 mm: ([0-9.]+)"), 2.0, 0.01, "mm", f"{_STEER}, Strides"))),
    Example("sweep/data_set.py"),
    Example("sweep/sensitivity.py", arguments=("--base", "256"), limit=600),
    Example("sweep/workspace.py", arguments=("--samples", "1024"), limit=300, figures=(
        Figure("least x of the tip", printed(r"tip x from +([-0-9.]+)"), -9.4, 0.05, "mm", "docs/sweeps.md"),
        Figure("largest x of the tip", printed(r"tip x from +[-0-9.]+ to +([-0-9.]+)"), 10.2, 0.05, "mm", "docs/sweeps.md"),
        Figure("largest z of the tip", printed(r"tip z from +[-0-9.]+ to +([-0-9.]+)"), 194.0, 0.05, "mm", "docs/sweeps.md"))),
    Example("trunk/demo.py", figures=(
        Figure("steps on target in the second turn", printed(r"^on target +([0-9]+)"), 100, 0, "%", "the README"),)),
    Example("trunk/make_cables.py"),
    Example("tutorial/finger_stl.py", arguments=("finger.stl",)),
)
