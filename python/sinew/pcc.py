"""Piecewise-constant-curvature models: soft arms of several segments, and bending actuators with a
single angle. An evaluation takes microseconds.

    import numpy as np
    from sinew import pcc
    arm = pcc.Arm(lengths=[0.14] * 4, masses=[0.190, 0.146, 0.090, 0.090], stiffness=0.108, damping=4.2e-3)
    arm.acceleration(np.zeros(4), np.zeros(4), [0, 0.05, 0, 0])    # (4,) rad/s^2

    actuator = pcc.BendingActuator(0.1, 6e-3, 2e-3, modulus=0.2e6)
    actuator.equilibrium(60e3)                                     # rad
    run = actuator.simulate(time, pressure)                        # dict of arrays; run["tip"]: (n, 2) m
    fit = pcc.fit_modulus(actuator, pcc.read_tip_record("tip.csv"))

SI units everywhere. docs/pcc.md and docs/bending_actuator.md have the equations and the conventions.
"""

from ._core import (
    Arm,
    BendingActuator,
    BendingModulus,
    BendingMotion,
    DriveCylinder,
    Excitation,
    FluidicActuator,
    beam_stiffness,
    channel_stiffness,
    published_arm,
    published_modulus,
    published_torque_limits,
    second_order_cylinder,
)
from .bending_fit import BendingFit, TipErrors, TipRecord, fit_modulus, read_tip_record, tip_errors

__all__ = [
    "Arm",
    "BendingActuator",
    "BendingFit",
    "BendingModulus",
    "BendingMotion",
    "DriveCylinder",
    "Excitation",
    "FluidicActuator",
    "TipErrors",
    "TipRecord",
    "beam_stiffness",
    "channel_stiffness",
    "fit_modulus",
    "published_arm",
    "published_modulus",
    "published_torque_limits",
    "read_tip_record",
    "second_order_cylinder",
    "tip_errors",
]

for _class in (Arm, BendingActuator, BendingModulus, BendingMotion, DriveCylinder, Excitation, FluidicActuator):
    _class.__module__ = "sinew.pcc"
del _class
