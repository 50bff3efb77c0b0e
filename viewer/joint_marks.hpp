/// @file
/// Where joints are drawn.
#pragma once

#include <vector>

#include "sinew/sim/simulation.hpp"

namespace sinew::viewer {

/// Of every joint its point on the first and on the second body, m, its axis and its second axis,
/// unit vectors, zero where it has none. Of a weld of points both are the mean of the second
/// body's.
/// @param simulation now.
/// @return (12 joints,)
std::vector<float> joint_marks(const sim::Simulation& simulation);

}  // namespace sinew::viewer
