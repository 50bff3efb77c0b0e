"""Estimation of the shape of a robot and the forces on it from sensor data, with covariance.

    from sinew import estimate
    twin = estimate.Twin("trunk.yaml", [estimate.Measured("tip.position", 1e-4)],
                         [estimate.Force("hand", "trunk", (0, 0.01, 0.15), prior=1.0)])
    found = estimate.solve(twin, {"tip.position": camera()})
    print(found)                                    # N, +- one standard deviation
    twin.sim.body("trunk").positions                # the shape

docs/estimation.md has the equations. SI units everywhere. Needs SciPy and PyYAML.
"""

from __future__ import annotations

from .filters import ExtendedKalman, Filter, MovingHorizon, Reading, UnscentedKalman
from .models import ArmModel, SteppedModel, TwinModel
from .places import Patch, Search, locate, patches
from .quantities import Effort, Force, Measured, Motion, NodalForce, Parameter, readings_of
from .static import Estimate, Observability, observability, shape_std, solve
from .twin import Twin

__all__ = ["ArmModel", "Effort", "Estimate", "ExtendedKalman", "Filter", "Force", "Measured", "Motion", "MovingHorizon",
           "NodalForce", "Observability", "Parameter", "Patch", "Reading", "Search", "SteppedModel", "Twin", "TwinModel",
           "UnscentedKalman", "locate", "observability", "patches", "readings_of", "shape_std", "solve"]
