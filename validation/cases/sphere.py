"""Hollow spheres under pressure."""

import numpy as np
import sinew

from reference import shapes
from suite import plots
from suite.case import observed_order
from suite.robots import SOLVER

TITLE = "Hollow spheres under internal pressure"
SETUP = """Shells of hexahedra around the origin, each face of a cube divided into n x n cells, with the pressure of a chamber
on the inside. Nodes on the planes of symmetry slide in them.

- **Small strain**: inner radius 1 m, outer 2 m, E = 1000 Pa, nu = 0.3, p = 1 Pa. The Saint Venant-Kirchhoff law is used at a
  thousandth of that pressure, and the result is scaled up.
- **Finite strain**: neo-Hookean, mu = 1 Pa, nu_0 = 0.4999, outer over inner radius 2 and 1.02. The *volume* of the chamber is
  commanded, so the curve continues beyond the peak of the pressure. The stretch of the inner radius comes from the volume of
  the chamber. The chamber is a polyhedron; relative to its volume at rest this cancels."""
SOURCES = {
    "Lame": "G. Lame 1852; S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed. 1970, art. 136: "
            "u(a) = p a/(E (b^3 - a^3)) ((1 - 2 nu) a^3 + (1 + nu) b^3/2) = 8.0e-4 m",
    "integral": "A. E. Green, W. Zerna, Theoretical Elasticity, 2nd ed. 1968, sec. 3.10; incompressible: "
                "p = mu/2 (4/l_b + 1/l_b^4 - 4/l_a - 1/l_a^4), l_b^3 = 1 + (l_a^3 - 1)(a/b)^3",
    "thin": "thin wall: p ~ (1 - l^-6)/l has its maximum at l = 7^(1/6)",
}
COST = 40


def sphere(case, law, ratio, around, through, command):
    path = shapes.hollow_sphere(case.scratch / f"sphere_{ratio}_{around}_{through}.vtu", 1.0, ratio, around, through)
    rollers = [{"plane": {"point": [0, 0, 0], "normal": n, "within": 1e-9}, "axes": a}
               for n, a in (([1, 0, 0], "x"), ([0, 1, 0], "y"), ([0, 0, 1], "z"))]
    return sinew.load({
        "sinew": 1, "solver": SOLVER,
        "bodies": {"shell": {"type": "fem", "mesh": {"file": str(path), "unit": "m"}, "material": law, "fixed": rollers}},
        "actuators": {"air": {"type": "chamber", "body": "shell", "surface": {"inside": [0, 0, 0]},
                              "command": command}}})


def radial(sim, radius):
    """Mean radial displacement of the nodes with this radius at rest."""
    body = sim.body("shell")
    rest = np.array(body.rest_positions)
    at = np.abs(np.linalg.norm(rest, axis=1) - radius) < 1e-9
    out = rest[at] / radius
    return np.einsum("ij,ij->i", np.array(body.positions)[at] - rest[at], out).mean()


def small(case):
    law = {"model": "saint-venant-kirchhoff", "young_modulus": 1000.0, "poisson_ratio": 0.3}
    sizes, errors, values = (4, 6, 8, 12), [], []
    for n in sizes:
        sim = sphere(case, law, 2.0, n, n, {"pressure": 1e-3})
        sim.solve_static()
        found = 1e3 * radial(sim, 1.0)
        values.append(found)
        errors.append(abs(found / 8.0e-4 - 1.0))
    case.report(f"small strain: u(a), {sizes[-1]} cells", found, reference=8.0e-4, unit="m", source="Lame")
    limit = values[-1] + (values[-1] - values[-3]) / ((sizes[-1] / sizes[-3]) ** 2 - 1)
    case.check("small strain: u(a), extrapolated from 6 and 12 cells", limit, 8.0e-4, 1e-3, unit="m", source="Lame")
    case.check("small strain: order of convergence", observed_order([1 / n for n in sizes], errors), 2.0, 0.15,
               source="Lame", relative=False)
    return sizes, errors


def pressure_of(stretch, ratio):
    outer = np.cbrt(1 + (stretch**3 - 1) / ratio**3)
    return 0.5 * (4 / outer + outer**-4 - 4 / stretch - stretch**-4)


def curve(case, ratio, around, through, stretches):
    law = {"model": "neo-hookean", "shear_modulus": 1.0, "poisson_ratio": 0.4999}
    sim = sphere(case, law, ratio, around, through, {"volume_growth": 0.0})
    air = sim.actuator("air")
    rest, found = air.volume, []
    for stretch in stretches:
        air.volume_growth = rest * (stretch**3 - 1)
        sim.solve_static(max_iterations=200)
        found.append(air.pressure)
    return np.array(found)


def run(case):
    sizes, errors = small(case)
    stretches = np.array([1.1, 1.2, 1.4, 1.6, 1.8, 2.0, 2.3, 2.6])
    thick = curve(case, 2.0, 8, 8, stretches)
    for k in (0, 2, 5, 7):
        case.check(f"finite strain, b/a = 2: pressure at stretch {stretches[k]:g}", thick[k],
                   pressure_of(stretches[k], 2.0), 0.01, unit="Pa", source="integral")
    near = np.linspace(1.30, 1.46, 9)
    thin = curve(case, 1.02, 8, 1, near)
    a, b, _ = np.polyfit(near, thin, 2)
    case.check("finite strain, b/a = 1.02: stretch at the peak of the pressure", -b / (2 * a), 7 ** (1 / 6), 0.01,
               source="thin")
    figure, (left, right) = plots.axes(2)
    left.loglog([1 / n for n in sizes], errors, "o-", color=plots.OURS, label="Sinew")
    plots.slope_line(left, [1 / n for n in sizes], errors, 2)
    left.set(xlabel="1 / n", ylabel="relative error of u(a)")
    left.legend()
    fine = np.linspace(1.0, 2.7, 200)
    right.plot(fine, pressure_of(fine, 2.0), color=plots.REFERENCE, lw=1, label="integral")
    right.plot(stretches, thick, "o", color=plots.OURS, label="Sinew, 8 cells")
    right.set(xlabel="stretch of the inner radius", ylabel="pressure / mu")
    right.legend()
    case.figure(figure, "Convergence at small strain; pressure against stretch of the neo-Hookean sphere, b/a = 2.")
