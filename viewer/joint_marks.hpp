/// @file
/// Positions at which joints are drawn.
#pragma once

#include <vector>

#include "sinew/sim/simulation.hpp"

namespace sinew::viewer {

/// Computes the marks of all joints. The mark of a joint has its point on the first and on the
/// second body, m, its axis and its second axis, which are unit vectors, or zero if there is none.
/// For a weld of points, both points are the mean of the second body's points.
/// @param simulation in its current state.
/// @return (12 joints,)
std::vector<float> joint_marks(const sim::Simulation& simulation);

}  // namespace sinew::viewer
