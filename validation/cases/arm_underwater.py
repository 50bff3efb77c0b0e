"""The published conical arm curled by one or two cables under water, until it touches itself."""

import time

import numpy as np
import sinew

from suite import plots
from suite.case import REPOSITORY

TITLE = "Conical arm of Ecoflex 00-30 curled under water"
SETUP = """The arm of examples/arm/underwater.yaml hangs from its base under water. One cable, or two neighbouring ones, are
pulled by 2 N/s for 1.5 s, or until a surface node enters the arm elsewhere. Hexahedra of 6.5 mm and of half that size,
Ogden's law, backward Euler at 5 ms. The source computed 21 h and 42 h for these two cases and tabulates no result; it gives
neither the damping nor its model of the water.

Assumed are cable guides of 3 mm radius every 10 mm (the source does not describe any), stiffness damping of 10 ms, buoyancy,
a drag coefficient of 1.2 on the width, and the added mass of an ideal fluid. For comparison, the case also runs in air
without gravity, with a tenth of the damping, and with bare points every 20 mm instead of guides; the finer the mesh, the more
the rubber dents at bare points. Parts that are within 40 mm of each other at rest do not count as touching. Wall times are
for one thread of this machine and are reported only."""
SOURCES = {"published": "the multi-flexible-body simulation of this arm"}
COST = 400
PULLED = {"one cable": ("east",), "two cables": ("east", "north")}
RAMP = "{tension: {ramp: {to: 3 N, duration: 1.5 s}}}"


def curl(cables, size, *more, may_end=False):
    """Times (s), tip positions (k, 3) in mm, time of self-contact (s) or None, number of elements, final axis (mm), wall time (s)."""
    told = [f"actuators.{name}.command=" + (RAMP if name in cables else "{tension: 0 N}")
            for name in ("east", "north", "west", "south")]
    sim = sinew.load(REPOSITORY / "examples" / "arm" / "underwater.yaml",
                     set=[*told, f"bodies.arm.mesh.element_size={size}", *more])
    body, tip = sim.body("arm"), sim.effector("tip")
    times, tips, touched = [0.0], [1e3 * np.array(tip.position)], None
    begin = time.perf_counter()
    while sim.time < 1.5 - 1e-9:
        try:
            sim.step()
        except sinew.RunError:  # Newton's method fails even for a sixteenth of this step
            if not may_end:
                raise
            break
        times.append(sim.time)
        tips.append(1e3 * np.array(tip.position))
        if body.self_touch(apart=0.04) is not None:
            touched = sim.time
            break
    wall = time.perf_counter() - begin
    on_axis = np.flatnonzero(np.hypot(*np.array(body.rest_positions)[:, :2].T) < 1e-9)
    return np.array(times), np.array(tips), touched, len(body.hexahedra), 1e3 * np.array(body.positions)[on_axis], wall


def report_touch(case, name, when):
    case.report(f"{name}: touches itself within 1.5 s: 1, or not: 0", float(when is not None), source="published")
    if when is not None:
        case.report(f"{name}: touches itself after", when, unit="s", source="published")


def run(case):
    figure, (left, right) = plots.axes(2)
    for (name, cables), colour in zip(PULLED.items(), (plots.OURS, plots.SECOND)):
        coarse = curl(cables, "6.5 mm")
        fine = curl(cables, "3.25 mm")
        for run_of, size in ((coarse, "6.5 mm"), (fine, "3.25 mm")):
            times, tips, touched, elements, _, wall = run_of
            report_touch(case, f"{name}, cells of {size} ({elements} hexahedra)", touched)
            case.report(f"{name}, cells of {size}: wall time", wall, unit="s", source="published")
        last = min(len(coarse[0]), len(fine[0])) - 1
        half = min(last, int(0.75 / 0.005))
        case.report(f"{name}: largest change of the tip path up to 1.5 N when the cell size is halved",
                    np.linalg.norm(coarse[1][:half] - fine[1][:half], axis=1).max()
                    / np.linalg.norm(np.diff(fine[1][:half], axis=0), axis=1).sum(), source="published")
        travelled = np.linalg.norm(np.diff(fine[1], axis=0), axis=1).sum()
        apart = np.linalg.norm(coarse[1][:last] - fine[1][:last], axis=1).max()
        case.bound(f"{name}: largest change of the tip path when the cell size is halved", apart / travelled, 0.02,
                   source="published")
        dry = curl(cables, "6.5 mm", "loads.sea.density=0 kg/m^3", "gravity=0 0 0 m/s^2")
        lively = curl(cables, "6.5 mm", "bodies.arm.damping.stiffness=0.001 s")
        bare = curl(cables, "6.5 mm", *(f"actuators.{side}.{key}" for side in ("east", "north", "west", "south")
                                        for key in ("guide_radius=0 m", "guide_spacing=20 mm")), may_end=True)
        case.report(f"{name}, with bare points: steps end at (1.5 s, a touch, or no equilibrium)", bare[0][-1], unit="s", source="published")
        for told, other in (("in air without gravity", dry), ("with a tenth of the damping", lively),
                            ("with bare points", bare)):
            until = min(len(coarse[0]), len(other[0])) - 1
            case.report(f"{name}: largest difference of the tip {told}",
                        np.linalg.norm(coarse[1][:until] - other[1][:until], axis=1).max(), unit="mm", source="published")
            report_touch(case, f"{name}, {told}", other[2])
        axis = fine[4]
        left.plot(np.hypot(axis[:, 0], axis[:, 1]) * np.sign(axis[:, 0] + axis[:, 1] + 1e-12), axis[:, 2], color=colour,
                  label=f"{name}, {fine[0][-1]:.2f} s")
        right.plot(fine[0], fine[1][:, 2], color=colour, label=name)
        right.plot(coarse[0], coarse[1][:, 2], ":", color=colour)
        right.plot(dry[0], dry[1][:, 2], "--", color=colour, lw=1, label=f"{name}, in air")
    left.set(xlabel="aside (mm)", ylabel="depth below the base (mm)", aspect="equal")
    left.invert_yaxis()
    left.legend()
    right.set(xlabel="time (s)", ylabel="tip depth below the base (mm)")
    right.legend()
    case.figure(figure, "Left: axis of the arm when it touches itself. Right: tip; dotted: cells of twice the size.")
