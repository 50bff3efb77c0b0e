/// @file
/// Joints, motors and given motions that no motion obeys together.
#pragma once

#include <string>

namespace sinew::sim {

class World;

/// What contradicts itself; an empty text where nothing does.
struct JointConflict {
  /// "'h1' is open by 2.5 mm and the command of 'm' is missed by 0.3 deg against 'h2'": the first
  /// few that take part, with what each lacks.
  std::string text;
  bool opens = false;  ///< a joint is open; else only motors miss their commands
};

/// Of all joints, motors without a limit of their effort, and limits that are passed, at the
/// present state, as condensed there or nearly there. Efforts lambda of these rows change what each
/// lacks, g, by W lambda. W is symmetric, so g can be closed if and only if it is normal to all y
/// with W y = 0 (Fredholm's alternative; Farkas' lemma where a row acts one way). The part of g
/// along such y is the contradiction: loads y that cancel on every body, and would work on the gaps
/// whatever moves. Redundant joints have such y, too, but gaps that are normal to them.
/// @param world whose rows are formed. @param least m: smaller gaps are none.
JointConflict find_joint_conflict(const World& world, double least);

}  // namespace sinew::sim
