"""A heavy rigid ball that slowly hits an elastic half space."""

import numpy as np
import sinew
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from reference import shapes
from reference.half_space import lost_to_the_border
from suite import plots
from suite.case import observed_order

from .hertz import E, LARGE, SPOT, core_cells, in_plane

TITLE = "Hertz's impact: a rigid ball on an elastic half space"
SETUP = """A rigid ball, R = 100 mm, on a slider along z hits the quarter of a half ball of the case hertz (nu = 0.3, 1000
kg/m^3) at 0.3 mm/s. Its mass lets it penetrate by 10 um. Without waves, m d'' = -4/3 E* sqrt(R) d^1.5, which lasts 2.87
(m^2/(R E*^2 v))^(1/5) = 98 ms; a wave takes 9 ms to the boundary and back. The half ball is stiffer than the half space
because its boundary is fixed (see hertz); the equation with this correction is integrated by DOP853. BDF2, 4 cells over the
contact radius, 40 to 320 steps in the impact. The energy that the ball does not get back is in waves, or has been damped by
the integrator: many steps on the way down close a gap, after which BDF2 restarts with backward Euler."""
SOURCES = {"Hertz": "H. Hertz 1882; K. L. Johnson, Contact Mechanics, 1985, sec. 11.4: impact of spheres, d = (15 m v^2/(16 E* sqrt(R)))^(2/5)"}
COST = 28
POISSON, RADIUS, SPEED, DENSITY = 0.3, 0.1, 3e-4, 1000.0
MODULUS = E / (1.0 - POISSON**2)
MASS = 16.0 / 15.0 * MODULUS * np.sqrt(RADIUS) * (SPOT**2 / RADIUS)**2.5 / SPEED**2
LOST = lost_to_the_border(POISSON) * (1.0 + POISSON) / (2.0 * np.pi * E * LARGE * SPOT)  # m/N


def force_at(depth):
    """Contact force on the half ball, N."""
    if depth <= 0.0:
        return 0.0
    hertz = 4.0 / 3.0 * MODULUS * np.sqrt(RADIUS)
    return brentq(lambda force: force - hertz * (depth + LOST * force)**1.5, 0.0, 4.0 * hertz * depth**1.5, xtol=1e-15)


def reference():
    """Times and depths until the ball leaves."""
    def left(_, state):
        return state[0] + 1e-12

    left.terminal, left.direction = True, -1
    way = solve_ivp(lambda _, state: [state[1], -force_at(state[0]) / MASS], (0.0, 1.0), [0.0, SPEED], method="DOP853", rtol=1e-9, atol=1e-13,
                    events=left, max_step=1e-3)
    return way.t, way.y[0]


def impact(case, cells, step, duration):
    """Times, depths, forces and final speed of the ball. A quarter of the ball hits a quarter of the block."""
    spacing = SPOT / cells
    path = shapes.half_ball(case.scratch / "half_ball.vtu", core_cells(cells) * spacing, core_cells(cells), LARGE * SPOT)
    sim = sinew.load({
        "sinew": 1, "time_step": step, "integrator": "bdf2", "solver": {"ordering": "metis"},
        "bodies": {"block": {"type": "fem", "mesh": {"file": str(path), "unit": "m"}, "fixed": [{"set": "far"}, in_plane("x"), in_plane("y")],
                             "density": DENSITY, "material": {"model": "neo-hookean", "young_modulus": E, "poisson_ratio": POISSON}},
                   "ball": {"type": "rigid", "shape": {"sphere": {"radius": RADIUS}}, "mass": 0.25 * MASS, "pose": {"position": [0, 0, RADIUS]},
                            "velocity": {"linear": [0, 0, -SPEED]}}},
        "joints": {"guide": {"type": "slider", "bodies": ["world", "ball"], "point": [0, 0, RADIUS], "axis": [0, 0, -1]}},
        "contacts": {"hit": {"between": ["block", "ball"], "nodes": {"set": "core"}}}})
    times, depths, forces = [0.0], [0.0], [0.0]
    for _ in range(round(duration / step)):
        sim.step()
        times.append(sim.time)
        depths.append(sim.joint("guide").displacement)
        forces.append(4.0 * sim.contact("hit").normal_force)
    return np.array(times), np.array(depths), np.array(forces), float(sim.body("ball").velocity[2])


def run(case):
    time, depth = reference()
    figure, (left, middle, right) = plots.axes(3)
    counts, errors = (40, 80, 160, 320), []
    for count, color in zip(counts, (plots.QUIET, plots.THIRD, plots.SECOND, plots.OURS)):
        times, depths, forces, speed = impact(case, 4, time[-1] / count, 1.15 * time[-1])
        errors.append([abs(depths.max() / depth.max() - 1.0), abs(speed / SPEED - 1.0)])
        left.plot(1e3 * times, 1e6 * depths, "o", ms=2, color=color, label=f"{count} steps")
        middle.plot(1e6 * depths, 1e3 * forces, ".", ms=3, color=color, label=f"{count} steps")
    last = np.flatnonzero(forces > 0.0)[-1]
    case.check("largest depth, 320 steps", 1e6 * depths.max(), 1e6 * depth.max(), 0.01, source="Hertz", unit="um")
    case.check("largest force, 320 steps", 1e3 * forces.max(), 1e3 * force_at(depth.max()), 0.01, source="Hertz", unit="mN")
    case.check("duration, 320 steps", 1e3 * times[last], 1e3 * time[-1], 0.01, source="Hertz", unit="ms",
               remark="resolved to one step, 0.3 %")
    case.check("impulse / (2 m v), 320 steps", float(np.sum(forces[1:] * np.diff(times))) / (2.0 * MASS * SPEED), 1.0, 0.01, source="Hertz")
    case.check("speed after / before, 320 steps", speed / SPEED, 1.0, 0.01, source="Hertz")
    case.report("order of the lost speed in the step", observed_order([1.0 / n for n in counts], np.array(errors)[:, 1]), source="Hertz")
    left.plot(1e3 * time, 1e6 * depth, color=plots.REFERENCE, lw=1, label="Hertz")
    left.set(xlabel="time (ms)", ylabel="depth (um)")
    fine = np.linspace(0.0, depth.max(), 100)
    middle.plot(1e6 * fine, [1e3 * force_at(d) for d in fine], color=plots.REFERENCE, lw=1, label="Hertz")
    middle.set(xlabel="depth (um)", ylabel="force (mN)")
    for k, (name, color) in enumerate((("greatest depth", plots.OURS), ("speed after", plots.SECOND))):
        right.loglog([1.0 / n for n in counts], np.array(errors)[:, k], "o-", color=color, label=name)
    plots.slope_line(right, [1.0 / n for n in counts], np.array(errors)[:, 1], 2)
    right.set(xlabel="step / duration", ylabel="relative error")
    for axis in (left, middle, right):
        axis.legend(fontsize=7)
    case.figure(figure, "Left: depth over time. Middle: force against depth, down and up. Right: errors against time step.")
