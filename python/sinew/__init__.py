"""Simulates soft robots and steers them in real time.

    import sinew
    sim = sinew.load("trunk.yaml")
    sim.actuator("long_0").displacement = 0.010     # m
    sim.step(100)
    sim.effector("tip").position                    # (3,) m

SI units everywhere. docs/python.md is the guide.
"""

import importlib as _importlib

from . import collision, errors, fields, mesh, pcc, qp, sensors
from ._core import (
    Actuator,
    Batch,
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
    Response,
    Samples,
    Sensor,
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
from .notebook import frame_of as _frame_of
from .scene import load, loads

__all__ = [
    "Actuator",
    "Batch",
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
    "Response",
    "RunError",
    "Samples",
    "Sensor",
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
    "control",
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
    "sensors",
    "view",
]


def __getattr__(name):
    # Pictures and loops are imported when they are first asked for: most programs have none.
    if name in ("control", "render"):
        return _importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _repr_png_(sim):
    from .render import _repr_png_

    return _repr_png_(sim)


Simulation._repr_png_ = _repr_png_  # a notebook shows a picture
View._repr_html_ = _frame_of  # and the page

# Names by which users know them, whatever module compiled them.
for _name in __all__:
    if isinstance(globals().get(_name), type) and globals()[_name].__module__ == "sinew._core":
        globals()[_name].__module__ = "sinew"
del _name
