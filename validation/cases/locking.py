"""The effect of the element type on a hanging silicone beam."""

import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Locking: an Ecoflex beam in tetrahedra and hexahedra"
SETUP = """A beam, 100 x 20 x 20 mm, of Ecoflex 00-30 (Ogden, nu_0 = 0.49), is clamped at one end and hangs under its weight.
It is meshed in cubes of 10, 5 and 2.5 mm, as mean-dilatation hexahedra or with each cube split into six linear tetrahedra.
The quantity is the vertical displacement at the middle of its end. The only scored check is that hexahedra of 5 mm are within
5 % of those of 2.5 mm."""
SOURCES = {"finest": "the same beam in hexahedra of 2.5 mm"}
COST = 5
SIZES = (10.0, 5.0, 2.5)  # mm


def sinks(element, size):
    """Sag (mm)."""
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.81], "solver": SOLVER,
        "bodies": {"beam": {
            "type": "fem", "element": element, "material": "ecoflex-00-30", "fixed": [{"set": "x_min"}],
            "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02,
                     "element_size": 1e-3 * size}}},
        "effectors": {"tip": {"body": "beam", "point": [0.1, 0.01, 0.01]}}})
    start = sim.effector("tip").position[2]
    sim.solve_static(max_iterations=300)
    return 1e3 * (start - sim.effector("tip").position[2])


def run(case):
    found = {e: [sinks(e, size) for size in SIZES] for e in ("hex8", "tet4")}
    for element, values in found.items():
        for size, value in zip(SIZES, values, strict=True):
            case.report(f"{element}, {size:g} mm", value, unit="mm", source="finest")
    case.check("hex8, 5 mm compared with 2.5 mm", found["hex8"][1], found["hex8"][2], 0.05, unit="mm",
               source="finest")
    figure, axis = plots.axes()
    axis.plot(SIZES, found["hex8"], "o-", color=plots.OURS, label="hexahedra")
    axis.plot(SIZES, found["tet4"], "s-", color=plots.SECOND, label="linear tetrahedra")
    axis.set(xlabel="cell size (mm)", ylabel="sag of the end (mm)", ylim=(0, None))
    axis.legend()
    case.figure(figure, "Deflection under the weight against cell size.")
