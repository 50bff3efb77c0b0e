/// @file
/// A cable as an actuator.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

/// A cable through points given by rest positions.
struct CableSettings {
  std::string name;
  Location place;
  int body = 0;
  Points points;                       ///< (n, 3) m, n >= 2; the first is the pull point
  std::vector<Location> point_places;  ///< (n,) where each was written; may be empty
  std::vector<int> point_bodies;       ///< (n,) whose material each is in; empty: all in `body`
  bool pull_from_world = true;         ///< the pull point is fixed to the world, else to the body
  mesh::Outside outside = mesh::Outside::error;
  Limits tension{.min = 0.0};  ///< N, min >= 0
  Limits displacement;         ///< m
  Command command;
  bool geometric_stiffness = true;  ///< in every step; solve_static always has it
  double friction = 0.0;            ///< Coulomb's coefficient at every point between its ends, >= 0
  /// m, >= 0: every point is the mean of a ball of this radius, such as a tube set into the
  /// material; 0: a bare point
  double guide_radius = 0.0;
  /// m: guides are set between the points, evenly and no farther apart, as along a conduit; 0: none
  double guide_spacing = 0.0;
};

}  // namespace sinew::sim
