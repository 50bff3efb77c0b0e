"""Simulates soft robots and steers them in real time.

    import sinew
    sim = sinew.load("trunk.yaml")
    sim.actuator("long_0").displacement = 0.010     # m
    sim.step(100)
    sim.effector("tip").position                    # (3,) m

SI units everywhere. docs/python.md is the guide.
"""

import importlib as _importlib

from . import collision, errors, fields, mesh, pcc, qp
from ._core import (
    Actuator,
    Body,
    Circle,
    Contact,
    Effector,
    Load,
    InverseController,
    Joint,
    Limits,
    Linearisation,
    Material,
    PointMass,
    Polyline,
    Probe,
    Ramp,
    Samples,
    Signal,
    Simulation,
    State,
    Sine,
    StaticReport,
    StepReport,
    Steps,
    Target,
    Trajectory,
    View,
    __version__,
    material,
    materials,
    view,
)
from .errors import Error, Location, Notice, RunError, SinewWarning
from .high_rate import HighRateLoop, HighRateOutput, HighRateReport, HighRateTimes, Snapshot, UdpReport
from .scene import load, loads

__all__ = [
    "Actuator",
    "Body",
    "Circle",
    "Contact",
    "Effector",
    "Load",
    "Error",
    "HighRateLoop",
    "HighRateOutput",
    "HighRateReport",
    "HighRateTimes",
    "InverseController",
    "Joint",
    "Limits",
    "Linearisation",
    "Location",
    "Material",
    "Notice",
    "PointMass",
    "Polyline",
    "Probe",
    "Ramp",
    "RunError",
    "Samples",
    "Signal",
    "Simulation",
    "State",
    "Sine",
    "SinewWarning",
    "Snapshot",
    "StaticReport",
    "StepReport",
    "Steps",
    "Target",
    "Trajectory",
    "UdpReport",
    "View",
    "__version__",
    "collision",
    "errors",
    "fields",
    "load",
    "loads",
    "material",
    "materials",
    "mesh",
    "pcc",
    "qp",
    "render",
    "view",
]


def __getattr__(name):
    # Pictures are imported when they are first asked for: most programs draw none.
    if name == "render":
        return _importlib.import_module(".render", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _repr_png_(sim):
    from .render import _repr_png_

    return _repr_png_(sim)


Simulation._repr_png_ = _repr_png_  # a notebook shows a picture

# Names by which users know them, whatever module compiled them.
for _name in __all__:
    if isinstance(globals().get(_name), type) and globals()[_name].__module__ == "sinew._core":
        globals()[_name].__module__ = "sinew"
del _name
