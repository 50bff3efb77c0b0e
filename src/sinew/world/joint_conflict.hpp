/// @file
/// Diagnosis of joints, motors and prescribed motions that contradict each other.
#pragma once

#include <string>

namespace sinew::world {

class World;

/// The contradiction; the text is empty if there is none.
struct JointConflict {
  /// "'h1' is open by 2.5 mm and the command of 'm' is missed by 0.3 deg against 'h2'": the first
  /// few parts involved, with their gaps.
  std::string text;
  bool opens = false;  ///< whether a joint is open; otherwise motors miss their commands
};

/// Considers all joints, motors without effort limits, and exceeded limits, linearised at or near
/// the present state. Efforts lambda of these rows change their gaps g by W lambda. W is symmetric,
/// so g can be closed if and only if it is orthogonal to all y with W y = 0 (Fredholm's
/// alternative; Farkas' lemma for unilateral rows). The component of g along such y is the
/// contradiction: the loads y cancel on every body, so no motion changes y.g. Redundant joints also
/// have such y, but their gaps are orthogonal to them.
/// @param world whose rows are formed and condensed. @param least m: smaller gaps are ignored.
JointConflict find_joint_conflict(const World& world, double least);

}  // namespace sinew::world
