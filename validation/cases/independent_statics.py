"""Static equilibria compared with an independent Newton solver of corotational tetrahedra and cables."""

import numpy as np
import sinew
from reference import statics

from suite import plots
from suite.robots import own_trunk

TITLE = "Static equilibrium compared with an independent solver"
SETUP = """A clamped beam under gravity with one cable, and the trunk of examples/trunk with two tensioned cables. The
reference (validation/reference/statics.py) has its own element forces (rotations by singular values), tangents (central
differences), cables, embedding of points and Newton method; it uses only the mesh of Sinew. Both stop at residuals of 1e-11
to 1e-12 of the loads. This limits their difference to about 1e-9 of the deflection, because the softest mode moves by the
residual divided by its stiffness."""
SOURCES = {"reference": "validation/reference/statics.py; corotational law of O. Etzmuss, M. Keckeisen, "
                        "W. Strasser, A fast finite element solution for cloth modelling, Pacific "
                        "Graphics 2003, and M. Mueller, M. Gross, Graphics Interface 2004"}
COST = 3
TOLERANCE = 1e-7  # of the deflection

BEAM = {
    "sinew": 1, "gravity": [0, 0, -9.81], "integrator": "quasi-static",
    "solver": {"ordering": "amd"},
    "bodies": {"body": {
        "type": "fem",
        "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02,
                 "element_size": 0.01},
        "material": {"young_modulus": 2e5, "poisson_ratio": 0.4}, "density": 1070.0,
        "fixed": [{"set": "x_min"}]}},
    "actuators": {"up": {"type": "cable", "body": "body", "pull": "body", "points": [
        [0.0, 0.01, 0.016], [0.03, 0.01, 0.016], [0.061, 0.01, 0.016], [0.098, 0.011, 0.016]]}},
}


def settled(scene, tensions):
    sim = sinew.load(scene)
    for name, tension in tensions.items():
        sim.actuator(name).tension = tension
    sim.solve_static(tolerance=1e-12)
    return sim


def compare(case, what, scene, body_name, tensions, *, young, poisson, gravity, load_steps):
    sim = settled(scene, tensions)
    body = sim.body(body_name)
    cables = [(np.array(scene["actuators"][name]["points"]),
               scene["actuators"][name].get("pull", "world") == "world") for name in tensions]
    robot = statics.Robot(body.rest_positions, body.tetrahedra, body.fixed, young, poisson, cables)
    loads = np.outer(body.node_masses, gravity)
    x = robot.settle(loads, list(tensions.values()), load_steps=load_steps)
    rest, ours = np.array(body.rest_positions), np.array(body.positions)
    deflection = np.linalg.norm(x - rest, axis=1).max()
    difference = np.linalg.norm(ours - x, axis=1)
    case.report(f"{what}: largest deflection", 1e3 * deflection, unit="mm", source="reference")
    case.bound(f"{what}: largest distance of a node from the reference / deflection",
               difference.max() / deflection, TOLERANCE, source="reference")
    pulls = {}
    for k, name in enumerate(tensions):
        pulls[name] = robot.length(k, rest) - robot.length(k, x)
        case.check(f"{what}: length pulled out of {name}", 1e3 * sim.actuator(name).displacement,
                   1e3 * pulls[name], TOLERANCE, unit="mm", source="reference")
    backwards(case, what, scene, tensions, pulls)
    return ours - rest, x - rest


def backwards(case, what, scene, tensions, pulls):
    """With these lengths prescribed, the tensions must result again."""
    sim = sinew.load(scene)
    for name, pull in pulls.items():
        sim.actuator(name).displacement = pull
    sim.solve_static(tolerance=1e-12)
    for name, tension in tensions.items():
        case.check(f"{what}: tension of {name} at the reference's length", sim.actuator(name).tension,
                   tension, TOLERANCE, unit="N", source="reference")


def run(case):
    compare(case, "beam", BEAM, "body", {"up": 1.5}, young=2e5, poisson=0.4,
            gravity=[0, 0, -9.81], load_steps=2)
    ours, reference = compare(case, "trunk", own_trunk(), "trunk", {"long_0": 3.0, "short_1": 1.5},
                              young=450e3, poisson=0.45, gravity=[0, 0, 0], load_steps=6)
    figure, axis = plots.axes()
    axis.plot(1e3 * np.linalg.norm(reference, axis=1), 1e3 * np.linalg.norm(ours - reference, axis=1),
              ".", color=plots.OURS)
    axis.set(xlabel="deflection of a node (mm)", ylabel="distance from the reference (mm)",
             yscale="log")
    case.figure(figure, "The trunk under two cables: every node compared with the reference.")
