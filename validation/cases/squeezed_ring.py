"""The published cylindrical module with two shape-memory springs."""

import numpy as np
import sinew

from suite import plots
from suite.case import REPOSITORY

TITLE = "Silicone ring squeezed by shape-memory springs"
SETUP = """The ring of examples/ring/sma.yaml: outer and inner diameter 40 and 20 mm, height 22 mm, Ecoflex 00-30. Two springs
(wire 0.5 mm, mean diameter 2.4 mm, 10 coils), 8 mm below the top and 6 mm above the bottom, are heated until they are fully
austenitic (24.7 GPa: 1.40 N/mm). The source does not say how the springs are placed, where they are attached and how far they
are stretched. Assumed: both along one diameter, attached in the middle of the wall, a free length of 8 mm (the published
effective length), and no force when cold; the bottom slides on a plane. The attachment matters most: at the wall of the bore
the springs only dent it (smallest diameter 35 mm), at 14 to 18 mm from the axis the diameter is 27.2 to 24.9 mm. Because of
these free parameters nothing is scored."""
SOURCES = {"published": "the multi-flexible-body study with these dimensions: its simulation gave a height of 28.96, "
                        "a smallest diameter of 25.55 and a largest one of 46.92 mm; its experiment 28, 26, 47 mm"}
COST = 15


def run(case):
    sim = sinew.load(REPOSITORY / "examples" / "ring" / "sma.yaml")
    times, sizes, tension = [], [], []
    for _ in range(80):
        sim.step(5)
        x = np.array(sim.body("ring").positions)
        times.append(sim.time)
        sizes.append(1e3 * np.ptp(x, axis=0))
        tension.append(sim.actuator("upper").tension)
    sizes = np.array(sizes)
    case.report("height", sizes[-1, 2], reference=28.96, unit="mm", source="published")
    case.report("smallest diameter", sizes[-1, 0], reference=25.55, unit="mm", source="published")
    case.report("largest diameter", sizes[-1, 1], reference=46.92, unit="mm", source="published")
    case.report("tension of the upper spring", tension[-1], unit="N", source="published")
    figure, axis = plots.axes()
    for k, (name, colour) in enumerate(zip(("smallest diameter", "largest diameter", "height"),
                                           (plots.OURS, plots.SECOND, plots.THIRD))):
        axis.plot(times, sizes[:, k], color=colour, label=name)
        axis.axhline((25.55, 46.92, 28.96)[k], color=colour, lw=1, ls="--")
    axis.set(xlabel="time (s)", ylabel="mm")
    axis.legend()
    case.figure(figure, "The ring while its springs are heated; dashed: the published simulation.")
