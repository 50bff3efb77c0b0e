/// @file
/// An effector: a point or orientation that is observed and controlled.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::builder {

/// A point, the mean of several points or nodes, or an orientation: that of the frame through three
/// points, or of the rigid section in which one point lies.
struct EffectorSettings {
  enum class Kind { points, nodes, orientation };
  std::string name;
  Location place;
  int body = 0;
  Kind kind = Kind::points;
  Points points;                    ///< (n, 3) m, of which the mean is taken; orientation: 3 or 1
  std::vector<NodeId> nodes;        ///< for Kind::nodes, of which the mean is taken
  std::vector<Vector3> directions;  ///< observed directions; empty: x, y, z
  mesh::Outside outside = mesh::Outside::error;
};

}  // namespace sinew::builder
