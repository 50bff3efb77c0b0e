"""The factor that the notice about locking states, against solved deflections of forty meshes."""

import re
import warnings

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "The notice about locking: forty meshes"
SETUP = """Forty bodies of linear elements: beams, tubes with thin walls, cones, ribbed fingers, trunks and pneumatic modules, in
`tet4`, `tet4-patch` and `hex8`, with Poisson's ratios from 0.3 to 0.49, under their weight, a cable or a pressure that is so small
that they respond linearly. The true factor is the deflection of the tip of a fine mesh of quadratic tetrahedra, over that of the
mesh itself; below 1, the mesh is too soft. The notice compares with quadratic elements of the same mesh and counts the motions of all
nodes. A mesh without a notice states the factor 1. The scored checks are that the notice is within 30 % of the truth on 36 of the 40
meshes, and that it is never silent where the truth is above 1.2."""
SOURCES = {"fine": "the same body in quadratic tetrahedra of at most half the size"}
COST = 240

# Shape, its finest quadratic mesh (mm), tip (m), what acts, and the meshes: element, size (mm), Poisson's ratio.
BODIES = {
    "beam": ({"shape": "block", "length": 0.08, "width": 0.01, "height": 0.01}, 2.5, [0.08, 0.005, 0.005], "weight", [
        ("tet4", 10, 0.3), ("tet4", 5, 0.3), ("tet4", 2.5, 0.3), ("tet4", 10, 0.45), ("tet4", 5, 0.45), ("tet4", 2.5, 0.45),
        ("tet4", 5, 0.49), ("tet4-patch", 10, 0.49), ("tet4-patch", 5, 0.49), ("tet4-patch", 2.5, 0.49), ("hex8", 20, 0.45),
        ("hex8", 10, 0.45), ("hex8", 5, 0.49)]),
    "plate": ({"shape": "block", "length": 0.06, "width": 0.03, "height": 0.003}, 3.0, [0.06, 0.015, 0.0015], "weight", [
        ("tet4", 3, 0.3), ("tet4-patch", 3, 0.49), ("hex8", 3, 0.49), ("hex8", 6, 0.3)]),
    "tube": ({"shape": "hollow-cylinder", "inner_radius": 0.006, "outer_radius": 0.008, "height": 0.05}, 2.0, [0.007, 0, 0.05], "weight", [
        ("tet4", 4, 0.3), ("tet4", 4, 0.49), ("tet4-patch", 4, 0.49), ("hex8", 4, 0.49), ("tet4", 2, 0.45)]),
    "cone": ({"shape": "cone", "base_radius": 0.012, "tip_radius": 0.006, "height": 0.08}, 5.0, [0, 0, 0.08], "cable", [
        ("tet4", 8, 0.3), ("tet4", 8, 0.49), ("tet4-patch", 8, 0.49), ("hex8", 8, 0.49), ("tet4", 5, 0.45)]),
    "ribs": ({"shape": "ribbed-finger", "length": 0.06, "width": 0.012, "height": 0.012, "ribs": 5, "gap": 0.003, "spine": 0.003}, 1.5,
             [0.06, 0.006, 0.0015], "weight", [
        ("tet4", 3, 0.3), ("tet4", 3, 0.49), ("tet4-patch", 3, 0.49), ("hex8", 3, 0.49), ("hex8", 6, 0.49)]),
    "trunk": ({"shape": "trunk", "height": 0.1, "base_radius": 0.012, "tip_radius": 0.006, "bellows": 6}, 4.0, [0, 0, 0.1], "cable", [
        ("tet4", 8, 0.3), ("tet4", 8, 0.45), ("tet4-patch", 8, 0.45), ("hex8", 5, 0.45)]),
    "module": ({"shape": "chambered-cylinder", "radius": 0.008, "height": 0.03, "chamber_radius": 0.003, "chamber_offset": 0.003,
                "chamber_bottom": 0.003, "chamber_top": 0.027}, 1.5, [0, 0, 0.03], "air", [
        ("tet4", 4, 0.3), ("tet4", 3, 0.49), ("tet4-patch", 3, 0.49), ("hex8", 3, 0.49)]),
}
BASE = {"beam": "x_min", "plate": "x_min", "ribs": "x_min"}
CABLES = {"cone": [[0.003, 0, 0.0], [0.003, 0, 0.08]], "trunk": [[0.003, 0, 0.0], [0.003, 0, 0.1]]}


def scene(name, element, size, poisson):
    """The scene of a body with a weak load."""
    shape, _, tip, acts, _ = BODIES[name]
    made = {
        "sinew": 1, "solver": SOLVER, "gravity": [0, 0, 0],
        "bodies": {"body": {
            "type": "fem", "element": element, "density": 1000.0, "mesh": {**shape, "element_size": 1e-3 * size},
            "material": {"model": "neo-hookean", "young_modulus": 1e5, "poisson_ratio": poisson},
            "fixed": {"set": BASE.get(name, "bottom")}}},
        "effectors": {"tip": {"body": "body", "point": tip}}}
    if acts == "weight":
        made["gravity"] = [0, 0, -1e-3] if name != "tube" else [1e-3, 0, 0]
    if acts == "cable":
        made["actuators"] = {"pull": {"type": "cable", "body": "body", "points": CABLES[name], "guide_radius": 0.002, "guide_spacing": 0.01,
                                      "command": {"tension": 1e-4}}}
    if acts == "air":
        made["actuators"] = {"air": {"type": "chamber", "body": "body", "surface": {"set": "chamber"}, "command": {"pressure": 1.0}}}
    return made


def solved(name, element, size, poisson):
    """Deflection of the tip (m), and the factor that the notice states."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim = sinew.load(scene(name, element, size, poisson))
    start = np.array(sim.effector("tip").position)
    sim.solve_static()
    said = [notice for notice in sim.notices if notice.kind == "locking-element"]
    factor = 1.0
    if said:
        number, way = re.search(r"([\d.e+]+) times too (stiff|soft)", str(said[0])).groups()
        factor = float(number) if way == "stiff" else 1.0 / float(number)
    return np.linalg.norm(np.array(sim.effector("tip").position) - start), factor


def run(case):
    truth, stated, fine = [], [], {}
    for name, (_, finest, _, _, meshes) in BODIES.items():
        for element, size, poisson in meshes:
            if (name, poisson) not in fine:
                fine[name, poisson] = solved(name, "tet10", finest, poisson)[0]
            moved, factor = solved(name, element, size, poisson)
            truth.append(fine[name, poisson] / moved)
            stated.append(factor)
            case.report(f"{name}, {element}, {size:g} mm, nu = {poisson:g}: stated (true)", f"{factor:.2f} ({truth[-1]:.2f})", source="fine")
    truth, stated = np.array(truth), np.array(stated)
    near = np.abs(stated / truth - 1.0) <= 0.3
    case.check("meshes on which the notice is within 30 %", int(near.sum()), len(truth), 0.1, source="fine")
    case.bound("meshes above 1.2 without a notice", int(((truth > 1.2) & (stated == 1.0)).sum()), 0, source="fine")
    figure, axis = plots.axes()
    axis.loglog(truth, stated, "o", color=plots.OURS)
    axis.loglog([1, truth.max()], [1, truth.max()], color=plots.SECOND)
    axis.set(xlabel="true factor", ylabel="factor of the notice")
    case.figure(figure, "Factors of forty meshes.")
