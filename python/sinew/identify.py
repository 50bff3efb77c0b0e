"""Identification of simulation parameters from measurements.

    from sinew import identify, pcc
    records = [identify.read_motion("first.csv", segments=4), identify.read_motion("second.csv", segments=4)]
    found = identify.fit_arm(arm, records, fixed=["mass_1"])    # weighed
    print(found)

    fit = identify.fit(predict, measured, {"young_modulus": (100e3, 50e3, 200e3)})    # any simulation

docs/identification.md has the equations and their assumptions. SI units everywhere.
"""

from . import _core

if not hasattr(_core, "fit_arm"):
    raise ImportError("this build of Sinew has no identification: configure it with -D SINEW_IDENTIFY=ON")

from ._core import (
    ArmFit,
    MaterialFit,
    MotionRecord,
    ParameterFit,
    RecordFit,
    fit,
    fit_actuator,
    fit_arm,
    fit_cylinder,
    fit_materials,
    nrmse,
    predict_motion,
    read_motion,
    validate_arm,
    validate_cylinder,
)

__all__ = [
    "ArmFit",
    "MaterialFit",
    "MotionRecord",
    "ParameterFit",
    "RecordFit",
    "fit",
    "fit_actuator",
    "fit_arm",
    "fit_cylinder",
    "fit_materials",
    "nrmse",
    "predict_motion",
    "read_motion",
    "validate_arm",
    "validate_cylinder",
]

for _type in (ArmFit, MaterialFit, MotionRecord, ParameterFit, RecordFit):
    _type.__module__ = "sinew.identify"
