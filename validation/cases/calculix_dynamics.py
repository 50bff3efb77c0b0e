"""Large motion of a rubber cantilever against CalculiX."""

import numpy as np
import sinew

from reference import calculix
from suite import plots
from suite.robots import SOLVER

TITLE = "Falling rubber cantilever compared with CalculiX"
SETUP = """A beam, 100 x 20 x 20 mm, clamped at one end, neo-Hookean (mu = 35 kPa, kappa = 80 kPa, nu_0 = 0.31), 1000 kg/m^3,
is released from its straight shape under gravity. It swings by more than half its length for 0.6 s, two periods. Both codes
use the same mesh, equal steps of 2 ms and consistent masses, without damping. Sinew uses generalized-alpha with spectral
radius 1 and Newton's method, CalculiX the method of Hilber, Hughes and Taylor with alpha = 0 (the trapezoidal rule), so
neither damps. The quantity is the vertical displacement at the middle of the end.

- **tet4** is the same element in both codes except for its mass, which CalculiX integrates at one point, as it does the
  stiffness. To show the effect, the first frequency is computed with both masses and our stiffness, by inverse iteration.
- **hex8** and **tet10** are different elements. In Sinew both have mean dilatation. In CalculiX, hex8 is fully integrated,
  which locks in shear like ours but also in volume, and tet10 is a pure displacement element with four-point masses. Both
  codes must converge to each other as the mesh is refined."""
SOURCES = {"CalculiX": "G. Dhondt, The Finite Element Method for Three-Dimensional Thermomechanical "
                       "Applications, Wiley 2004; program ccx of Debian's calculix-ccx, 2.20"}
COST = 300
LAW = {"model": "neo-hookean", "shear_modulus": 35e3, "bulk_modulus": 80e3}
DENSITY, GRAVITY, STEP, DURATION = 1000.0, (0.0, 0.0, -9.81), 2e-3, 0.6
SIZES = {"tet4": (0.01, 0.005), "hex8": (0.01, 0.005), "tet10": (0.01, 20e-3 / 3)}


def scene(element, size):
    return {"sinew": 1, "gravity": list(GRAVITY), "time_step": STEP, "solver": {**SOLVER, "method": "newton"},
            "integrator": {"type": "generalized-alpha", "spectral_radius": 1.0},
            "bodies": {"beam": {"type": "fem", "element": element, "density": DENSITY, "mass_matrix": "consistent",
                                "material": LAW, "fixed": [{"set": "x_min"}],
                                "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02,
                                         "element_size": size}}}}


def cells_of(body, element):
    return {"tet4": body.tetrahedra, "tet10": body.quadratic_tetrahedra, "hex8": body.hexahedra}[element]


def both(case, element, size, duration):
    """Times, and vertical displacements (m) of the end face's centre by Sinew and by CalculiX."""
    sim = sinew.load(scene(element, size))
    body = sim.body("beam")
    rest = np.array(body.rest_positions)
    end = int(np.argmin(np.linalg.norm(rest - [0.1, 0.01, 0.01], axis=1)))
    ours = np.zeros(round(duration / STEP))
    for k in range(len(ours)):
        sim.step()
        ours[k] = body.positions[end, 2] - rest[end, 2]
    folder = case.scratch / f"{element}_{1e6 * size:.0f}"
    folder.mkdir()
    times, moved = calculix.motion(folder, rest, cells_of(body, element), np.array(body.fixed), LAW, DENSITY, GRAVITY, end,
                                   step=STEP, duration=duration)
    if len(times) != len(ours) or not np.allclose(times, STEP * np.arange(1, len(ours) + 1), rtol=1e-6):
        raise RuntimeError(f"CalculiX kept {len(times)} steps of {len(ours)}, or not even ones")
    return times, ours, moved[:, 2]


def first_trough(times, heights):
    """Time and depth of the first minimum, by a parabola through three points."""
    k = next(k for k in range(1, len(heights) - 1) if heights[k] < heights[k - 1] and heights[k] <= heights[k + 1])
    a, b, c = heights[k - 1:k + 2]
    part = 0.5 * (a - c) / (a - 2 * b + c)
    return times[k] + part * STEP, b - 0.25 * (a - c) * part


def first_frequency(body, mass_of_element):
    """First frequency at rest (Hz), with element masses V rho times a (4, 4) matrix."""
    import scipy.sparse as sparse
    from scipy.sparse.linalg import eigsh

    rest, corners = np.array(body.rest_positions), np.array(body.tetrahedra)
    volumes = np.abs(np.linalg.det(rest[corners[:, 1:]] - rest[corners[:, :1]])) / 6
    entries = (DENSITY * volumes[:, None, None] * mass_of_element).ravel()
    places = np.repeat(corners, 4, axis=1).ravel(), np.tile(corners, (1, 4)).ravel()
    free = np.flatnonzero(~np.array(body.fixed))
    mass = sparse.csr_matrix((entries, places), shape=(len(rest), len(rest)))[free][:, free]
    matrix = sparse.csc_matrix(body.stiffness())
    start = np.ones(matrix.shape[0])
    square = eigsh(matrix, k=1, M=sparse.kron(mass, sparse.eye(3)).tocsc(), sigma=0, which="LM", v0=start)[0][0]
    return np.sqrt(square) / (2 * np.pi)


def run(case):
    if not calculix.present():
        case.skip("motion in three elements", "ccx is not present", source="CalculiX")
        return
    figure, axes = plots.axes(3)
    for (element, sizes), axis in zip(SIZES.items(), axes):
        troughs, apart = [], []
        for size, style in zip(sizes, ("--", "-")):
            duration = DURATION if element != "tet10" else DURATION / 2
            times, ours, theirs = both(case, element, size, duration)
            swing = np.ptp(theirs)
            apart.append(np.abs(ours - theirs).max() / swing)
            troughs.append([first_trough(times, ours), first_trough(times, theirs)])
            axis.plot(times, 1e3 * theirs, style, color=plots.REFERENCE, lw=1, label=f"CalculiX, {1e3 * size:.3g} mm")
            axis.plot(times, 1e3 * ours, style, color=plots.OURS, lw=1, label=f"Sinew, {1e3 * size:.3g} mm")
            name = f"{element}, {1e3 * size:.3g} mm: largest difference of the motion in {duration:g} s, over the swing"
            if element == "tet4" and size == sizes[-1]:
                case.bound(name, 100 * apart[-1], 0.5, unit="%", source="CalculiX")
            else:
                case.report(name, 100 * apart[-1], unit="%", source="CalculiX")
        axis.set(title=element, xlabel="time (s)", ylabel="vertical displacement of the end (mm)")
        axis.legend(fontsize=7)
        troughs = np.array(troughs)  # sizes, codes, (time, depth)
        if element == "tet4":
            body = sinew.load(scene(element, sizes[0])).body("beam")
            shift = first_frequency(body, np.full((4, 4), 1 / 16)) / first_frequency(body, (1 + np.eye(4)) / 20) - 1
            case.report(f"tet4, {1e3 * sizes[0]:g} mm: relative difference of the first frequency with one-point and exact masses",
                        100 * shift, unit="%", source="CalculiX")
            limits = troughs[-1]
            what = f"{1e3 * sizes[-1]:g} mm"
        else:  # second order in the cell size
            limits = troughs[-1] + (troughs[-1] - troughs[0]) / ((sizes[0] / sizes[-1]) ** 2 - 1)
            what = "extrapolated to zero cell size"
            order = np.log(apart[0] / apart[1]) / np.log(sizes[0] / sizes[1])
            case.report(f"{element}: order of the difference", order, source="CalculiX")
        case.check(f"{element}, {what}: time of the first trough", 1e3 * limits[0, 0], 1e3 * limits[1, 0], 0.01, unit="ms",
                   source="CalculiX")
        case.check(f"{element}, {what}: depth of the first trough", -1e3 * limits[0, 1], -1e3 * limits[1, 1], 0.01,
                   unit="mm", source="CalculiX")
    case.figure(figure, "Fall of the end with both codes; dashed: the coarser mesh.")
