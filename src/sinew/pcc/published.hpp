/// @file
/// The published four-segment fluidic arm, used by planning, identification and examples.
#pragma once

#include "sinew/pcc/arm.hpp"

namespace sinew::pcc {

/// The arm with the parameters identified by its authors: masses 0.190, 0.146, 0.090, 0.090 kg,
/// k_1 = 0.108 N m by the channel model, b = 4.2e-3 N m s. They give no lengths. The default is
/// 0.14 m each, 0.56 m in total, since all segments are cast in one mould; the heavier segments
/// near the base carry the fluid lines of the others.
/// @param centre of mass of each segment. @param lengths (4,) m; empty: the default.
ArmSettings published_arm(MassCentre centre = MassCentre::arc, const VectorX& lengths = {});

/// Largest absolute torques (4,) N m: 0, 0.12, 0.13, 0.18; the first segment is not actuated.
VectorX published_torque_limits();

}  // namespace sinew::pcc
