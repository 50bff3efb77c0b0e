"""Natural frequencies of a cantilever from its free vibration."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "First bending frequencies of a cantilever"
SETUP = """A beam, 100 x 10 x 12 mm, E = 1 MPa, nu = 0.3, 1000 kg/m^3, clamped at one end, of 40 x 4 x 4 hexahedra
(neo-Hookean, consistent mass). It is released from a deflection of a thousandth of its length, with
generalized-alpha of spectral radius 1. Frequencies are the peaks in the spectrum of the end's motion along the 12
mm side, refined by a parabola through the three highest points. References are the roots of the frequency equation of
Timoshenko's beam with the shear correction 10 (1 + nu)/(12 + 11 nu), found numerically."""
SOURCES = {"Timoshenko": "S. P. Timoshenko, Phil. Mag. 41 (1921) 744; frequency equation of the clamped-free beam in "
                         "T. C. Huang, J. Appl. Mech. 28 (1961) 579-584; shear correction: G. R. Cowper, J. Appl. Mech. "
                         "33 (1966) 335-340"}
COST = 20
L, B, H, E, NU, RHO = 0.1, 0.010, 0.012, 1e6, 0.3, 1000.0


def timoshenko(count):
    """Frequencies (Hz), from the determinant of the clamped-free conditions on the exact mode shapes."""
    area, inertia = B * H, B * H**3 / 12
    shear = E / (2 * (1 + NU)) * area * 10 * (1 + NU) / (12 + 11 * NU)

    def determinant(omega):
        # Reduced to [w, psi, M, V]' = matrix [w, psi, M, V]; the clamped end gives M, V at 0.
        a = np.zeros((4, 4))
        a[0, 1], a[0, 3] = 1, 1 / shear
        a[1, 2] = 1 / (E * inertia)
        a[2, 1], a[2, 3] = -RHO * inertia * omega**2, -1
        a[3, 0] = -RHO * area * omega**2
        scale = np.diag([1, 1, E * inertia, shear])
        values, vectors = np.linalg.eig(np.linalg.inv(scale) @ a @ scale)
        whole = (vectors @ np.diag(np.exp(values * L)) @ np.linalg.inv(vectors)).real
        return np.linalg.det(whole[2:, 2:])

    grid = np.linspace(1, 2 * np.pi * 800, 6000)
    values = [determinant(w) for w in grid]
    roots = []
    for k in range(len(grid) - 1):
        if values[k] * values[k + 1] < 0 and len(roots) < count:
            low, high = grid[k], grid[k + 1]
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if determinant(low) * determinant(middle) > 0 else (low, middle)
            roots.append(low / (2 * np.pi))
    return roots


def run(case):
    step = 2e-4
    sim = sinew.load({
        "sinew": 1, "solver": SOLVER, "time_step": step,
        "integrator": {"type": "generalized-alpha", "spectral_radius": 1.0},
        "bodies": {"beam": {"type": "fem", "element": "hex8", "density": RHO, "mass_matrix": "consistent",
                            "material": {"model": "neo-hookean", "young_modulus": E, "poisson_ratio": NU},
                            "mesh": {"shape": "block", "length": L, "width": B, "height": H, "element_size": 0.0025},
                            "fixed": [{"set": "x_min"}]}},
        "actuators": {"pluck": {"type": "force", "body": "beam", "point": [L, B / 2, H / 2], "direction": [0, 0, 1]}},
        "effectors": {"tip": {"body": "beam", "point": [L, B / 2, H / 2]}}})
    sim.actuator("pluck").force = 5e-4
    sim.solve_static()
    sim.actuator("pluck").force = 0.0
    motion = []
    for _ in range(12000):
        sim.step()
        motion.append(sim.effector("tip").position[2])
    window = np.hanning(len(motion))
    spectrum = np.abs(np.fft.rfft((np.array(motion) - np.mean(motion)) * window, 8 * len(motion)))
    hertz = np.fft.rfftfreq(8 * len(motion), step)
    figure, axis = plots.axes()
    axis.semilogy(hertz[hertz < 800], spectrum[hertz < 800] / spectrum.max(), color=plots.OURS, lw=1)
    for number, expected in enumerate(timoshenko(3), 1):
        near = np.flatnonzero(np.abs(hertz / expected - 1) < 0.12)
        k = near[np.argmax(spectrum[near])]
        a, b, c = np.log(spectrum[k - 1:k + 2])
        found = hertz[k] + 0.5 * (a - c) / (a - 2 * b + c) * (hertz[1] - hertz[0])
        case.check(f"frequency {number}", found, expected, 0.015, unit="Hz", source="Timoshenko")
        axis.axvline(expected, color=plots.REFERENCE, lw=1, ls="--")
    axis.set(xlabel="frequency (Hz)", ylabel="spectrum of the tip")
    case.figure(figure, "Spectrum of the tip's motion; dashed: Timoshenko's beam.")
