"""Viscoelasticity by a Prony series: creep, complex compliance and dissipation of a standard solid."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Viscoelastic cube: creep, complex compliance, dissipated energy"
SETUP = """A cube of 20 mm on rollers (8 hexahedra, or tetrahedra in patches) of neo-Hookean rubber with the long-term modulus
mu = 20 kPa and a bulk modulus of 10^4 mu. It is pulled by small dead loads (strain about 10^-4), so every point has the
uniaxial stress sigma = 3 G * strain. The isochoric stress relaxes in one branch, g = 0.4 in 0.2 s (a standard linear solid),
or in three (0.2 in 20 ms, 0.15 in 0.2 s, 0.1 in 2 s).

- **Creep**: a load is applied at t = 0 and stays. The compliance of a standard linear solid is J(t) = 1/G_slow (1 - (1 -
  G_slow/G_0) exp(-t/tau_c)), tau_c = tau G_0/G_slow. Steps of 5 ms, quasi-static and with three dynamic integrators, one of
  them also with adaptive substeps; a density of 1 kg/m^3 keeps inertia small. The load rises within the first step, so the
  strain lags by up to half a step, 0.75 % of the creep.
- **Sinusoidal load**: storage and loss compliance in the last of at least 14 cycles of 200 steps each are compared with
  1/G*(omega), and the work put in over a cycle with pi J'' sigma^2/3 times the volume."""
SOURCES = {"theory": "the series itself: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed., Wiley 1980, "
                     "chapters 1 and 3; J. C. Simo, T. J. R. Hughes, Computational Inelasticity, Springer "
                     "1998, section 10.1"}
COST = 20
SIDE, SHEAR, LOAD = 0.02, 20e3, 6.0  # m, Pa, Pa
SOLID = [(0.4, 0.2)]
THREE = [(0.2, 0.02), (0.15, 0.2), (0.1, 2.0)]


class Cube:
    """A cube under a stress that may change in every step."""

    def __init__(self, series, step, integrator="quasi-static", element="hex8", **solver):
        self.sim = sinew.load({
            "sinew": 1, "gravity": [0, 0, 0], "time_step": step, "integrator": integrator,
            "solver": {**SOLVER, **solver},
            "bodies": {"cube": {
                "type": "fem", "element": element, "density": 1.0,
                "mesh": {"shape": "block", "length": SIDE, "width": SIDE, "height": SIDE,
                         "element_size": SIDE / 2},
                "material": {"model": "neo-hookean", "shear_modulus": SHEAR, "bulk_modulus": 1e4 * SHEAR,
                             "viscosity": [{"relative_modulus": g, "relaxation_time": t} for g, t in series]},
                "fixed": [{"set": f"{axis}_min", "axes": axis} for axis in "xyz"]}}})
        body = self.sim.body("cube")
        self.rest = np.array(body.rest_positions)
        self.top = np.flatnonzero(self.rest[:, 2] > SIDE * (1 - 1e-9))
        self.areas = self.shares(body, element)

    def shares(self, body, element):
        """(top,) m^2: part of the top face that belongs to each of its nodes."""
        areas = np.zeros(len(self.rest))
        if element == "hex8":
            edges = [np.isclose(self.rest[self.top, c] % SIDE, 0.0, atol=1e-9) |
                     np.isclose(self.rest[self.top, c], SIDE) for c in (0, 1)]
            areas[self.top] = 0.5 ** (edges[0].astype(int) + edges[1])
        else:
            for cell in body.tetrahedra:
                face = cell[self.rest[cell, 2] > SIDE * (1 - 1e-9)]
                if len(face) == 3:
                    a, b, c = self.rest[face]
                    areas[face] += np.linalg.norm(np.cross(b - a, c - a))
        return SIDE**2 * areas[self.top] / areas.sum()

    def strain(self, stress):
        """Strain after one step under a nominal stress, Pa."""
        body = self.sim.body("cube")
        body.external_forces[self.top, 2] = stress * self.areas
        self.sim.step()
        return float(np.mean(np.array(body.positions)[self.top, 2])) / SIDE - 1.0


def ratio(series, omega):
    """G*(omega) / long-term modulus."""
    slow = 1.0 - sum(g for g, _ in series)
    return 1.0 + sum(g / slow * 1j * omega * tau / (1.0 + 1j * omega * tau) for g, tau in series)


def creep(case, axis):
    step, count = 0.005, 200
    times = step * np.arange(1, count + 1)
    (g, tau), = SOLID
    slow = 1.0 - g
    expected = LOAD / (3 * SHEAR) * (1.0 - (1.0 - slow) * np.exp(-times * slow / tau))
    axis.plot(times, 1e4 * expected, color=plots.REFERENCE, lw=1, label="theory")
    adaptive = {"integrator": "bdf2", "adaptive": {"tolerance": 1e-7, "smallest": 1e-6}}
    runs = {"quasi-static": {}, "bdf2, adaptive": adaptive,
            "backward-euler": {"integrator": "backward-euler"}, "bdf2": {"integrator": "bdf2"},
            "generalized-alpha": {"integrator": "generalized-alpha"},
            "quasi-static, tetrahedra in patches": {"element": "tet4-patch"}}
    for name, options in runs.items():
        cube = Cube(SOLID, step, **options)
        strains = np.array([cube.strain(LOAD) for _ in times])
        first = 40 if "adaptive" in name else 3  # small substeps resolve the vibration after the sudden load
        error = np.abs(strains[first:] / expected[first:] - 1.0)
        case.bound(f"creep, {name}: largest error of the strain from {5 * (first + 1)} ms on", 100 * error.max(),
                   1.0, unit="%", source="theory")
        case.check(f"creep, {name}: strain after 1 s", 1e4 * strains[-1], 1e4 * expected[-1], 1e-3, unit="1e-4",
                   source="theory")
        if name == "quasi-static":
            axis.plot(times[::8], 1e4 * strains[::8], "o", color=plots.OURS, ms=4, label="steps of 5 ms")
    cube.sim.solve_static()
    rest = np.mean(np.array(cube.sim.body("cube").positions)[cube.top, 2]) / SIDE - 1.0
    case.check("statics: long-term strain", 1e4 * rest, 1e4 * LOAD / (3 * SHEAR), 1e-3, unit="1e-4",
               source="theory")
    axis.set(xlabel="time (s)", ylabel="strain (1e-4)")
    axis.legend()


def cycles(case, axis):
    omegas, found = np.array([0.5, 5.0, 50.0, 500.0]), []
    per_cycle = 200
    for omega in omegas:
        cube = Cube(THREE, 2 * np.pi / omega / per_cycle)
        settle = per_cycle * (2 + int(np.ceil(2.5 * omega)) if omega < 6 else 12)
        phases = 2 * np.pi * np.arange(1, settle + per_cycle + 1) / per_cycle
        stress = LOAD * np.sin(phases)
        strains = np.array([cube.strain(s) for s in stress])
        last = strains[-per_cycle:] - strains[-per_cycle:].mean()  # slow modes have not settled
        turn = np.sin(phases[-per_cycle:]) + 1j * np.cos(phases[-per_cycle:])
        compliance = 2 / per_cycle * np.sum(last * turn) * 3 * SHEAR / LOAD
        expected = 1 / ratio(THREE, omega)
        found.append(compliance)
        case.check(f"storage compliance at {omega:g} rad/s / (1/mu)", compliance.real, expected.real, 2e-3,
                   source="theory")
        case.check(f"loss compliance at {omega:g} rad/s / (1/mu)", -compliance.imag, -expected.imag, 5e-3,
                   source="theory")
        force, length = stress[-per_cycle - 1:], strains[-per_cycle - 1:]
        work = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(length)) * SIDE**3
        lost = np.pi * LOAD**2 / (3 * SHEAR) * -expected.imag * SIDE**3
        case.check(f"energy dissipated in a cycle at {omega:g} rad/s", 1e9 * work, 1e9 * lost, 0.01, unit="nJ",
                   source="theory")
    fine = np.logspace(-1, 3, 200)
    exact = 1 / ratio(THREE, fine)
    axis.semilogx(fine, exact.real, color=plots.REFERENCE, lw=1, label="storage, theory")
    axis.semilogx(fine, -exact.imag, color=plots.REFERENCE, lw=1, ls="--", label="loss, theory")
    axis.semilogx(omegas, np.real(found), "o", color=plots.OURS, label="storage")
    axis.semilogx(omegas, -np.imag(found), "s", color=plots.SECOND, label="loss")
    axis.set(xlabel="angular frequency (rad/s)", ylabel="compliance / long-term compliance")
    axis.legend()


def run(case):
    figure, axis = plots.axes()
    creep(case, axis)
    case.figure(figure, "Creep of a standard solid under a suddenly applied load.")
    figure, axis = plots.axes()
    cycles(case, axis)
    case.figure(figure, "Complex compliance against frequency.")
