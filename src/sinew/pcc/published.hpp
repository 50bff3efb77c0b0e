/// @file
/// The identified four-segment fluidic arm that planning, identification and examples share.
#pragma once

#include "sinew/pcc/arm.hpp"

namespace sinew::pcc {

/// Masses 0.190, 0.146, 0.090, 0.090 kg, k_1 = 0.108 N m by the channel model, b = 4.2e-3 N m s, as
/// the arm's authors identified them. They give no lengths. Assumed here: 0.14 m each, 0.56 m in
/// all, since segments are cast in one mould; the heavier ones nearer the base carry the fluid
/// lines of those beyond.
/// @param centre of the masses. @param lengths (4,) m; empty: those assumed.
ArmSettings published_arm(MassCentre centre = MassCentre::arc, const VectorX& lengths = {});

/// (4,) N m, either way: 0, 0.12, 0.13, 0.18; the first segment is not actuated.
VectorX published_torque_limits();

}  // namespace sinew::pcc
