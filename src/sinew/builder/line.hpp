/// @file
/// Paths of cables and springs through the material of bodies.
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

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// The points of a line at rest.
struct LinePath {
  Points points;                 ///< (n, 3) m
  std::vector<Location> places;  ///< (n,) source locations, or empty
  std::vector<int> bodies;       ///< (n,) body of each point
};

/// Inserts guides between the points of a path that are on the same body, evenly and at most
/// `spacing` apart (m; 0: none). Throws Error(out-of-range) if there would be more than 10000
/// between two points.
LinePath set_guides(LinePath written, double spacing);

/// The path of a cable or spring, to be attached.
struct Line {
  const char* kind;  ///< for messages: "cable"
  std::string name;
  Location place;
  LinePath path;
  bool from_world = false;  ///< whether the first point is fixed to the world
  mesh::Outside outside = mesh::Outside::error;
  bool friction = false;
  double guide_radius = 0.0;  ///< m, see CableSettings
};

/// Attaches the points of a line. Throws Error: point-outside-mesh with the point's location, and
/// as constraint::Cable does.
std::unique_ptr<constraint::Cable> attach_line(model::ModelData& data, Line line);

}  // namespace sinew::builder
