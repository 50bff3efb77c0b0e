"""Two welded bodies, compared with one body, a hand calculation and finer meshes."""

import numpy as np
import sinew

from suite import plots

TITLE = "Welded bodies: a cut beam, two materials, meshes that do not match"
SETUP = """A cantilever, 100 x 20 x 20 mm along x, is clamped at x = 0 and cut in the middle into two bodies that are welded
again. Nothing else holds the outer one.

- *Cut*: both halves have 200 kPa and matching meshes. They are compared with the same beam in one piece, under its weight and
  a cable that runs through both, with default steps and in steps to a residual of 1e-10 of the forces.
- *Two materials*: 200 and 50 kPa, bent by a small force F at the end, compared with Timoshenko's beam, F (7 L^3/(24 E1 I) +
  L^3/(24 E2 I) + L/(2 kappa G1 A) + L/(2 kappa G2 A)), kappa = 5/6 (Cowper 1966 at nu = 0), quadratic tetrahedra.
- *Weight*: force and moment of the weld are compared with the weight of the outer half.
- *Meshes*: the outer half has a finer or a coarser mesh than the inner one; the error of the deflection is relative to
  matching meshes at the finest size."""
SOURCES = {
    "one body": "the same beam without the cut",
    "Cowper 1966": "G. R. Cowper, The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33 "
                   "(1966) 335",
    "statics": "force and moment of a uniform half beam by hand",
}
COST = 25
LENGTH, SIDE, DENSITY, GRAVITY = 0.1, 0.02, 1070.0, 9.81


def part(length, size, young, element, poisson, at=0.0, fixed=False):
    body = {"type": "fem", "pose": {"position": [at, 0, 0]},
            "mesh": {"shape": "block", "length": length, "width": SIDE, "height": SIDE,
                     "element_size": size},
            "material": {"model": "neo-hookean", "young_modulus": young, "poisson_ratio": poisson},
            "density": DENSITY}
    if element:
        body["element"] = element
    if fixed:
        body["fixed"] = {"set": "x_min"}
    return body


def beam(cut, sizes=(0.01, 0.01), young=(200e3, 200e3), element=None, order=("outer", "inner"),
         poisson=0.3):
    if cut:
        bodies = {"inner": part(LENGTH / 2, sizes[0], young[0], element, poisson, fixed=True),
                  "outer": part(LENGTH / 2, sizes[1], young[1], element, poisson, at=LENGTH / 2)}
    else:
        bodies = {"inner": part(LENGTH, sizes[0], young[0], element, poisson, fixed=True)}
    outer = "outer" if cut else "inner"
    scene = {"sinew": 1, "bodies": bodies,
             "effectors": {"tip": {"body": outer, "point": [LENGTH, SIDE / 2, SIDE / 2]}}}
    if cut:
        scene["joints"] = {"seam": {"type": "weld", "bodies": list(order)}}
    return scene, outer


def sag(scene):
    sim = sinew.load(scene)
    start = np.array(sim.effector("tip").position)
    sim.solve_static()
    return float(start[2] - np.array(sim.effector("tip").position)[2]), sim


def paths_apart(solver):
    """(50,) m: distance of the tips of the cut and the whole beam after each step."""
    tips = []
    for cut in (True, False):
        scene, outer = beam(cut, (0.0125, 0.0125))  # 4 and 4 cells, or 8
        scene["gravity"], scene["solver"] = [0, 0, -GRAVITY], solver
        points = [[x, SIDE / 2, 0.016] for x in (0.002, 0.026, 0.048)]
        points += [{"body": outer, "point": [x, SIDE / 2, 0.016]} for x in (0.074, 0.098)]
        scene["actuators"] = {"cable": {
            "type": "cable", "body": "inner", "points": points, "pull": "body",
            "command": {"tension": {"ramp": {"to": 1.5, "duration": 0.3}}}}}
        sim = sinew.load(scene)
        path = []
        for _ in range(50):
            sim.step()
            path.append(np.array(sim.effector("tip").position))
        tips.append(np.array(path))
    return np.abs(tips[0] - tips[1]).max(axis=1)


def cut_and_whole(case):
    exact, default = paths_apart({"tolerance": 1e-10}), paths_apart({})
    case.check("cut: tip compared with one body, at rest after 50 default steps", default[-1], 0.0, 1e-9, source="one body",
               unit="m", relative=False)
    case.check("cut: tip compared with one body, at rest after 50 steps", exact[-1], 0.0, 1e-9, source="one body", unit="m",
               relative=False)
    case.check("cut: tip compared with one body, largest of 50 steps", exact.max(), 0.0, 1e-8, source="one body", unit="m",
               relative=False)
    # The residual that a default step may leave is relative to the sum of all forces, which includes what the weld carries.
    case.report("cut: tip compared with one body, largest of 50 default steps", default.max(), unit="m", source="one body")


def two_materials(case):
    young, force = (200e3, 50e3), 1e-4
    inertia, area = SIDE**4 / 12, SIDE**2
    kappa = 10 / 12  # at nu = 0, where the clamp does not deform the cross-section
    expected = force * (
        7 * LENGTH**3 / (24 * young[0] * inertia) + LENGTH**3 / (24 * young[1] * inertia)
        + sum(LENGTH / 2 / (kappa * e / 2 * area) for e in young))
    scene, outer = beam(True, (0.005, 0.005), young, "tet10", poisson=0.0)
    scene["loads"] = {"end": {"type": "traction", "body": outer, "surface": {"set": "x_max"},
                              "traction": [0, 0, -force / area]}}
    deflection, _ = sag(scene)
    case.check("two materials: deflection under an end force", deflection, expected, 0.01,
               source="Cowper 1966", unit="m")


def weight(case):
    scene, _ = beam(True)
    scene["gravity"] = [0, 0, -GRAVITY]
    # Stiff, so the lever arms are those at rest.
    for body in scene["bodies"].values():
        body["material"]["young_modulus"] = 2e9
    _, sim = sag(scene)
    recorded = sim.run(0.01, record=["seam.force", "seam.moment"])
    force = np.array(recorded["seam.force"])[-1]
    moment = np.array(recorded["seam.moment"])[-1]
    half = LENGTH / 2 * SIDE**2 * DENSITY * GRAVITY
    case.check("weight: force that the weld carries", -force[2], half, 1e-6, source="statics", unit="N")
    case.check("weight: its moment", moment[1], half * LENGTH / 4, 1e-3, source="statics",
               unit="N m")


def meshes(case):
    def deflection(sizes, order=("outer", "inner")):
        scene, _ = beam(True, sizes, element="tet10", order=order)
        scene["gravity"] = [0, 0, -GRAVITY / 10]
        return sag(scene)[0]

    reference = deflection((0.0025, 0.0025))
    rows = []
    for inner, outer in ((0.01, 0.01), (0.01, 0.005), (0.005, 0.01), (0.005, 0.005), (0.005, 0.0025)):
        # The body with the finer mesh comes first.
        order = ("outer", "inner") if outer <= inner else ("inner", "outer")
        error = deflection((inner, outer), order) / reference - 1
        case.report(f"meshes: inner {1e3 * inner:g} mm, outer {1e3 * outer:g} mm, error", error,
                    source="one body")
        rows.append((inner, outer, error))
    matching = abs(rows[0][2])
    case.check("meshes: outer half refined once: error / error of matching meshes",
               abs(rows[1][2]) / matching, 0.0, 1.0, source="one body", relative=False)
    return rows


def run(case):
    cut_and_whole(case)
    two_materials(case)
    weight(case)
    rows = meshes(case)
    figure, axis = plots.axes()
    names = [f"{1e3 * i:g} / {1e3 * o:g}" for i, o, _ in rows]
    axis.bar(names, [100 * abs(e) for _, _, e in rows], color=plots.OURS)
    axis.set(xlabel="element size, inner / outer half (mm)", ylabel="error of the deflection (%)")
    case.figure(figure, "Deflection of a welded cantilever of quadratic tetrahedra under its weight.")
