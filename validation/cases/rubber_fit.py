"""Fits of hyperelastic laws to Treloar's rubber."""

import csv
import re
import subprocess

import numpy as np
import sinew

from suite import plots
from suite.case import REPOSITORY, shared_data

TITLE = "Ogden's law fitted to Treloar's rubber"
SETUP = """Three terms are fitted to the uniaxial and equibiaxial tests together, from 20 random starts with seed 1. Each test
is weighted by its largest stress, and mu alpha >= 0 for every term. The reference is Ogden's own three-term fit of 1972 to
the same data: our fit should not be worse in either test."""
SOURCES = {"Ogden": "R. W. Ogden, Proc. R. Soc. A 326 (1972) 565-584: mu = 6.3, 0.012, -0.1 kgf/cm^2, alpha = 1.3, "
                    "5.0, -2.0, whose RMS on these data is 0.341 MPa uniaxial and 0.048 MPa equibiaxial",
           "Treloar": "L. R. G. Treloar, Trans. Faraday Soc. 40 (1944) 59-70"}
COST = 8
MODES = ("uniaxial", "equibiaxial")


def measured(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return (np.array([float(r["stretch"]) for r in rows]), np.array([float(r["nominal_stress_MPa"]) for r in rows]))


def ogden(mu, alpha):
    """An Ogden material; mu in Pa."""
    return sinew.material({"model": "ogden", "mu": mu, "alpha": alpha, "convention": "mu-over-alpha",
                           "poisson_ratio": 0.49})


def run(case):
    files = [shared_data("rubber", f"treloar_{mode}.csv") for mode in MODES]
    program = REPOSITORY / "build" / "release" / "bin" / "sinew"
    if None in files or not program.exists():
        case.skip("RMS of the fit", "the published data or the program are not present", source="Treloar")
        return
    out = case.scratch / "rubber.yaml"
    done = subprocess.run([program, "fit", *files, "--model", "ogden3", "-o", out], capture_output=True, text=True,
                          check=True)
    text = out.read_text()
    numbers = {key: [float(x) for x in re.search(rf"^{key}: (.*?)( Pa)?$", text, re.M).group(1).split()]
               for key in ("mu", "alpha")}
    law = ogden(numbers["mu"], numbers["alpha"])
    own = ogden([6.3 * 98066.5, 0.012 * 98066.5, -0.1 * 98066.5], [1.3, 5.0, -2.0])
    assert "ogden3" in done.stdout
    figure, pair = plots.axes(2)
    for axis, mode, file, published in zip(pair, MODES, files, (0.341, 0.048)):
        stretch, stress = measured(file)
        ours = 1e-6 * np.array(law.nominal_stress(stretch, mode))
        theirs = 1e-6 * np.array(own.nominal_stress(stretch, mode))
        rms = float(np.sqrt(np.mean((ours - stress) ** 2)))
        case.check(f"{mode}: RMS of Ogden's coefficients", float(np.sqrt(np.mean((theirs - stress) ** 2))), published,
                   0.01, unit="MPa", source="Ogden")
        case.bound(f"{mode}: RMS of our coefficients, at most Ogden's", rms, published, unit="MPa", source="Ogden")
        fine = np.linspace(1, stretch.max(), 200)
        axis.plot(stretch, stress, "o", color=plots.REFERENCE, label="Treloar 1944")
        axis.plot(fine, 1e-6 * np.array(own.nominal_stress(fine, mode)), "--", color=plots.SECOND, label="Ogden 1972")
        axis.plot(fine, 1e-6 * np.array(law.nominal_stress(fine, mode)), color=plots.OURS, label="sinew fit")
        axis.set(title=mode, xlabel="stretch", ylabel="nominal stress (MPa)")
        axis.legend()
    case.figure(figure, "Treloar's tests, Ogden's fit and ours.")
