/// @file
/// Kinds of joints.
#pragma once

#include <array>

namespace sinew::constraint {

/// Which relative motions a joint holds.
enum class JointType {
  ball,         ///< no displacement
  universal,    ///< nor a turn about the normal of its two axes
  hinge,        ///< nor one but about its axis
  weld,         ///< nothing moves
  slider,       ///< a displacement along its axis alone
  cylindrical,  ///< that, and a turn about it
};
inline constexpr std::array kJointTypes = {JointType::ball,   JointType::universal,
                                           JointType::hinge,  JointType::weld,
                                           JointType::slider, JointType::cylindrical};
const char* joint_type_name(JointType type);

/// Whether it leaves the turn about its one axis.
constexpr bool turns_about_axis(JointType type) {
  return type == JointType::hinge || type == JointType::cylindrical;
}
/// Whether it leaves the displacement along it.
constexpr bool slides_along_axis(JointType type) {
  return type == JointType::slider || type == JointType::cylindrical;
}

}  // namespace sinew::constraint
