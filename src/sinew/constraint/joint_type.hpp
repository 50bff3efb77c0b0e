/// @file
/// Kinds of joints.
#pragma once

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
const char* joint_type_name(JointType type);

}  // namespace sinew::constraint
