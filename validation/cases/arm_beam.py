"""Constant-curvature arms compared with a finite-element beam of the same stiffness."""

import numpy as np
import scipy.sparse.linalg
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Constant-curvature arms compared with a finite-element beam"
SETUP = """A silicone beam, 300 x 20 x 20 mm (E = 0.5 MPa, nu = 0.3, 1000 kg/m^3), is clamped level. It carries a hundredth, a
tenth and all of its weight. The finite-element model has 60 x 4 x 4 hexahedra (neo-Hookean). The arms have N equal segments
with k = EI/L_i and distributed mass.

Tip deflections come from equilibria, first frequencies from the eigenvalues of stiffness and mass at rest without gravity.
The difference between arm and beam falls with the square of the segment length. The remainder is due to shear and Poisson's
effect, which arms do not model. The scored references are the small deflection and the frequency of Euler and Bernoulli, to
which the arm must converge, and a difference from finite elements below 2 % with 16 segments at full weight. With one and
four segments the difference is the error of the model; it is reported only."""
SOURCES = {"beam": "Euler and Bernoulli: w = q L^4/(8 EI), f = 1.875104^2/(2 pi L^2) sqrt(EI/(rho A))",
           "finite elements": "the same beam in hexahedra, this program"}
COST = 15
L, B, E, NU, RHO, G = 0.3, 0.02, 0.5e6, 0.3, 1000.0, 9.81
EI = E * B**4 / 12
WEIGHTS = (0.01, 0.1, 1.0)
SEGMENTS = (1, 2, 4, 8, 16)


def fem():
    """Tip deflection (m) at each weight, and the first frequency (Hz)."""
    def beam(gravity):
        return sinew.load({
            "sinew": 1, "solver": SOLVER, "gravity": [0, 0, -gravity], "integrator": "quasi-static",
            "bodies": {"beam": {"type": "fem", "element": "hex8", "density": RHO,
                                "material": {"model": "neo-hookean", "young_modulus": E, "poisson_ratio": NU},
                                "mesh": {"shape": "block", "length": L, "width": B, "height": B, "element_size": 0.005},
                                "fixed": [{"set": "x_min"}]}},
            "effectors": {"tip": {"body": "beam", "point": [L, B / 2, B / 2]}}})

    down = []
    for weight in WEIGHTS:
        sim = beam(weight * G)
        sim.solve_static()
        down.append(B / 2 - sim.effector("tip").position[2])
    body = beam(0.0).body("beam")
    stiffness = body.stiffness()
    mass = np.repeat(np.asarray(body.node_masses)[~np.asarray(body.fixed)], 3)
    lowest = scipy.sparse.linalg.eigsh(stiffness.tocsc(), k=3, M=scipy.sparse.diags(mass).tocsc(), sigma=0.0)[0]
    return np.array(down), np.sqrt(lowest[0]) / (2 * np.pi)


def arm(count):
    """The same for an arm with this number of segments."""
    lengths = np.full(count, L / count)
    def model(gravity):  # the arm extends along -z: gravity along +x acts as on a level beam
        return sinew.pcc.Arm(lengths, RHO * B * B * lengths, sinew.pcc.beam_stiffness(EI, lengths), 0.0,
                             centre="distributed", gravity=[gravity, 0, 0])

    down = [model(weight * G).endpoints(model(weight * G).equilibrium(np.zeros(count)))[-1, 0] for weight in WEIGHTS]
    still = model(0.0)
    squares = np.linalg.eigvals(np.linalg.solve(still.mass_matrix(np.zeros(count)), np.diag(still.stiffness)))
    return np.array(down), np.sqrt(squares.real.min()) / (2 * np.pi)


def run(case):
    small = RHO * B * B * WEIGHTS[0] * G * L**4 / (8 * EI)
    bending = 1.875104**2 / (2 * np.pi * L**2) * np.sqrt(EI / (RHO * B * B))
    fine, frequency = fem()
    ours = {count: arm(count) for count in SEGMENTS}
    case.check("small deflection, 16 segments", 1e3 * ours[16][0][0], 1e3 * small, 0.005, unit="mm", source="beam")
    case.check("first frequency, 16 segments", ours[16][1], bending, 0.005, unit="Hz", source="beam")
    gaps = [abs(ours[count][0][0] / small - 1) for count in SEGMENTS]
    order = np.log2(gaps[1] / gaps[2])
    case.check("order of the small deflection in the segment length", order, 2.0, 0.1, source="beam")
    case.bound("deflection under its weight, 16 segments: difference from finite elements",
               abs(ours[16][0][-1] / fine[-1] - 1), 0.02, source="finite elements")
    for count, name in ((1, "1 segment"), (4, "4 segments")):
        for weight, value, reference in zip(WEIGHTS, ours[count][0], fine):
            case.report(f"{name}, {weight:g} of its weight: deflection / that of finite elements",
                        value / reference, source="finite elements")
        case.report(f"{name}: first frequency / that of finite elements", ours[count][1] / frequency,
                    source="finite elements")
    figure, (left, right) = plots.axes(2)
    for k, (weight, colour) in enumerate(zip(WEIGHTS, (plots.OURS, plots.SECOND, "0.4"))):
        left.loglog(SEGMENTS, [abs(ours[count][0][k] / fine[k] - 1) for count in SEGMENTS], "o-", color=colour,
                    label=f"{weight:g} of its weight")
    right.loglog(SEGMENTS, gaps, "o-", color=plots.OURS, label="small deflection")
    right.loglog(SEGMENTS, [abs(ours[count][1] / bending - 1) for count in SEGMENTS], "s-", color=plots.SECOND,
                 label="first frequency")
    left.set(xlabel="segments", ylabel="difference of the deflection from finite elements")
    right.set(xlabel="segments", ylabel="difference from Euler and Bernoulli's beam")
    for axis in (left, right):
        axis.legend()
    case.figure(figure, "Arms of N segments compared with a beam. Left: finite elements. Right: theory.")
