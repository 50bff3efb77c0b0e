/// @file
/// A cable as an actuator.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::builder {

/// The kind of cables.
inline constexpr model::ActuatorKind kCableKind{.word = "cable",
                                                .effort = {"tension", "N"},
                                                .motion = {"displacement", "m"},
                                                .pulls_only = true,
                                                .is_line = true,
                                                .number = 0};

/// A cable through points given by rest positions.
struct CableSettings {
  std::string name;
  Location place;
  int body = 0;
  Points points;                       ///< (n, 3) m, n >= 2; the first is the pull point
  std::vector<Location> point_places;  ///< (n,) source locations; may be empty
  std::vector<int> point_bodies;       ///< (n,) body of each point; empty: all in `body`
  bool pull_from_world = true;         ///< whether the pull point is fixed to the world
  mesh::Outside outside = mesh::Outside::error;
  model::Limits tension{.min = 0.0};  ///< N, min >= 0
  model::Limits displacement;         ///< m
  model::Command command;
  /// Whether time steps include it; static solutions and the exact tangent always do.
  bool geometric_stiffness = true;
  double friction = 0.0;  ///< Coulomb's coefficient at each point between the ends, >= 0
  /// m, >= 0: each point is the mean over a ball of this radius, such as a tube embedded in the
  /// material; 0: a single point
  double guide_radius = 0.0;
  /// m: maximum distance of guides inserted evenly between the points, as along a conduit; 0: none
  double guide_spacing = 0.0;
};

}  // namespace sinew::builder
