"""A clamped silicone beam, measured by motion capture."""

import csv

import numpy as np
import scipy.optimize
import sinew

from suite import plots
from suite.case import shared_data
from suite.robots import SOLVER

TITLE = "Measured: a clamped beam of Dragon Skin 10"
SETUP = """A beam, 100 x 30 x 30 mm, of Dragon Skin 10, is clamped at one end, held straight and released by hand; also with
52 g suspended from the upper edge of its end. Motion capture recorded markers at 100 Hz, two runs each. Our model has 20 x 6
x 6 hexahedra, neo-Hookean, nu_0 = 0.499, 1070 kg/m^3, with markers 6 mm off the surface; the suspended weight is a dead load
along the edge.

E = 263 824 Pa is the modulus that the authors fitted to this beam with their simulator, so nothing here is a blind
prediction. A second modulus is fitted to the sag under gravity (one number, marker Tip-2); with it, the loaded beam and the
frequency are predicted. The error of a marker is the length of the difference of the displacements.

**Release**: generalized-alpha with spectral radius 1, steps of 2 ms. The stiffness damping is set to the measured damping
ratio. The time of the release, which was done by hand, is fitted to the motion from 0.3 s on (before that the hand may still
touch the beam). The release of the loaded beam is omitted, because the weight swings along. Measurements cannot judge a code
whose parameters are fitted to them; they are reported, not scored."""
SOURCES = {
    "measured": "M. Dubied, M. Y. Michelis, A. Spielberg, R. K. Katzschmann, IEEE Robot. Autom. Lett. 7 (2022) 5015-5022, "
                "arXiv 2201.12560; data: srl-ethz/diffPD_sim2real, realbeam_experiments",
    "finer": "the same beam in 40 x 12 x 12 hexahedra",
}
COST = 90
AUTHORS_YOUNG = 263824.0
LENGTH, WIDTH = 0.1, 0.03
MARKERS = {"Tip - 1": (0.1, 0.015, 0.036), "Tip - 2": (0.1, -0.006, 0.024), "Tip - 3": (0.1, 0.036, 0.006)}
HUNG = 0.51012  # N


def beam(young, cell=0.005, damping=0.0, **world):
    return sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.80709], "solver": SOLVER, **world,
        "bodies": {"beam": {
            "type": "fem", "element": "hex8", "density": 1070.0, "mass_matrix": "consistent", "fixed": [{"set": "x_min"}],
            "material": {"model": "neo-hookean", "young_modulus": young, "poisson_ratio": 0.499},
            "damping": {"stiffness": damping},
            "mesh": {"shape": "block", "length": LENGTH, "width": WIDTH, "height": WIDTH, "element_size": cell}}},
        "effectors": {name.replace(" ", ""): {"body": "beam", "point": list(point), "outside": "nearest"}
                      for name, point in MARKERS.items()}})


def hang(sim, force):
    """Applies a dead load along the upper edge of the end, uniform per length."""
    body = sim.body("beam")
    rest = np.array(body.rest_positions)
    edge = np.flatnonzero((rest[:, 0] > LENGTH - 1e-9) & (rest[:, 2] > WIDTH - 1e-9))
    share = np.where((rest[edge, 1] < 1e-9) | (rest[edge, 1] > WIDTH - 1e-9), 0.5, 1.0)
    body.external_forces[edge] = np.outer(share / share.sum(), [0, 0, -force])


def sag(young, force, cell=0.005):
    """Displacements (mm) of the markers at rest."""
    sim = beam(young, cell)
    hang(sim, force)
    sim.solve_static()
    return {name: 1e3 * (np.array(sim.effector(name.replace(" ", "")).position) - point)
            for name, point in MARKERS.items()}


def targets(path):
    """Measured and COMSOL's displacements (mm), by case and marker."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {(r["case"], r["marker"]): (np.array([float(r[f"d{c}_mm"]) for c in "xyz"]),
                                       np.array([float(r[f"comsol_d{c}"]) for c in "xyz"])) for r in rows}


def statics(case, path):
    """Reports errors at rest; returns the modulus that fits the sag."""
    known = targets(path)
    measured_sag = known["gravity", "Tip - 2"][0][2]
    fitted = scipy.optimize.brentq(lambda e: sag(e, 0.0)["Tip - 2"][2] - measured_sag, 2e5, 4e5, xtol=10.0)
    case.report("E fitted to the sag of Tip-2 under gravity", 1e-3 * fitted, reference=1e-3 * AUTHORS_YOUNG, unit="kPa",
                source="measured", remark="reference: the authors' fit with their simulator and mesh")
    finer = sag(AUTHORS_YOUNG, HUNG, 0.0025)["Tip - 2"][2]
    for name, force in (("gravity", 0.0), ("load52", HUNG)):
        ours, own = sag(AUTHORS_YOUNG, force), sag(fitted, force)
        for marker in MARKERS:
            measured, comsol = known[name, marker]
            case.report(f"{name}, {marker.replace(' ', '')}: vertical displacement, authors' E", ours[marker][2],
                        reference=measured[2], unit="mm", source="measured")
            errors = [np.linalg.norm(x - measured) for x in (ours[marker], own[marker], comsol)]
            case.report(f"{name}, {marker.replace(' ', '')}: error of the displacement",
                        "authors' E {:.2f} mm, E from the sag {:.2f} mm, published COMSOL {:.2f} mm".format(*errors),
                        source="measured")
    case.check("load52, Tip-2: vertical displacement, cells of 5 mm compared with 2.5 mm", ours["Tip - 2"][2], finer, 0.01,
               unit="mm", source="finer")
    return fitted


def motion(path):
    """Times (s) and vertical displacement (mm) of Tip-2."""
    with open(path, newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["marker"] == "Tip - 2"]
    return (np.array([float(r["t_since_release_s"]) for r in rows]), 1e3 * np.array([float(r["dz_m"]) for r in rows]))


def released(young, damping, duration=2.6, step=0.002):
    """Times and vertical displacement (mm) of Tip-2 after the release."""
    sim = beam(young, time_step=step, damping=damping, integrator={"type": "generalized-alpha", "spectral_radius": 1.0},
               solver={**SOLVER, "method": "newton"})  # one linearisation per step would add numerical damping
    tip, heights = sim.effector("Tip-2"), [0.0]
    for _ in range(round(duration / step)):
        sim.step()
        heights.append(1e3 * (tip.position[2] - MARKERS["Tip - 2"][2]))
    return step * np.arange(len(heights)), np.array(heights)


def ring(times, heights):
    """Frequency (Hz) and damping ratio, fitted by a decaying cosine from 0.3 s on."""
    use = (times > 0.3) & (times < 2.5)
    t, z = times[use], heights[use]

    def curve(t, rest, cosine, sine, decay, omega):
        return rest + np.exp(-decay * t) * (cosine * np.cos(omega * t) + sine * np.sin(omega * t))
    found, _ = scipy.optimize.curve_fit(curve, t, z, [z.mean(), 3.0, 3.0, 2.5, 2 * np.pi * 7.7])
    return found[4] / (2 * np.pi), found[3] / np.hypot(found[3], found[4])


def run(case):
    path = shared_data("measured_beam", "targets_static.csv")
    if path is None:
        case.skip("displacements and motion", "the published data are not present", source="measured")
        return
    fitted = statics(case, path)
    figure, axis = plots.axes()
    runs = [motion(path.parent / f"beam_gravity_V2_{letter}.csv") for letter in "ab"]
    measured = np.mean([ring(*pair) for pair in runs], axis=0)
    damping = measured[1] / (np.pi * measured[0])
    damping *= measured[1] / ring(*released(fitted, damping))[1]
    for label, young, colour in (("authors' E", AUTHORS_YOUNG, plots.OURS), ("E from the sag", fitted, plots.SECOND)):
        times, heights = released(young, damping)
        hertz, ratio = ring(times, heights)
        case.report(f"release, {label}: frequency", hertz, reference=measured[0], unit="Hz", source="measured")
        case.report(f"release, {label}: damping ratio", ratio, reference=measured[1], source="measured",
                    remark="the damping is set to the measured ratio: not a prediction")
        for letter, (t, z) in zip("ab", runs):
            use = (t > 0.3) & (t < 2.0)

            def apart(shift):
                return np.interp(t[use] - shift, times, heights) - z[use]
            shifts = np.linspace(-0.02, 0.1, 121)
            shift = shifts[np.argmin([np.mean(apart(s) ** 2) for s in shifts])]
            case.report(f"release {letter}, {label}: RMS of Tip-2 from 0.3 to 2 s", np.sqrt(np.mean(apart(shift) ** 2)),
                        unit="mm", source="measured",
                        remark=f"measured motion in this time: {np.ptp(z[use]):.3g} mm from peak to trough")
            if letter == "a":
                axis.plot(times + shift, heights, color=colour, lw=1, label=f"Sinew, {label}")
    axis.plot(*runs[0], ".", color=plots.REFERENCE, ms=3, label="measured, run a")
    axis.set(xlabel="time since the release (s)", ylabel="vertical displacement of Tip-2 (mm)", xlim=(0, 1.5))
    axis.legend()
    case.figure(figure, "Tip of the beam after its release.")
