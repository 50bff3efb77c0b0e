"""Simulation and control of soft robots in real time.

    import sinew
    sim = sinew.load("trunk.yaml")
    sim.actuator("long_0").displacement = 0.010     # m
    sim.step(100)
    sim.effector("tip").position                    # (3,) m

SI units everywhere. docs/python.md is the guide.
"""

import importlib as _importlib
import sys as _sys

try:
    import numpy as _numpy  # noqa: F401 - first, so that a missing NumPy is reported clearly
    from . import _core  # noqa: F401
except ImportError as _problem:
    raise ImportError(
        f"{_problem}; sinew needs NumPy and the Python that it was built for, which is Debian's /usr/bin/python3 after "
        f"`make build`; this is {_sys.executable}, Python {_sys.version.split()[0]}"
    ) from _problem

from . import collision, errors, fields, mesh, pcc, qp, sensors
from ._core import (
    Actuator,
    Batch,
    Body,
    Circle,
    Contact,
    Effector,
    Estimator,
    Load,
    InverseController,
    Joint,
    Limits,
    LinearModel,
    Linearisation,
    Material,
    Parameter,
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
    "Estimator",
    "Load",
    "Error",
    "HighRateLoop",
    "HighRateOutput",
    "HighRateReport",
    "HighRateTimes",
    "InverseController",
    "Joint",
    "Limits",
    "LinearModel",
    "Linearisation",
    "Location",
    "Material",
    "Notice",
    "Parameter",
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


# Imported on first use: most programs need few of them, and some depend on further packages.
_ON_USE = ("control", "convergence", "estimate", "gym", "identify", "learn", "plan", "plot", "render", "sweep")


def __getattr__(name):
    if name not in _ON_USE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        return _importlib.import_module(f".{name}", __name__)
    except ImportError as problem:  # hasattr() and help() expect an AttributeError
        raise AttributeError(f"sinew.{name}: {problem}") from problem


def __dir__():
    return sorted({*__all__, *_ON_USE})


def _repr_png_(sim):
    from .render import _repr_png_

    return _repr_png_(sim)


Simulation._repr_png_ = _repr_png_  # shown by a notebook for a Simulation
View._repr_html_ = _frame_of  # and for a View

# Classes of the compiled module carry the public module name.
for _name in __all__:
    if isinstance(globals().get(_name), type) and globals()[_name].__module__ == "sinew._core":
        globals()[_name].__module__ = "sinew"
del _name
