/// @file
/// What holds bodies together.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::sim {

/// Two bodies become one: points of the first stay where they are in the material of the second.
struct WeldSettings {
  std::string name;
  Location place;
  int first = 0, second = 1;  ///< bodies
  std::vector<NodeId> nodes;  ///< of the first's mesh
  Points points;              ///< (n, 3) m, at rest; beside the nodes
  /// For points that lie in no element of the second; those of the first must be in it.
  mesh::Outside outside = mesh::Outside::error;
};

}  // namespace sinew::sim
