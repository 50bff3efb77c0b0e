/// @file
/// Tolerances on the equation and the law of a step.
#pragma once

namespace sinew::sim {

/// States with a larger relative residual are not equilibria, whatever the loads. Half of the
/// forces of a slender robot are axial; a residual of this size in them bends the robot by a
/// negligible amount.
inline constexpr double kBalanced = 0.02;
/// Relative residual accepted when all search methods were used: cable friction can keep Newton's
/// method from converging further.
inline constexpr double kSearched = 2e-5;
/// Tolerance on commanded motions, relative to the robot's size.
inline constexpr double kMotionTolerance = 1e-5;

}  // namespace sinew::sim
