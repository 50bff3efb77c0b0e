/// @file
/// Kinds of joints.
#pragma once

#include <array>

namespace sinew::constraint {

/// Which relative motions a joint holds.
enum class JointType {
  ball,         ///< no displacement
  universal,    ///< and no rotation about the normal of its two axes
  hinge,        ///< no displacement, and rotation about its axis only
  weld,         ///< nothing moves
  slider,       ///< only a displacement along its axis
  cylindrical,  ///< a displacement along its axis and a rotation about it
};
inline constexpr std::array kJointTypes = {JointType::ball,   JointType::universal,
                                           JointType::hinge,  JointType::weld,
                                           JointType::slider, JointType::cylindrical};
/// "ball", "universal", "hinge", "weld", "slider", "cylindrical".
const char* joint_type_name(JointType type);

/// Whether the rotation about its one axis is free.
constexpr bool turns_about_axis(JointType type) {
  return type == JointType::hinge || type == JointType::cylindrical;
}
/// Whether the displacement along its axis is free.
constexpr bool slides_along_axis(JointType type) {
  return type == JointType::slider || type == JointType::cylindrical;
}

}  // namespace sinew::constraint
