/// @file
/// How well a step's equation and law have to be solved.
#pragma once

namespace sinew::sim {

/// Relative residuals above this are no equilibrium, whatever the loads: half of the forces of a
/// slender robot are axial, and bend it by nothing when they are this little out of balance.
inline constexpr double kBalanced = 0.02;
/// What a search with all means at hand may end with: friction of cables keeps Newton from
/// settling.
inline constexpr double kSearched = 2e-5;
/// Commanded motions are made to this part of the robot's size.
inline constexpr double kMotionTolerance = 1e-5;

}  // namespace sinew::sim
