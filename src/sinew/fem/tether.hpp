/// @file
/// A spring from a point of a body to a place in the world: a hand that pulls at the robot.
#pragma once

#include <array>

#include "sinew/core/types.hpp"

namespace sinew::fem {

/// The force stiffness (anchor - x) on x = sum weights x_node, taken implicitly: every step's
/// matrix holds the spring, so that no stiffness is too large for it.
struct Tether {
  std::array<NodeId, 3> nodes{};                 ///< mesh nodes of one face of an element, distinct
  std::array<double, 3> weights{1.0, 0.0, 0.0};  ///< sum 1; 0 at nodes that do not count
  Vector3 anchor = Vector3::Zero();              ///< m
  double stiffness = 0.0;                        ///< N/m, >= 0
};

}  // namespace sinew::fem
