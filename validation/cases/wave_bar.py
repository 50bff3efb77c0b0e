"""An elastic bar that hits a rigid wall."""

import numpy as np
import sinew

from reference import shapes
from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Impact: an elastic bar against a rigid wall"
SETUP = """A steel bar, L = 1 m, 3.14 cm^2, E = 210 GPa, nu = 0, 7800 kg/m^3, of n hexahedra in a row with lumped mass, hits a
wall at v = 0.1 m/s. A wave runs through the bar and back. The force on the wall is rho c v S = 1270.8 N for 2 L/c = 0.38545
ms, and the bar leaves at v without vibration. Steps are h/(4 c) unless stated otherwise, a quarter of the time that the wave
takes through an element. The force is the mean from a quarter to three quarters of the contact; the duration is the time with
more than half of that force.

In the first step the wall stops the nodes at the end of the bar. Their momentum is a peak of force; their energy, 1/(2 n) of
the total, is lost. Other losses are waves shorter than an element can carry, and waves that the integrator damps. All of
these vanish as the elements shrink. The wave front is rounded over a length of order h^(2/3)."""
SOURCES = {"wave": "d'Alembert's solution of the wave equation; data of the example ImpactingBar of siconos-tutorials",
           "energy": "a wall at rest does no work, and there is no damping: the sum of kinetic and strain energy may not rise"}
COST = 15
LENGTH, YOUNG, DENSITY, SECTION, SPEED = 1.0, 210e9, 7800.0, 3.14e-4, 0.1
WAVE = np.sqrt(YOUNG / DENSITY)
FORCE, DURATION = DENSITY * WAVE * SPEED * SECTION, 2.0 * LENGTH / WAVE


class Impact:
    """Histories over 1.5 contact durations, and the velocities along the bar at a quarter of the duration."""

    def __init__(self, case, count, integrator, courant=0.25):
        edge = np.sqrt(SECTION)
        square = [(0.0, 0.0), (edge, 0.0), (edge, edge), (0.0, edge)]
        points = [(x, *corner) for x in np.linspace(0.0, LENGTH, count + 1) for corner in square]
        path = shapes.write_hexahedra(case.scratch / "bar.vtu", points, [range(4 * i, 4 * i + 8) for i in range(count)],
                                      {"x_min": np.arange(len(points)) < 4})
        step = courant * LENGTH / count / WAVE
        sim = sinew.load({
            "sinew": 1, "time_step": step, "integrator": integrator, "solver": SOLVER,
            "bodies": {"bar": {"type": "fem", "mesh": {"file": str(path), "unit": "m"}, "density": DENSITY,
                               "velocity": {"linear": [-SPEED, 0.0, 0.0]},
                               "material": {"model": "neo-hookean", "young_modulus": YOUNG, "poisson_ratio": 0.0}}},
            "contacts": {"wall": {"body": "bar", "nodes": {"set": "x_min"}, "surface": {"plane": {"normal": [1, 0, 0]}}}}})
        bar, wall = sim.body("bar"), sim.contact("wall")
        share = np.asarray(bar.node_masses) / bar.mass
        time, force, energy, speed = [0.0], [0.0], [0.5 * bar.mass * SPEED**2], [-SPEED]
        for k in range(round(1.5 * DURATION / step)):
            sim.step()
            time.append(sim.time)
            force.append(wall.normal_force)
            energy.append(bar.kinetic_energy + bar.strain_energy)
            speed.append(float(share @ np.asarray(bar.velocities)[:, 0]))
            if abs(sim.time - 0.25 * DURATION) < 0.51 * step:
                self.front = np.asarray(bar.rest_positions)[::4, 0].copy(), np.asarray(bar.velocities)[::4, 0].copy()
        self.time, self.force, self.energy, self.speed = np.array(time), np.array(force), np.array(energy), np.array(speed)
        middle = (self.time > 0.25 * DURATION) & (self.time < 0.75 * DURATION)
        self.plateau = self.force[middle].mean()
        self.duration = step * np.count_nonzero(self.force > 0.5 * FORCE)
        self.gain = max(0.0, float(np.diff(self.energy).max())) / energy[0]
        self.left = energy[-1] / energy[0]


def run(case):
    sizes = (50, 100, 200, 400)
    seen = [Impact(case, count, "bdf2", 0.5) for count in sizes]
    fine = Impact(case, 200, "bdf2")
    first_order = Impact(case, 200, "backward-euler")
    for name, bar in (("BDF2", fine), ("backward Euler", first_order)):
        known = "" if bar is fine else "backward Euler damps the waves near the front; this vanishes with the step"
        case.check(f"force at the wall, 200 elements, {name}", bar.plateau, FORCE, 1e-3, source="wave", unit="N")
        case.check(f"duration, 200 elements, {name}", 1e3 * bar.duration, 1e3 * DURATION, 0.01, source="wave", unit="ms", known_miss=known)
        case.check(f"rebound speed / v, 200 elements, {name}", bar.speed[-1] / SPEED, 1.0, 0.01, source="wave", known_miss=known)
        case.report(f"remaining energy, 200 elements, {name}", bar.left, reference=1.0, source="wave")
        case.bound(f"largest energy gain in a step, {name}", bar.gain, 1e-9, source="energy")
    case.check("order of the lost speed in h, BDF2", observed_order([1.0 / n for n in sizes], [1.0 - bar.speed[-1] / SPEED for bar in seen]),
               2.0 / 3.0, 0.1, source="wave", relative=False)
    case.bound("largest energy gain in a step of h/c, BDF2, 50 elements", Impact(case, 50, "bdf2", 1.0).gain, 1e-9, source="energy",
               known_miss="BDF2 cannot increase a norm of two steps; the energy of a single step is not bounded by it")
    figure, (left, middle, right) = plots.axes(3)
    for name, bar, color in (("BDF2", fine, plots.OURS), ("backward Euler", first_order, plots.SECOND)):
        left.plot(1e3 * bar.time, bar.force, color=color, label=name)
        middle.plot(*bar.front, color=color, label=name)
    left.plot(1e3 * np.array([0, 0, DURATION, DURATION, 1.5 * DURATION]), [0, FORCE, FORCE, 0, 0], "--", color=plots.REFERENCE, lw=1, label="wave")
    left.set(xlabel="time (ms)", ylabel="force at the wall (N)", ylim=(-50, 1.3 * FORCE))
    middle.plot([0, 0.5 * LENGTH, 0.5 * LENGTH, LENGTH], [0, 0, -SPEED, -SPEED], "--", color=plots.REFERENCE, lw=1, label="wave")
    middle.set(xlabel="x (m)", ylabel="speed (m/s) at L/(2 c)")
    lost = [1.0 - bar.speed[-1] / SPEED for bar in seen]
    right.loglog([1.0 / n for n in sizes], lost, "o-", color=plots.OURS, label="lost speed, BDF2")
    right.loglog([1.0 / n for n in sizes], [abs(bar.duration / DURATION - 1.0) for bar in seen], "s-", color=plots.SECOND, label="duration, BDF2")
    plots.slope_line(right, [1.0 / n for n in sizes], lost, 0.67)
    right.set(xlabel="1 / n", ylabel="relative error, steps of h/(2 c)")
    for axis in (left, middle, right):
        axis.legend()
    case.figure(figure, "Left: force at the wall, 200 elements (the peak of the first step is cut). Middle: the wave halfway through the bar. Right: "
                        "errors against the number of elements.")
