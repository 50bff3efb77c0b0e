/// @file
/// What of a robot is observed and controlled.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::sim {

/// A point, the mean of several points or nodes, or an orientation: of the frame through three
/// points, or of the rigid section that one point lies in.
struct EffectorSettings {
  enum class Kind { points, nodes, orientation };
  std::string name;
  Location place;
  int body = 0;
  Kind kind = Kind::points;
  Points points;                    ///< (n, 3) m; their mean; of an orientation three, or one
  std::vector<NodeId> nodes;        ///< kind nodes: their mean
  std::vector<Vector3> directions;  ///< empty: x, y, z
  mesh::Outside outside = mesh::Outside::error;
};

}  // namespace sinew::sim
