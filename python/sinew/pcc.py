"""Soft arms of segments of constant curvature, by themselves: models that cost microseconds.

    import numpy as np
    from sinew import pcc
    arm = pcc.Arm(lengths=[0.14] * 4, masses=[0.190, 0.146, 0.090, 0.090], stiffness=0.108, damping=4.2e-3)
    arm.acceleration(np.zeros(4), np.zeros(4), [0, 0.05, 0, 0])    # (4,) rad/s^2

SI units everywhere. docs/pcc.md has the equations and the conventions.
"""

from ._core import Arm, beam_stiffness, channel_stiffness, published_arm, published_torque_limits

__all__ = ["Arm", "beam_stiffness", "channel_stiffness", "published_arm", "published_torque_limits"]

Arm.__module__ = "sinew.pcc"
