/// @file
/// Lines through the material of bodies, along which cables and springs run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::constraint {
class Cable;
}

namespace sinew::sim {

struct ModelData;

/// The points of a line at rest.
struct LinePath {
  Points points;                 ///< (n, 3) m
  std::vector<Location> places;  ///< (n,) where each was written, or empty
  std::vector<int> bodies;       ///< (n,) whose material each is in
};

/// The path with guides between its points, evenly and no farther apart than `spacing` (m; 0: as
/// it is). Throws Error(out-of-range) for more guides than anybody sets.
LinePath set_guides(LinePath written, double spacing);

struct Line {
  const char* kind;  ///< for messages: "cable"
  std::string name;
  Location place;
  LinePath path;
  bool from_world = false;  ///< the first point is fixed to the world
  mesh::Outside outside = mesh::Outside::error;
  bool friction = false;
  double guide_radius = 0.0;  ///< m, see CableSettings
};

/// Attaches the points of a line. Throws Error: point-outside-mesh at the place of the point, and
/// what constraint::Cable does.
std::unique_ptr<constraint::Cable> attach_line(ModelData& data, Line line);

}  // namespace sinew::sim
